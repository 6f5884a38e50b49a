#include "sim/exposure.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "sim/light_times.h"
#include "sim/pixel_light.h"
#include "sim/pixel_rows.h"
#include "sim/seats.h"
#include "sim/slice_visits.h"

namespace xorvox::sim {
namespace {

constexpr double kSamePlace = 1.0 / 16.0;  ///< Slices, to both sides.
constexpr double kSamePart = 0.5;          ///< Of the way from the middle of the slice, where that is further.
constexpr std::size_t kMostPatterns = 64;
constexpr std::size_t kMostSums = 8;

/// How far places are apart that are one: what is far from its slice need not be told apart as closely as what is near
/// it, and so a display that strays widely has few more places than one that stands still.
double same_place(double late) {
    return std::abs(late) <= 0.5 ? kSamePlace : kSamePart * std::abs(late);
}

bool is_dark(const std::byte* bits, std::size_t size) {
    std::uint64_t any = 0;
    std::size_t at = 0;
    for (; at + 8 <= size; at += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, bits + at, 8);
        any |= word;
    }
    for (; at < size; ++at) any |= std::to_integer<std::uint64_t>(bits[at]);
    return any == 0;
}

/// Where light is on the way of a display.
struct OnTheWay {
    std::uint32_t step = 0;  ///< The slice, or of every second half turn S + the slice.
    double late = 0.0;       ///< Slices after its middle.
};

/// A pattern of a row that was lit at a place.
struct Pattern {
    double light_ns = 0.0;
    double moment = 0.0;     ///< Sum of light_ns · late.
    float late = 0.0f;       ///< Of its first light.
    std::uint32_t bits = 0;  ///< Number in Row::bits.

    double mean_late() const { return moment / light_ns; }
};

/// Light of patterns that were too many, by pixel and channel.
struct Sum {
    double light_ns = 0.0;
    double moment = 0.0;
    std::vector<float> pixels;

    double mean_late() const { return moment / light_ns; }
    void join(const Sum& other) {
        light_ns += other.light_ns;
        moment += other.moment;
        for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] += other.pixels[i];
    }
};

struct Row {
    std::vector<Pattern> patterns;
    std::vector<std::byte> bits;  ///< All that differ.
    std::vector<Sum> sums;        ///< By place.

    std::size_t bytes() const {
        std::size_t all = patterns.capacity() * sizeof(Pattern) + bits.capacity() + sums.capacity() * sizeof(Sum);
        for (const Sum& sum : sums) all += sum.pixels.capacity() * sizeof(float);
        return all;
    }
};

/// How many half turns differ.
std::uint32_t half_turns_of(const DisplayDescription& display) {
    return display.kind == DisplayKind::RotatingPanel && display.sweep_deg < 270.0 ? 2 : 1;
}

struct PanelRows {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    std::size_t first_row = 0;    ///< Of its rows among those of a slice.
    std::size_t piece_bytes = 0;  ///< Of a row of one channel's plane, or of levels.
};

}  // namespace

struct Exposure::Impl {
    DisplayDescription display;
    DisplayDescription built;
    CyclesAt cycles_at;
    std::uint64_t from_ns;
    std::uint64_t to_ns;
    Faults faults;
    PixelLight pixels{display};
    bool of_levels = !lit_by_planes(display);
    std::uint32_t channels = channel_count(display.format);
    std::uint32_t pieces = of_levels ? 1 : channels;  ///< Of a pattern.
    std::uint32_t half_turns = 1;                     ///< That differ.
    std::vector<PanelRows> panels;
    std::size_t slice_rows = 0;
    std::vector<Row> rows;  ///< Of each step.
    double scale = 1.0;     ///< From nanoseconds to light.
    double open_cycles = 0.0;
    SliceVisits visits{display};

    OnTheWay find(const Strobe& strobe) const;
    void add(const Strobe& strobe);
    void add_row(Row& row, const PanelRows& panel, const StrobeRows& from, std::uint32_t r, double light_ns,
                 double late) const;
    void fold(Row& row, const PanelRows& panel) const;
    Sum& sum_at(Row& row, const PanelRows& panel, double late) const;
    template <class Give>
    void for_each_lit_piece(const std::byte* bits, const PanelRows& panel, bool mirrored, const Give& give) const;
    void add_anywhere(const Row& row, const PanelRows& panel, bool mirrored, std::span<glm::vec3> light) const;
    void visit_row(const ExposedRow& as, const Row& row, const VisitRow& visit) const;
};

