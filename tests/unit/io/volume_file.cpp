#include "voxelizer/io/volume_file.h"

#include <cstring>
#include <locale>
#include <random>
#include <sstream>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/file_size_limit.h"
#include "tests/unit/io/temp_folder.h"

using namespace xorvox;

namespace {

Lattice grid(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, glm::dvec3 pitch = glm::dvec3(0.5)) {
    Lattice lattice;
    lattice.nx = nx;
    lattice.ny = ny;
    lattice.nz = nz;
    lattice.origin = {1, -2, 0.1};
    lattice.pitch = pitch;
    return lattice;
}

void set(BitVolume& volume, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    volume.view().flip(x, y, z);
}

BitVolume tiny() {
    BitVolume volume(3, 2, 2);
    set(volume, 0, 0, 0);
    set(volume, 2, 1, 0);
    set(volume, 1, 0, 1);
    set(volume, 2, 1, 1);
    return volume;
}

BitVolume noise(const Lattice& lattice, std::uint32_t seed) {
    std::mt19937 random(seed);
    BitVolume volume(lattice);
    for (std::uint32_t z = 0; z < lattice.nz; ++z) {
        for (std::uint32_t y = 0; y < lattice.ny; ++y) {
            for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                if (random() % 3 == 0) set(volume, x, y, z);
            }
        }
    }
    return volume;
}

std::string written(const TempFolder& folder, const std::string& name, const BitVolume& volume,
                    const Lattice& lattice) {
    const auto ok = io::write_volume(folder / name, volume.view(), lattice);
    INFO((ok ? "" : ok.error().message));
    REQUIRE(ok);
    return contents(folder / name);
}

std::string refusal(const std::string& path, const BitVolume& volume, const Lattice& lattice) {
    const auto ok = io::write_volume(path, volume.view(), lattice);
    return ok ? std::string() : ok.error().message;
}

std::string hex(std::string_view bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (const char c : bytes) {
        text += kDigits[static_cast<unsigned char>(c) >> 4];
        text += kDigits[static_cast<unsigned char>(c) & 15];
    }
    return text;
}

// The field `name` of a NRRD header, without parentheses and commas.
std::istringstream field(const std::string& file, const std::string& name) {
    const std::size_t at = file.find("\n" + name + ": ") + name.size() + 3;
    std::string value = file.substr(at, file.find('\n', at) - at);
    for (char& c : value) {
        if (c == '(' || c == ')' || c == ',') c = ' ';
    }
    return std::istringstream(value);
}

}  // namespace

TEST_CASE("nrrd: golden bytes") {
    const TempFolder folder;
    const std::string header =
        "NRRD0004\n"
        "type: uint8\n"
        "dimension: 3\n"
        "space dimension: 3\n"
        "sizes: 3 2 2\n"
        "space directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\n"
        "kinds: domain domain domain\n"
        "endian: little\n"
        "encoding: raw\n"
        "space origin: (1.25,-1.75,0.35)\n"
        "\n";
    CHECK(written(folder, "a.nrrd", tiny(), grid(3, 2, 2)) == header + std::string("\1\0\0\0\0\1"
                                                                                   "\0\1\0\0\0\1",
                                                                                   12));
}

TEST_CASE("binvox: golden bytes; a box is filled up to a cube") {
    const TempFolder folder;
    // Of 27 voxels, y fastest, then z, then x, numbers 0, 12, 19 and 22 are set.
    CHECK(written(folder, "a.binvox", tiny(), grid(3, 2, 2)) ==
          "#binvox 1\ndim 3 3 3\ntranslate 1 -2 0.1\nscale 1.5\ndata\n" +
              std::string("\1\1\0\13\1\1\0\6\1\1\0\2\1\1\0\4", 16));
}

TEST_CASE("binvox: runs are cut at 255") {
    const TempFolder folder;
    const Lattice lattice = grid(8, 8, 8);
    const std::string file = written(folder, "a.binvox", BitVolume(lattice), lattice);
    CHECK(hex(file.substr(file.find("data\n") + 5)) == "00ff00ff0002");
}

