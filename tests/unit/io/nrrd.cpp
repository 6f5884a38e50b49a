#include <numeric>
#include <string>

#include <sys/stat.h>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/temp_folder.h"
#include "tests/unit/io/volume_bytes.h"
#include "tests/unit/io/volume_hostile.h"
#include "voxelizer/io/volume_reader.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

const ParseVolume kParse = [](std::string_view bytes, std::string_view source) {
    return io::parse_nrrd(bytes, source);
};

VolumeSequence parsed(const std::string& bytes) {
    auto sequence = io::parse_nrrd(bytes, "file");
    INFO((sequence ? "" : sequence.error().message));
    REQUIRE(sequence);
    return std::move(*sequence);
}

SampledVolume only(const std::string& bytes) {
    VolumeSequence sequence = parsed(bytes);
    REQUIRE(sequence.frames.size() == 1);
    return sequence.frames[0];
}

template <class T>
void check_type(const std::string& name) {
    std::vector<T> numbers(12);
    std::iota(numbers.begin(), numbers.end(), static_cast<T>(std::is_signed_v<T> ? -3 : 3));
    std::vector<float> expected;
    for (const T number : numbers) expected.push_back(static_cast<float>(number));
    for (const bool big : {false, true}) {
        const std::string endian = big ? "endian: big\n" : "endian: little\n";
        CAPTURE(name, big);
        CHECK(only(nrrd(name, "raw", endian) + raw_all(numbers, big)).values == expected);
        CHECK(only(nrrd(name, "gzip", endian) + gzip(raw_all(numbers, big))).values == expected);
    }
}

const std::string kBytes("\0\1\2\3\4\5\6\7\10\11\12\13", 12);

}  // namespace

TEST_CASE("nrrd: scalars of every type, in both byte orders, raw and gzip") {
    check_type<std::int8_t>("signed char");
    check_type<std::uint8_t>("uchar");
    check_type<std::int16_t>("short");
    check_type<std::uint16_t>("unsigned short int");
    check_type<std::int32_t>("int32_t");
    check_type<std::uint32_t>("uint");
    check_type<std::int64_t>("long long");
    check_type<std::uint64_t>("uint64");
    check_type<float>("float");
    check_type<double>("double");
}

TEST_CASE("nrrd: the first axis runs fastest; where nothing is told, voxels are 1 mm from 0 on") {
    const SampledVolume volume = only(nrrd("uint8", "raw") + kBytes);
    CHECK(volume.kind == VolumeKind::Scalar);
    CHECK(glm::uvec3(volume.nx, volume.ny, volume.nz) == glm::uvec3(2, 3, 2));
    CHECK(volume.values[volume.index(1, 2, 1)] == 11.0f);
    CHECK(volume.to_mm == glm::dmat4(1.0));
}

TEST_CASE("nrrd: directions, origin, spacings, units and anatomical spaces place the volume") {
    const auto place = [](const std::string& more) { return only(nrrd("uint8", "raw", more) + kBytes).to_mm; };
    const glm::dvec4 far(1, 2, 3, 1);
    CHECK(place("space dimension: 3\nspace directions: (0,2,0) (0,0,3) (4,0,0)\nspace origin: (1,2,3)\n") * far ==
          glm::dvec4(13, 4, 9, 1));
    CHECK(place("spacings: 2 3 nan\n") * far == glm::dvec4(2, 6, 3, 1));
    CHECK(place("space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (5,5,5)\n") *
              far ==
          glm::dvec4(-6, -7, 8, 1));
    CHECK(place("space: RAS\nspace units: \"cm\" \"mm\" \"mm\"\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n") * far ==
          glm::dvec4(10, 2, 3, 1));
}