/// Calls give(column, channel, part) for what a pattern lights: columns as mounted.
template <class Give>
void Exposure::Impl::for_each_lit_piece(const std::byte* bits, const PanelRows& panel, bool mirrored,
                                        const Give& give) const {
    if (of_levels) {
        const std::span row(bits, panel.piece_bytes);
        for_each_lit(row, panel.columns, bits_per_pixel(display.format), pixels.shown_bits(),
                     [&](std::uint32_t column, std::uint32_t code) {
                         const glm::vec3 light = pixels.of(code);
                         if (mirrored) column = panel.columns - 1 - column;
                         for (std::uint32_t c = 0; c < channels; ++c) give(column, c, light[static_cast<int>(c)]);
                     });
        return;
    }
    for (std::uint32_t c = 0; c < channels; ++c, bits += panel.piece_bytes) {
        const std::span row(bits, panel.piece_bytes);
        for (std::uint32_t first = 0; first < panel.columns; first += 64) {
            for (std::uint64_t word = read_word(row, first / 8); word != 0; word &= word - 1) {
                const std::uint32_t column = first + static_cast<std::uint32_t>(std::countr_zero(word));
                if (column < panel.columns) give(column, c, 1.0f);
            }
        }
    }
}

OnTheWay Exposure::Impl::find(const Strobe& strobe) const {
    OnTheWay found{.step = strobe.slice};
    const std::uint32_t slices = display.slices;
    if (display.kind == DisplayKind::StackedPlanes || display.kind == DisplayKind::FreePoints) return found;

    const std::uint64_t middle_ns = strobe.on_ns + (strobe.off_ns - strobe.on_ns) / 2;
    const double cycles =
        cycles_at ? cycles_at(middle_ns) : static_cast<double>(middle_ns) * 1e-9 * display.cycles_per_second;
    if (display.kind == DisplayKind::SweptPlane) {
        const double part = cycles - std::floor(cycles);
        const double up = part < 0.5 ? 2.0 * part : 2.0 - 2.0 * part;
        const double dead = built.motion.dead_zone;
        found.late = (up - dead) / (1.0 - 2.0 * dead) * slices - (strobe.slice + 0.5);
        return found;
    }
    // What turns comes by again.
    const double way = double{1} * slices * half_turns;
    found.late = way;
    for (std::uint32_t half = 0; half < half_turns; ++half) {
        if (of_levels && half_turns == 2 && (half == 1) != strobe.mirrored) continue;
        const std::uint32_t step = half * slices + strobe.slice;
        const double late = std::remainder(cycles * slices - (step + 0.5), way);
        if (std::abs(late) < std::abs(found.late)) found = {step, late};
    }
    return found;
}

void Exposure::Impl::add(const Strobe& strobe) {
    assert((strobe.plane == Strobe::kLevels) == of_levels && strobe.slice < display.slices);
    visits.add(strobe, from_ns, to_ns);
    const std::uint64_t on_ns = std::max(strobe.on_ns, from_ns);
    const std::uint64_t off_ns = std::min(strobe.off_ns, to_ns);
    if (on_ns >= off_ns) return;
    auto light_ns = static_cast<double>(off_ns - on_ns);
    if (of_levels) {
        light_ns *= strobe.brightness / 255.0;
    } else {
        const std::uint64_t whole_ns = strobe.off_ns - strobe.on_ns;
        const double part = light_ns / static_cast<double>(whole_ns);
        light_ns = emitted_ns(display.scan, whole_ns) * part;
    }
    if (light_ns <= 0.0) return;

    const OnTheWay way = find(strobe);
    const bool all = strobe.row_group == Strobe::kAllRows;
    const std::uint32_t first = all ? 0 : strobe.row_group;
    const std::uint32_t groups = all ? 1 : display.scan.row_groups;
    Row* const of_step = rows.data() + way.step * slice_rows;
    for (std::size_t p = 0; p < panels.size(); ++p) {
        const PanelRows& panel = panels[p];
        for (std::uint32_t r = first; r < panel.rows; r += groups) {
            add_row(of_step[panel.first_row + r], panel, strobe.panels[p], r, light_ns, way.late);
        }
    }
}