TEST_CASE("bits: golden bytes") {
    const TempFolder folder;
    CHECK(hex(written(folder, "a.bits", tiny(), grid(3, 2, 2))) ==
          "5856424954530d0a"
          "01000000"
          "030000000200000002000000"
          "000000000000f03f00000000000000c09a9999999999b93f"
          "000000000000e03f000000000000e03f000000000000e03f"
          "0100000000000000"
          "0400000000000000"
          "0200000000000000"
          "0400000000000000");
}

TEST_CASE("volumes come back from every format, voxel by voxel and place by place") {
    const TempFolder folder;
    for (const Lattice& lattice :
         {grid(1, 1, 1), grid(63, 2, 5), grid(64, 3, 1), grid(65, 4, 3), grid(7, 130, 2), grid(2, 3, 70)}) {
        const BitVolume volume = noise(lattice, lattice.nx);
        const std::string nrrd = written(folder, "a.nrrd", volume, lattice);
        const std::string binvox = written(folder, "a.binvox", volume, lattice);
        const std::string bits = written(folder, "a.bits", volume, lattice);

        std::array<double, 9> directions{};
        glm::dvec3 origin;
        glm::uvec3 sizes;
        auto words = field(nrrd, "space directions");
        for (double& d : directions) words >> d;
        field(nrrd, "space origin") >> origin.x >> origin.y >> origin.z;
        field(nrrd, "sizes") >> sizes.x >> sizes.y >> sizes.z;
        REQUIRE(sizes == glm::uvec3(lattice.nx, lattice.ny, lattice.nz));
        const std::size_t nrrd_data = nrrd.find("\n\n") + 2;
        REQUIRE(nrrd.size() == nrrd_data + lattice.sample_count());

        std::istringstream header(binvox);
        std::string word;
        std::uint32_t n = 0;
        glm::dvec3 translate;
        double scale = 0;
        header >> word >> word >> word >> n >> n >> n >> word >> translate.x >> translate.y >> translate.z >> word >>
            scale;
        std::string cube;
        for (std::size_t i = binvox.find("data\n") + 5; i + 1 < binvox.size(); i += 2) {
            REQUIRE(binvox[i + 1] != 0);
            cube.append(static_cast<unsigned char>(binvox[i + 1]), binvox[i]);
        }
        REQUIRE(cube.size() == std::size_t{n} * n * n);
        REQUIRE(n == std::max({lattice.nx, lattice.ny, lattice.nz}));

        REQUIRE(bits.size() == 72 + volume.view().size_bytes());
        const std::size_t row_bytes = (lattice.nx + 63) / 64 * 8;

        std::size_t wrong = 0;
        std::size_t count = 0;
        double furthest = 0;
        for (std::uint32_t z = 0; z < lattice.nz; ++z) {
            for (std::uint32_t y = 0; y < lattice.ny; ++y) {
                for (std::uint32_t x = 0; x < lattice.nx; ++x) {
                    const bool bit = volume.test(x, y, z);
                    count += bit ? 1u : 0u;
                    const std::size_t plain = x + lattice.nx * (y + std::size_t{lattice.ny} * z);
                    const char packed = bits[72 + row_bytes * (y + std::size_t{lattice.ny} * z) + x / 8];
                    wrong += nrrd[nrrd_data + plain] != (bit ? 1 : 0) ? 1u : 0u;
                    wrong += cube[y + n * (z + std::size_t{n} * x)] != (bit ? 1 : 0) ? 1u : 0u;
                    wrong += ((packed >> (x % 8)) & 1) != (bit ? 1 : 0) ? 1u : 0u;

                    const glm::dvec3 place = sample_position(lattice, x, y, z);
                    const glm::dvec3 in_nrrd =
                        origin + glm::dvec3(x, y, z) * glm::dvec3(directions[0], directions[4], directions[8]);
                    const glm::dvec3 in_binvox =
                        translate + scale * (glm::dvec3(x, y, z) + 0.5) / static_cast<double>(n);
                    for (int axis = 0; axis < 3; ++axis) {
                        furthest = std::max(
                            {furthest, std::abs(place[axis] - in_nrrd[axis]), std::abs(place[axis] - in_binvox[axis])});
                    }
                }
            }
        }
        CHECK(wrong == 0);
        CHECK(furthest < 1e-12);
        CHECK(static_cast<std::size_t>(std::count(cube.begin(), cube.end(), '\1')) == count);
    }
}