TEST_CASE("nrrd: three or four channels of bytes are colours, a last axis of time is frames") {
    const std::string header = "NRRD0005\ntype: uint8\ndimension: 4\nencoding: raw\n";
    const SampledVolume rgb = only(header + "sizes: 3 2 1 1\nkinds: RGB-color domain domain domain\n\nabcdef");
    REQUIRE(rgb.kind == VolumeKind::Colors);
    CHECK(rgb.colors == std::vector<Rgba>{{'a', 'b', 'c', 255}, {'d', 'e', 'f', 255}});
    const SampledVolume rgba = only(header +
                                    "sizes: 4 1 1 1\nspace dimension: 3\nspace directions: none (2,0,0) (0,2,0) "
                                    "(0,0,2)\n\nabcd");
    CHECK(rgba.colors == std::vector<Rgba>{{'a', 'b', 'c', 'd'}});
    CHECK(rgba.to_mm[0][0] == 2.0);
    const VolumeSequence frames = parsed(header + "sizes: 2 1 1 3\nkinds: space space space time\n\nabcdef");
    REQUIRE(frames.frames.size() == 3);
    CHECK(frames.frames[2].values == std::vector<float>{'e', 'f'});
    CHECK_THAT(refusal(kParse, header + "sizes: 5 1 1 1\n\nabcde"), contains("an axis of 5"));
    CHECK_THAT(refusal(kParse, header + "sizes: 3 1 1 1\nkinds: 3-normal domain domain domain\n\nabc"),
               contains("3-normal"));
}

TEST_CASE("nrrd: labels where the file says so; binary where whole numbers are only 0 and 1") {
    CHECK(only(nrrd("uint8", "raw", "content: my Labelmap\n") + kBytes).kind == VolumeKind::Labels);
    CHECK(only(nrrd("uint8", "raw", "Segment0_ID:=heart\n") + kBytes).kind == VolumeKind::Labels);
    CHECK(only(nrrd("uint8", "raw") + std::string("\0\1\1\0\0\1\0\1\1\0\0\1", 12)).kind == VolumeKind::Binary);
    CHECK(only(nrrd("float", "raw", "endian: little\n") + raw_all(std::vector<float>(12, 1.0f))).kind ==
          VolumeKind::Scalar);
    CHECK_THAT(refusal(kParse, nrrd("int8", "raw", "content: labels\n") + std::string(12, '\xff')),
               contains("voxel (0, 0, 0) is -1, which is no label"));
}

TEST_CASE("nrrd: lines and bytes are skipped as told") {
    CHECK(only(nrrd("uint8", "raw", "line skip: 2\nbyte skip: 3\n") + "a\nb\nxyz" + kBytes).values[11] == 11.0f);
    CHECK(only(nrrd("uint8", "raw", "byte skip: -1\n") + "any number of them" + kBytes).values[11] == 11.0f);
    CHECK(only(nrrd("uint8", "gzip", "byteskip: 3\n") + gzip("xyz" + kBytes)).values[11] == 11.0f);
    CHECK_THAT(refusal(kParse, nrrd("uint8", "raw", "line skip: 9\n") + kBytes), contains("should be skipped"));
}

TEST_CASE("nrrd: data beside a detached header are read, no other files") {
    const TempFolder folder;
    put(folder / "a.raw", kBytes);
    put(folder / "a.nhdr", nrrd("uint8", "raw", "data file: a.raw\n"));
    const auto volume = io::read_volumes(folder / "a.nhdr");
    INFO((volume ? "" : volume.error().message));
    REQUIRE(volume);
    CHECK(volume->frames[0].values[11] == 11.0f);
    put(folder / "b.nhdr", nrrd("uint8", "raw", "data file: b.raw\n"));
    CHECK_THAT(io::read_volumes(folder / "b.nhdr").error().message, contains("b.raw") && contains("No such file"));
    const auto refused = [&folder](const std::string& name) {
        put(folder / "c.nhdr", nrrd("uint8", "raw", "data file: " + name + "\n"));
        return io::read_volumes(folder / "c.nhdr").error().message;
    };
    for (const char* name : {"LIST", "a%d.raw 1 2 1"}) CHECK_THAT(refused(name), contains("no list or pattern"));
    CHECK_THAT(refused("/etc/passwd"), contains("c.nhdr: names '/etc/passwd', which is an absolute path"));
    CHECK_THAT(refused("../a.raw"), contains("leads out of the folder"));
    CHECK_THAT(refused(".."), contains("leads out of the folder"));
    CHECK_THAT(refused("."), contains("is no regular file"));
    REQUIRE(::mkfifo((folder / "pipe.raw").c_str(), 0600) == 0);
    CHECK_THAT(refused("pipe.raw"), contains("'pipe.raw', which is no regular file"));
}