void Exposure::Impl::add_row(Row& row, const PanelRows& panel, const StrobeRows& from, std::uint32_t r, double light_ns,
                             double late) const {
    std::array<const std::byte*, 3> at{};
    bool dark = true;
    for (std::uint32_t c = 0; c < pieces; ++c) {
        at[c] = from.at(r, c);
        dark = dark && is_dark(at[c], panel.piece_bytes);
    }
    if (dark) return;
    const std::size_t size = pieces * panel.piece_bytes;
    const auto known = static_cast<std::uint32_t>(row.bits.size() / size);
    const auto is_same = [&](std::uint32_t bits) {
        const std::byte* of = row.bits.data() + bits * size;
        for (std::uint32_t c = 0; c < pieces; ++c, of += panel.piece_bytes) {
            if (std::memcmp(of, at[c], panel.piece_bytes) != 0) return false;
        }
        return true;
    };
    std::uint32_t bits = 0;
    while (bits < known && !is_same(bits)) ++bits;
    if (bits < known) {
        // Most often it is where it was before.
        const double same = same_place(late);
        for (auto pattern = row.patterns.rbegin(); pattern != row.patterns.rend(); ++pattern) {
            if (pattern->bits != bits || std::abs(late - double{pattern->late}) > same) continue;
            pattern->light_ns += light_ns;
            pattern->moment += light_ns * late;
            return;
        }
    }
    if (row.patterns.size() == kMostPatterns) {
        fold(row, panel);
        bits = 0;
    }
    if (bits * size == row.bits.size()) {
        for (std::uint32_t c = 0; c < pieces; ++c) row.bits.insert(row.bits.end(), at[c], at[c] + panel.piece_bytes);
    }
    row.patterns.push_back({light_ns, light_ns * late, static_cast<float>(late), bits});
}

void Exposure::Impl::fold(Row& row, const PanelRows& panel) const {
    const std::size_t size = pieces * panel.piece_bytes;
    for (const Pattern& pattern : row.patterns) {
        Sum& sum = sum_at(row, panel, pattern.mean_late());
        sum.light_ns += pattern.light_ns;
        sum.moment += pattern.moment;
        const auto light = static_cast<float>(pattern.light_ns);
        const std::byte* const bits = row.bits.data() + pattern.bits * size;
        for_each_lit_piece(bits, panel, false, [&](std::uint32_t column, std::uint32_t c, float part) {
            sum.pixels[std::size_t{channels} * column + c] += part * light;
        });
    }
    row.patterns.clear();
    row.bits.clear();
}

/// The sum for light that is so late. Where there is none at that place and no room for one more, the two that are
/// nearest to each other, for how far they are away, become one.
Sum& Exposure::Impl::sum_at(Row& row, const PanelRows& panel, double late) const {
    std::vector<Sum>& sums = row.sums;
    const double same = std::max(same_place(late), 0.5);
    for (Sum& sum : sums) {
        if (std::abs(sum.mean_late() - late) <= same) return sum;
    }
    sums.reserve(kMostSums);
    std::vector<float> room;
    if (sums.size() == kMostSums) {
        std::size_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < sums.size(); ++i) {
            const double from = sums[i].mean_late();
            const double to = sums[i + 1].mean_late();
            const double apart = (to - from) / std::max({std::abs(from), std::abs(to), 1.0});
            if (apart >= least) continue;
            least = apart;
            nearest = i;
        }
        const auto other = sums.begin() + static_cast<std::ptrdiff_t>(nearest) + 1;
        sums[nearest].join(*other);
        room = std::move(other->pixels);
        sums.erase(other);
    }
    room.assign(std::size_t{channels} * panel.columns, 0.0f);
    const auto after = std::ranges::find_if(sums, [&](const Sum& sum) { return sum.mean_late() > late; });
    return *sums.insert(after, Sum{0.0, 0.0, std::move(room)});
}