TEST_CASE("equal bits give equal files, whatever the name and the locale") {
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        std::string do_grouping() const override { return "\1"; }
    };
    const TempFolder folder;
    const Lattice lattice = grid(10, 11, 12, {1.0 / 3, 1.0 / 3, 1.0 / 3});
    for (const char* extension : {".nrrd", ".binvox", ".bits"}) {
        const std::string first = written(folder, std::string("a") + extension, noise(lattice, 1), lattice);
        const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
        const std::string second = written(folder, std::string("another") + extension, noise(lattice, 1), lattice);
        std::locale::global(before);
        CHECK(first == second);
        CHECK(first != written(folder, std::string("a") + extension, noise(lattice, 2), lattice));
    }
}

TEST_CASE("nrrd and bits keep unequal pitches, binvox refuses them") {
    const TempFolder folder;
    const Lattice lattice = grid(2, 2, 2, {1, 2, 3});
    const BitVolume volume(lattice);
    CHECK_THAT(written(folder, "a.nrrd", volume, lattice), contains("space directions: (1,0,0) (0,2,0) (0,0,3)\n"));
    CHECK(written(folder, "a.bits", volume, lattice).size() == 72 + 32);
    CHECK_THAT(refusal(folder / "a.binvox", volume, lattice), contains("one pitch") && contains(".nrrd or .bits"));
    CHECK(folder.names() == std::set<std::string>{"a.bits", "a.nrrd"});
}

TEST_CASE("volumes are refused with a reason and no file") {
    const TempFolder folder;
    const Lattice lattice = grid(2, 2, 2);
    const BitVolume volume(lattice);
    CHECK_THAT(refusal(folder / "a.vdb", volume, lattice),
               contains("a.vdb: ") && contains("'.vdb'") && contains(".nrrd, .binvox, ") && contains(".png or .bits"));
    CHECK_THAT(refusal(folder / "a.d/nrrd", volume, lattice), contains("''"));
    CHECK_FALSE(io::check_volume_path("a.vdb"));
    CHECK(io::check_volume_path("a.NRRD"));
    CHECK(io::check_volume_path("a.b/.c.nrrd"));
    for (const std::string name : {".nrrd", ".NRRD", ".bits", "./.binvox"}) {
        const auto known = io::check_volume_path(folder / name);
        REQUIRE_FALSE(known);
        CHECK_THAT(known.error().message, contains(name + ": has no name before its extension"));
        CHECK_FALSE(io::check_volume_path(name));
    }
    CHECK_THAT(refusal(folder / "a\n.v\nx", volume, lattice), contains("/a\\x0a.v\\x0ax: the extension '.v\\x0ax'"));
    CHECK_THAT(refusal(folder / "a\n.nrrd", BitVolume(2, 2, 3), lattice), contains("/a\\x0a.nrrd: a volume of"));
    CHECK_THAT(refusal(folder / "a.nrrd", BitVolume(2, 2, 3), lattice),
               contains("a volume of 2×2×3 is not on a lattice of 2×2×2"));
    Lattice bad = lattice;
    bad.pitch.y = 0;
    CHECK_THAT(refusal(folder / "a.nrrd", volume, bad), contains("not valid"));
    const std::vector<glm::dvec2> plan(4);
    const std::vector<double> z = {0, 1};
    Lattice table = lattice;
    table.plan = plan;
    table.z = z;
    CHECK_THAT(refusal(folder / "a.nrrd", volume, table), contains("regular grid"));
    CHECK_THAT(refusal(folder / "no/a.nrrd", volume, lattice), contains("cannot be created"));
    CHECK(folder.names().empty());
}

TEST_CASE("a full disk leaves no part of a volume") {
    const TempFolder folder;
    const Lattice lattice = grid(200, 20, 20);
    for (const char* name : {"a.nrrd", "a.binvox", "a.bits"}) {
        std::string message;
        {
            const FileSizeLimit limit(500);
            message = refusal(folder / name, noise(lattice, 1), lattice);
        }
        CHECK_THAT(message, contains("cannot be written"));
        CHECK(folder.names().empty());
    }
}
