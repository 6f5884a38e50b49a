// A volume written slab by slab is the file of the whole, or no file.
#include <algorithm>
#include <random>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/file_size_limit.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/io/volume_file.h"

using namespace xorvox;

namespace {

const char* const kNames[] = {"a.nrrd", "a.bits", "a.binvox"};

Lattice grid(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
    return {.nx = nx, .ny = ny, .nz = nz, .origin = {1, -2, 0.1}, .pitch = glm::dvec3(0.5)};
}

BitVolume noise(const Lattice& lattice) {
    std::mt19937 random(lattice.nx);
    BitVolume volume(lattice);
    for (std::uint32_t z = 0; z < lattice.nz; ++z) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                if (random() % 3 == 0) volume.view().flip(x, y, z);
            }
        }
    }
    return volume;
}

/// The voxels with begin <= (x, y, z) < begin + (nx, ny, nz).
BitVolume part(const BitVolume& whole, std::uint32_t begin_x, std::uint32_t begin_z, std::uint32_t nx, std::uint32_t ny,
               std::uint32_t nz) {
    BitVolume copy(nx, ny, nz);
    for (std::uint32_t z = 0; z < nz; ++z) {
        for (std::uint32_t y = 0; y < ny; ++y) {
            for (std::uint32_t x = 0; x < nx; ++x) {
                if (whole.test(begin_x + x, y, begin_z + z)) copy.view().flip(x, y, z);
            }
        }
    }
    return copy;
}

/// Planes first … first + count - 1 along the axis.
BitVolume slab(const BitVolume& whole, const Lattice& lattice, io::SlabAxis axis, std::uint32_t first,
               std::uint32_t count) {
    if (axis == io::SlabAxis::X) return part(whole, first, 0, count, lattice.ny, lattice.nz);
    return part(whole, 0, first, lattice.nx, lattice.ny, count);
}

io::VolumeWriter writer(const std::string& path, const Lattice& lattice, std::stop_token stop = {}) {
    auto made = io::VolumeWriter::create(path, lattice, std::move(stop));
    INFO((made ? "" : made.error().message));
    REQUIRE(made);
    return std::move(*made);
}

std::string message(const Expected<void>& result) {
    return result ? std::string() : result.error().message;
}

}  // namespace

TEST_CASE("a volume in slabs of any thickness is the file of the whole, byte for byte") {
    const TempFolder folder;
    for (const Lattice& lattice : {grid(70, 5, 9), grid(130, 2, 66), grid(1, 3, 1), grid(64, 64, 3)}) {
        const BitVolume volume = noise(lattice);
        for (const std::string name : kNames) {
            REQUIRE(io::write_volume(folder / "whole" + name, volume.view(), lattice));
            for (const std::uint32_t thickness : {1u, 2u, 7u, 63u, 64u, 65u, 4096u}) {
                CAPTURE(name, thickness, lattice.nx);
                auto file = writer(folder / name, lattice);
                const std::uint32_t planes = file.slab_axis() == io::SlabAxis::X ? lattice.nx : lattice.nz;
                for (std::uint32_t first = 0; first < planes; first += thickness) {
                    const std::uint32_t count = std::min(thickness, planes - first);
                    REQUIRE(file.write(slab(volume, lattice, file.slab_axis(), first, count).view(), first));
                }
                REQUIRE(file.commit());
                CHECK(contents(folder / name) == contents(folder / "whole" + name));
            }
        }
    }
}

TEST_CASE("nrrd and bits lie in slabs along z, binvox in slabs along x") {
    const TempFolder folder;
    CHECK(writer(folder / "a.nrrd", grid(2, 2, 2)).slab_axis() == io::SlabAxis::Z);
    CHECK(writer(folder / "a.bits", grid(2, 2, 2)).slab_axis() == io::SlabAxis::Z);
    CHECK(writer(folder / "a.binvox", grid(2, 2, 2)).slab_axis() == io::SlabAxis::X);
}

TEST_CASE("a writer that is abandoned leaves nothing, and an older file as it was") {
    const TempFolder folder;
    const Lattice lattice = grid(6, 5, 6);
    const BitVolume volume = noise(lattice);
    put(folder / "a.bits", "older");
    for (const std::string name : kNames) {
        auto file = writer(folder / name, lattice);
        REQUIRE(file.write(slab(volume, lattice, file.slab_axis(), 0, 3).view(), 0));
    }
    CHECK(folder.names() == std::set<std::string>{"a.bits"});
    CHECK(contents(folder / "a.bits") == "older");
}