/// What was lit at many places is taken apart once. `mirrored`: the light runs the other way round.
void Exposure::Impl::add_anywhere(const Row& row, const PanelRows& panel, bool mirrored,
                                  std::span<glm::vec3> light) const {
    const auto give = [&](std::uint32_t column, std::uint32_t c, float is) {
        glm::vec3& pixel = light[mirrored ? panel.columns - 1 - column : column];
        if (channels == 1) {
            pixel += is;
        } else {
            pixel[static_cast<int>(c)] += is;
        }
    };
    const std::size_t size = pieces * panel.piece_bytes;
    std::array<double, kMostPatterns> light_ns{};
    for (const Pattern& pattern : row.patterns) light_ns[pattern.bits] += pattern.light_ns;
    for (std::size_t bits = 0; bits * size < row.bits.size(); ++bits) {
        const auto lit = static_cast<float>(light_ns[bits] * scale);
        for_each_lit_piece(row.bits.data() + bits * size, panel, false,
                           [&](std::uint32_t column, std::uint32_t c, float part) { give(column, c, part * lit); });
    }
    for (const Sum& sum : row.sums) {
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
            give(static_cast<std::uint32_t>(i / channels), static_cast<std::uint32_t>(i % channels),
                 static_cast<float>(double{sum.pixels[i]} * scale));
        }
    }
}

void Exposure::Impl::visit_row(const ExposedRow& as, const Row& row, const VisitRow& visit) const {
    const PanelRows& panel = panels[as.panel];
    std::vector<glm::vec3> light(panel.columns, glm::vec3(0.0f));
    const auto give = [&](double late) {
        ExposedRow told = as;
        told.at += late;
        told.late = late;
        if (channels == 1) {
            for (glm::vec3& pixel : light) pixel.z = pixel.y = pixel.x;
        }
        told.light = light;
        visit(told);
        std::ranges::fill(light, glm::vec3(0.0f));
    };

    std::vector<std::size_t> by_place(row.patterns.size());
    for (std::size_t i = 0; i < by_place.size(); ++i) by_place[i] = i;
    std::ranges::sort(by_place, {}, [&](std::size_t i) { return std::pair(row.patterns[i].mean_late(), i); });
    for (std::size_t first = 0, last = 0; first < by_place.size(); first = last) {
        const double from = row.patterns[by_place[first]].mean_late();
        double light_ns = 0.0;
        double moment = 0.0;
        for (; last < by_place.size(); ++last) {
            const Pattern& pattern = row.patterns[by_place[last]];
            if (pattern.mean_late() - from > 2.0 * kSamePlace) break;
            light_ns += pattern.light_ns;
            moment += pattern.moment;
            const auto lit = static_cast<float>(pattern.light_ns * scale);
            for_each_lit_piece(row.bits.data() + pattern.bits * pieces * panel.piece_bytes, panel,
                               as.mirrored && of_levels, [&](std::uint32_t column, std::uint32_t c, float part) {
                                   light[column][static_cast<int>(c)] += part * lit;
                               });
        }
        give(moment / light_ns);
    }
    for (const Sum& sum : row.sums) {
        for (std::uint32_t column = 0; column < panel.columns; ++column) {
            const std::uint32_t mounted = as.mirrored && of_levels ? panel.columns - 1 - column : column;
            for (std::uint32_t c = 0; c < channels; ++c) {
                light[mounted][static_cast<int>(c)] =
                    static_cast<float>(double{sum.pixels[std::size_t{channels} * column + c]} * scale);
            }
        }
        give(sum.moment / sum.light_ns);
    }
}

Exposure::Exposure(const DisplayDescription& display, const DisplayDescription& built, CyclesAt cycles_at,
                   std::uint64_t from_ns, std::uint64_t to_ns, Faults faults)
    : impl_(std::make_unique<Impl>(Impl{display, built, std::move(cycles_at), from_ns, to_ns, std::move(faults)})) {
    Impl& impl = *impl_;
    impl.half_turns = half_turns_of(display);
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const std::size_t plane_bytes = (std::size_t{panel.columns} + 7) / 8;
        impl.panels.push_back({panel.columns, panel.rows, impl.slice_rows,
                               impl.of_levels ? row_bytes(panel, display.format) : plane_bytes});
        impl.slice_rows += panel.rows;
    }
    impl.rows.resize(impl.slice_rows * display.slices * impl.half_turns);
    close(to_ns);
}

