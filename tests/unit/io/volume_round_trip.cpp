// What is written comes back: the same bits at the same place, in every format that xorvox reads.
#include <random>
#include <string>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/file_size_limit.h"
#include "tests/unit/io/temp_folder.h"
#include "voxelizer/io/volume_file.h"
#include "voxelizer/io/volume_reader.h"

using namespace xorvox;

namespace {

Lattice grid(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
    Lattice lattice;
    lattice.nx = nx;
    lattice.ny = ny;
    lattice.nz = nz;
    lattice.origin = {1, -2, 0.1};
    lattice.pitch = glm::dvec3(0.3);
    return lattice;
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

struct Case {
    std::string output;
    std::string input;
    double tolerance;  // Of the place, in mm; below 0: the format has none.
    bool gzip = false;
};

const Case kCases[] = {{"a.nrrd", "a.nrrd", 1e-12},      {"z.nrrd", "z.nrrd", 1e-12, true},
                       {"a.binvox", "a.binvox", 1e-12},  {"a.nii", "a.nii", 1e-5},
                       {"a.nii.gz", "a.nii.gz", 1e-5},   {"a.vox", "a.vox", -1},
                       {"slice.png", "slice000.png", -1}};

}  // namespace

TEST_CASE("volumes are read as they were written, bit by bit and place by place") {
    const Lattice lattice = GENERATE(grid(1, 1, 1), grid(65, 4, 3), grid(7, 130, 2), grid(2, 3, 70));
    const BitVolume volume = noise(lattice);
    for (const Case& c : kCases) {
        const TempFolder folder;
        CAPTURE(c.output, lattice.nx);
        REQUIRE(io::write_volume(folder / c.output, volume.view(), lattice, {}, {.gzip = c.gzip}));
        const auto sequence = io::read_volumes(folder / c.input);
        INFO((sequence ? "" : sequence.error().message));
        REQUIRE(sequence);
        REQUIRE(sequence->frames.size() == 1);
        const SampledVolume& read = sequence->frames[0];
        CHECK(read.kind == (c.output == "a.vox" ? VolumeKind::Labels : VolumeKind::Binary));
        REQUIRE(read.nx >= lattice.nx);  // binvox is filled up to a cube.
        std::size_t wrong = 0;
        double furthest = 0;
        for (std::uint32_t z = 0; z < read.nz; ++z) {
            for (std::uint32_t y = 0; y < read.ny; ++y) {
                for (std::uint32_t x = 0; x < read.nx; ++x) {
                    const bool there = x < lattice.nx && y < lattice.ny && z < lattice.nz;
                    const bool bit = there && volume.test(x, y, z);
                    wrong += (read.values[read.index(x, y, z)] != 0.0f) != bit ? 1u : 0u;
                    const glm::dvec3 place(read.to_mm * glm::dvec4(x, y, z, 1));
                    furthest = std::max(furthest, glm::length(place - sample_position(lattice, x, y, z)));
                }
            }
        }
        CHECK(wrong == 0);
        if (c.tolerance >= 0) CHECK(furthest <= c.tolerance);
    }
}

TEST_CASE("equal bits give equal packed files") {
    const TempFolder folder;
    const Lattice lattice = grid(40, 11, 12);
    for (const char* extension : {".nii.gz", ".nii", ".vox"}) {
        REQUIRE(io::write_volume(folder / (std::string("a") + extension), noise(lattice).view(), lattice));
        REQUIRE(io::write_volume(folder / (std::string("b") + extension), noise(lattice).view(), lattice));
        CHECK(contents(folder / (std::string("a") + extension)) == contents(folder / (std::string("b") + extension)));
    }
}

TEST_CASE("what a format cannot hold is refused, and nothing is left behind") {
    const TempFolder folder;
    const auto refusal = [&](const std::string& name, const Lattice& lattice, io::VolumeWriteOptions options = {}) {
        const auto ok = io::write_volume(folder / name, BitVolume(lattice).view(), lattice, {}, options);
        return ok ? std::string() : ok.error().message;
    };
    CHECK_THAT(refusal("a.vox", grid(257, 1, 1)), contains("256 voxels a side") && contains("smaller grid"));
    Lattice flat = grid(2, 2, 2);
    flat.pitch.z = 1;
    CHECK_THAT(refusal("a.vox", flat), contains("cubes"));
    CHECK_THAT(refusal("a.nii.gz", grid(2, 2, 2), {.gzip = true}), contains("only .nrrd"));
    CHECK_THAT(refusal("slice7.png", grid(2, 2, 2)), contains("ends in a number"));
    CHECK_THAT(refusal("no/slice.png", grid(2, 2, 2)), contains("cannot be created"));
    CHECK(folder.names().empty());
}

TEST_CASE("a stack replaces its own pictures, and is refused where others would join it") {
    const TempFolder folder;
    const Lattice lattice = grid(2, 2, 2);
    REQUIRE(io::write_volume(folder / "s.png", noise(lattice).view(), lattice));
    REQUIRE(io::write_volume(folder / "s.png", noise(lattice).view(), lattice));
    CHECK(folder.names() == std::set<std::string>{"s000.png", "s001.png"});
    const Lattice lower = grid(2, 2, 1);
    const auto refused = io::write_volume(folder / "s.png", noise(lower).view(), lower);
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, contains("s001.png would be taken for a part of this stack"));
    CHECK(folder.names() == std::set<std::string>{"s000.png", "s001.png"});
}

TEST_CASE("a full disk leaves no part of a packed volume or a stack") {
    const TempFolder folder;
    const Lattice lattice = grid(200, 40, 40);
    for (const char* name : {"a.nii", "a.nii.gz", "a.vox", "a.png"}) {
        std::string message;
        {
            const FileSizeLimit limit(500);
            const auto ok = io::write_volume(folder / name, noise(lattice).view(), lattice);
            message = ok ? "" : ok.error().message;
        }
        CHECK_THAT(message, contains("cannot be written"));
        CHECK(folder.names().empty());
    }
}