TEST_CASE("a file that lacks planes gets no name") {
    const TempFolder folder;
    const Lattice lattice = grid(6, 5, 6);
    for (const std::string name : kNames) {
        auto file = writer(folder / name, lattice);
        CHECK_THAT(message(file.commit()), contains(name) && contains("only 0 of 6 planes"));
        REQUIRE(file.write(slab(noise(lattice), lattice, file.slab_axis(), 0, 5).view(), 0));
        CHECK_THAT(message(file.commit()), contains("only 5 of 6 planes"));
    }
    CHECK(folder.names().empty());
}

TEST_CASE("slabs out of order are refused") {
    const TempFolder folder;
    const Lattice lattice = grid(6, 5, 6);
    const BitVolume volume = noise(lattice);
    for (const std::string name : kNames) {
        auto file = writer(folder / name, lattice);
        const auto planes = [&](std::uint32_t count) { return slab(volume, lattice, file.slab_axis(), 0, count); };
        CHECK_THAT(message(file.write(planes(2).view(), 2)), contains("do not follow the 0 of 6"));
        REQUIRE(file.write(planes(2).view(), 0));
        CHECK_THAT(message(file.write(planes(2).view(), 0)),
                   contains("2 planes from plane 0") && contains("the 2 of 6"));
        CHECK_THAT(message(file.write(planes(2).view(), 3)), contains("do not follow"));
        CHECK_THAT(message(file.write(planes(5).view(), 2)), contains("do not follow"));
    }
}

TEST_CASE("slabs of another shape than the lattice's are refused") {
    const TempFolder folder;
    const Lattice lattice = grid(6, 5, 7);
    for (const std::string name : kNames) {
        auto file = writer(folder / name, lattice);
        const bool along_x = file.slab_axis() == io::SlabAxis::X;
        CHECK_THAT(message(file.write(BitVolume(6, 4, 7).view(), 0)), contains("6×4×7 is not on a lattice of 6×5×7"));
        const BitVolume across = along_x ? BitVolume(1, 5, 6) : BitVolume(5, 5, 1);
        CHECK_THAT(message(file.write(across.view(), 0)), contains("is not on a lattice"));
        const BitVolume good = along_x ? BitVolume(1, 5, 7) : BitVolume(6, 5, 1);
        ConstBitVolumeView short_of_words = good.view();
        short_of_words.words = short_of_words.words.first(short_of_words.words.size() - 1);
        CHECK_THAT(message(file.write(short_of_words, 0)), contains("is not on a lattice"));
        CHECK(file.write(good.view(), 0));
    }
}

TEST_CASE("a stop request ends the writing and leaves nothing") {
    const TempFolder folder;
    const Lattice lattice = grid(6, 5, 6);
    const BitVolume volume = noise(lattice);
    for (const std::string name : kNames) {
        std::stop_source stop;
        {
            auto file = writer(folder / name, lattice, stop.get_token());
            REQUIRE(file.write(slab(volume, lattice, file.slab_axis(), 0, 3).view(), 0));
            stop.request_stop();
            CHECK_THAT(message(file.write(slab(volume, lattice, file.slab_axis(), 3, 3).view(), 3)),
                       contains(name + ": stopped"));
        }
        CHECK_THAT(message(io::write_volume(folder / name, volume.view(), lattice, stop.get_token())),
                   contains("stopped"));
    }
    CHECK(folder.names().empty());
}

TEST_CASE("a disk that is full in a later slab leaves nothing") {
    const TempFolder folder;
    const Lattice lattice = grid(200, 20, 200);
    const BitVolume volume = noise(lattice);
    for (const std::string name : kNames) {
        std::string refusal;
        {
            const FileSizeLimit limit(20'000);
            auto file = writer(folder / name, lattice);
            for (std::uint32_t first = 0; first < 200 && refusal.empty(); first += 10) {
                refusal = message(file.write(slab(volume, lattice, file.slab_axis(), first, 10).view(), first));
            }
            if (refusal.empty()) refusal = message(file.commit());
        }
        CHECK_THAT(refusal, contains("cannot be written"));
        CHECK(folder.names().empty());
    }
}

TEST_CASE("a writer tells its progress after each plane, up to 1") {
    const TempFolder folder;
    const Lattice lattice = grid(4, 3, 5);
    for (const std::string name : {"a.nrrd", "a.bits", "a.binvox"}) {
        CAPTURE(name);
        std::vector<double> told;
        auto made = io::VolumeWriter::create(folder / name, lattice, {}, [&](double part) { told.push_back(part); });
        REQUIRE(made);
        const BitVolume volume(lattice);
        REQUIRE(made->write(volume.view(), 0));
        CHECK(told.size() == (made->slab_axis() == io::SlabAxis::X ? 4 : 5));
        CHECK(std::ranges::is_sorted(told));
        CHECK(told.front() == Approx(1.0 / static_cast<double>(told.size())));
        CHECK(told.back() == 1.0);
    }
}