void Exposure::close(std::uint64_t to_ns) {
    Impl& impl = *impl_;
    assert(to_ns > impl.from_ns);
    impl.to_ns = to_ns;
    impl.open_cycles = static_cast<double>(to_ns - impl.from_ns) * 1e-9 * impl.display.cycles_per_second;
    const double full_ns = full_light_ns(impl.display) * impl.open_cycles;
    impl.scale = full_ns > 0.0 ? 1.0 / full_ns : 0.0;
}

Exposure::Exposure(Exposure&&) noexcept = default;
Exposure& Exposure::operator=(Exposure&&) noexcept = default;
Exposure::~Exposure() = default;

void Exposure::add(const Strobe& strobe) {
    impl_->add(strobe);
}

void Exposure::for_each_row(const VisitRow& visit) const {
    for (std::uint32_t slice = 0; slice < impl_->display.slices; ++slice) {
        for (std::uint32_t panel = 0; panel < impl_->panels.size(); ++panel) {
            for (std::uint32_t row = 0; row < impl_->panels[panel].rows; ++row)
                for_each_place(slice, panel, row, visit);
        }
    }
}

void Exposure::for_each_place(std::uint32_t slice, std::uint32_t panel, std::uint32_t row,
                              const VisitRow& visit) const {
    for (std::uint32_t half = 0; half < impl_->half_turns; ++half) {
        const std::size_t step = std::size_t{half} * impl_->display.slices + slice;
        const Row& found = impl_->rows[step * impl_->slice_rows + impl_->panels[panel].first_row + row];
        if (found.patterns.empty() && found.sums.empty()) continue;
        const ExposedRow as{.slice = slice,
                            .panel = panel,
                            .row = row,
                            .mirrored = half == 1,
                            .at = double{1} * half * impl_->display.slices + lit_slice(slice, impl_->faults) + 0.5,
                            .light = {}};
        impl_->visit_row(as, found, visit);
    }
}

bool Exposure::add_row_light(std::uint32_t slice, std::uint32_t panel, std::uint32_t row,
                             std::span<glm::vec3> light) const {
    bool any = false;
    for (std::uint32_t half = 0; half < impl_->half_turns; ++half) {
        const std::size_t step = std::size_t{half} * impl_->display.slices + slice;
        const Row& found = impl_->rows[step * impl_->slice_rows + impl_->panels[panel].first_row + row];
        any = any || !found.patterns.empty() || !found.sums.empty();
        // As mounted, levels run the other way round in mirrored half turns, and planes were turned around.
        impl_->add_anywhere(found, impl_->panels[panel], half == 1 && !impl_->of_levels, light);
    }
    return any;
}

double Exposure::cycles() const {
    return impl_->open_cycles;
}

double Exposure::due(std::uint32_t slice) const {
    return impl_->visits.due(slice, impl_->open_cycles);
}

std::size_t Exposure::bytes() const {
    std::size_t all = impl_->rows.capacity() * sizeof(Row);
    for (const Row& row : impl_->rows) all += row.bytes();
    return all;
}

std::size_t Exposure::most_bytes(const DisplayDescription& display) {
    const std::size_t channels = channel_count(display.format);
    std::size_t all = 0;
    for (std::uint32_t p = 0; p < display.panel_count; ++p) {
        const Panel& panel = display.panels[p];
        const std::size_t plane_bytes = (std::size_t{panel.columns} + 7) / 8;
        const std::size_t pattern_bytes =
            lit_by_planes(display) ? channels * plane_bytes : row_bytes(panel, display.format);
        const std::size_t row = sizeof(Row) + kMostPatterns * (sizeof(Pattern) + 2 * pattern_bytes) +
                                kMostSums * (sizeof(Sum) + channels * panel.columns * sizeof(float));
        all += row * panel.rows;
    }
    return all * display.slices * half_turns_of(display);
}

const DisplayDescription& Exposure::display() const {
    return impl_->display;
}

const DisplayDescription& Exposure::built() const {
    return impl_->built;
}

const Faults& Exposure::faults() const {
    return impl_->faults;
}

std::uint64_t Exposure::from_ns() const {
    return impl_->from_ns;
}

std::uint64_t Exposure::to_ns() const {
    return impl_->to_ns;
}

}  // namespace xorvox::sim
