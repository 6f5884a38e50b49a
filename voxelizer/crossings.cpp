#include "voxelizer/crossings.h"

#include <algorithm>
#include <cassert>

#include "voxelizer/column_flips.h"

namespace xorvox {
namespace {

/// Whether two columns of sorted crossings have a sample inside both: the parities of both, from event to event.
bool collide(std::span<const std::uint16_t> a, std::span<const std::uint16_t> b) {
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() || j < b.size()) {
        const std::uint16_t k = j == b.size() || (i < a.size() && a[i] < b[j]) ? a[i] : b[j];
        while (i < a.size() && a[i] == k) ++i;
        while (j < b.size() && b[j] == k) ++j;
        if (i % 2 == 1 && j % 2 == 1) return true;  // Sample k is inside both.
    }
    return false;
}

}  // namespace

std::span<ColumnRun> column_runs(std::span<const std::uint16_t> crossings, std::uint32_t nz,
                                 std::span<ColumnRun> runs) {
    assert(runs.size() >= (crossings.size() + 1) / 2);
    std::size_t count = 0;
    for (std::size_t i = 0; i < crossings.size(); i += 2) {
        const std::uint16_t begin = crossings[i];
        const std::uint16_t end = i + 1 < crossings.size() ? crossings[i + 1] : static_cast<std::uint16_t>(nz);
        if (begin == end) continue;
        if (count > 0 && runs[count - 1].end == begin) {
            runs[count - 1].end = end;
        } else {
            runs[count++] = {begin, end};
        }
    }
    return runs.first(count);
}

std::uint64_t count_inside(const CrossingLists& lists) {
    std::uint64_t count = 0;
    for (std::uint32_t y = 0; y < lists.ny; ++y) {
        for (std::uint32_t x = 0; x < lists.nx; ++x) {
            const auto crossings = lists.column(x, y);
            for (std::size_t i = 0; i < crossings.size(); i += 2) {
                const std::uint32_t end = i + 1 < crossings.size() ? crossings[i + 1] : lists.nz;
                count += end - crossings[i];
            }
        }
    }
    return count;
}

std::size_t first_collision(const CrossingLists& a, const CrossingLists& b) {
    assert(a.nx == b.nx && a.ny == b.ny && a.nz == b.nz);
    for (std::uint32_t y = 0; y < a.ny; ++y) {
        for (std::uint32_t x = 0; x < a.nx; ++x) {
            if (collide(a.column(x, y), b.column(x, y))) return std::size_t{y} * a.nx + x;
        }
    }
    return std::size_t{a.nx} * a.ny;
}

void to_bits(const CrossingLists& lists, BitVolumeView out) {
    assert(out.nx == lists.nx && out.ny == lists.ny && out.nz == lists.nz);
    ColumnFlips flips(out);
    for (std::uint32_t y = 0; y < lists.ny; ++y) {
        for (std::uint32_t x = 0; x < lists.nx; ++x) {
            for (const std::uint16_t k : lists.column(x, y)) flips.flip(column_bit(lists.nx, x, y), k);
        }
    }
    flips.accumulate();
}

}  // namespace xorvox