TEST_CASE("nrrd: values that are not finite are refused with their voxel") {
    std::vector<float> values(12, 1.0f);
    values[9] = std::nanf("");
    CHECK_THAT(refusal(kParse, nrrd("float", "raw", "endian: little\n") + raw_all(values)),
               contains("voxel (1, 1, 1) is nan"));
    std::vector<double> large(12, 1.0);
    large[0] = 1e300;
    CHECK_THAT(refusal(kParse, nrrd("double", "raw", "endian: little\n") + raw_all(large)),
               contains("voxel (0, 0, 0) is 1e+300"));
}

TEST_CASE("nrrd: what is not read is refused by name, with its line") {
    const auto refused = [](const std::string& type, const std::string& encoding, const std::string& more) {
        return refusal(kParse, nrrd(type, encoding, more) + kBytes);
    };
    CHECK_THAT(refused("block", "raw", ""), contains("line 2") && contains("'block'"));
    CHECK_THAT(refused("uint8", "ascii", ""), contains("line 5") && contains("'ascii'"));
    CHECK_THAT(refused("uint8", "bzip2", ""), contains("'bzip2'"));
    CHECK_THAT(refused("short", "raw", ""), contains("endian:"));
    CHECK_THAT(refused("uint8", "raw", "space: 3D-left-handed\n"), contains("'3D-left-handed'"));
    CHECK_THAT(refused("uint8", "raw", "space directions: (1,0,0) (2,0,0) (0,0,1)\n"), contains("do not span"));
    CHECK_THAT(refused("uint8", "raw", "space directions: (1,0,0) (0,1) (0,0,1)\n"), contains("three vectors"));
    CHECK_THAT(refused("uint8", "raw", "type: short\n"), contains("twice"));
    CHECK_THAT(refused("uint8", "raw", "flavour: mint\n"), contains("'flavour'"));
    CHECK_THAT(refused("uint8", "raw", "nonsense\n"), contains("is no field"));
    CHECK_THAT(refusal(kParse, "NRRD0006\n"), contains("NRRD0005"));
    CHECK_THAT(refusal(kParse, "NRRD0004\ntype: uint8\n\n"), contains("dimension"));
    CHECK_THAT(refusal(kParse, "NRRD0004\ndimension: 2\n\n"), contains("'2'"));
}

TEST_CASE("nrrd: sizes are not believed before the bytes are there") {
    const std::string head = "NRRD0004\ntype: double\nendian: little\ndimension: 3\n";
    CHECK_THAT(refusal(kParse, head + "sizes: 1024 1024 1024\nencoding: raw\n\nabc"), contains("cut short"));
    CHECK_THAT(refusal(kParse, head + "sizes: 1024 1024 1024\nencoding: gzip\n\nabc"), contains("cannot hold"));
    CHECK_THAT(refusal(kParse, head + "sizes: 99999 2 2\nencoding: raw\n\nabc"), contains("99999 × 2 × 2"));
    CHECK_THAT(refusal(kParse, head + "sizes: 2 2 99999999999999999999\nencoding: raw\n\nabc"), contains("sizes"));
    CHECK_THAT(refusal(kParse, nrrd("uint8", "gzip") + gzip(kBytes.substr(1))), contains("hold 11 bytes"));
    CHECK_THAT(refusal(kParse, nrrd("uint8", "gzip") + gzip("")), contains("hold 0 bytes"));
    // A bomb: much more than the header tells.
    const std::string bomb = gzip(std::string(10'000'000, '\0'));
    CHECK_THAT(refusal(kParse, nrrd("uint8", "gzip") + bomb), contains("hold more bytes") && contains("12"));
}

TEST_CASE("nrrd: gzip data of many members are theirs, one after the other") {
    std::string members = gzip(kBytes.substr(0, 5));
    const std::string empty = gzip("");
    for (int n = 0; n < 20000; ++n) members += empty;
    CHECK(only(nrrd("uint8", "gzip") + members + gzip(kBytes.substr(5))).values[11] == 11.0f);
    CHECK_THAT(refusal(kParse, nrrd("uint8", "gzip") + members), contains("hold 5 bytes"));
}

TEST_CASE("nrrd: hostile bytes give a sound volume or one line") {
    const std::string more = "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (1,2,3)\n";
    const std::string plain = nrrd("uint8", "raw", more) + kBytes;
    check_hostile_volume(kParse, plain, plain.size());
    const std::string packed = nrrd("uint8", "gzip", more) + gzip(kBytes);
    check_hostile_volume(kParse, packed, packed.size());
}
