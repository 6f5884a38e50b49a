#include <algorithm>
#include <bit>
#include <cstring>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/hostile.h"
#include "voxelizer/io/mesh_file.h"

using namespace xorvox;

namespace {

const Parse kParse = io::parse_ply;

const std::string kAscii =
    "ply\n"
    "format ascii 1.0\n"
    "comment a tetrahedron\n"
    "element vertex 4\n"
    "property float x\n"
    "property float y\n"
    "property float z\n"
    "element face 4\n"
    "property list uchar int vertex_indices\n"
    "end_header\n"
    "0 0 0\n"
    "1 0 0\n"
    "0 1 0\n"
    "0 0 0.1\n"
    "3 0 2 1\n"
    "3 0 1 3\n"
    "3 1 2 3\n"
    "3 2 0 3\n";

template <class T>
void append(std::string& bytes, T value, std::endian order) {
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &value, sizeof(T));
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    bytes += raw;
}

// Types of all kinds, properties in an odd order, things to pass over before, between and after.
std::string mixed_binary(std::endian order) {
    std::string ply = std::string("ply\nformat ") +
                      (order == std::endian::big ? "binary_big_endian" : "binary_little_endian") +
                      " 1.0\n"
                      "obj_info made by hand\n"
                      "element camera 2\nproperty list uchar double matrix\nproperty short id\n"
                      "element vertex 4\nproperty double z\nproperty uchar red\nproperty int16 x\n"
                      "property list ushort float weights\nproperty float32 y\n"
                      "element nothing 3\n"
                      "element face 2\nproperty int8 flag\nproperty list int32 uint16 vertex_index\nproperty float q\n"
                      "element edge 1\nproperty int a\nproperty uint32 b\n"
                      "end_header\n";
    for (int camera = 0; camera < 2; ++camera) {
        append(ply, std::uint8_t{2}, order);
        append(ply, 1.5, order);
        append(ply, 2.5, order);
        append(ply, std::int16_t{7}, order);
    }
    for (int i = 0; i < 4; ++i) {
        append(ply, 0.1 * i, order);
        append(ply, std::uint8_t{255}, order);
        append(ply, static_cast<std::int16_t>(-300 + i), order);
        append(ply, static_cast<std::uint16_t>(i), order);
        for (int k = 0; k < i; ++k) append(ply, 3.0f, order);
        append(ply, 0.25f * static_cast<float>(i * i), order);
    }
    for (const auto& face : {std::vector<std::uint16_t>{0, 1, 2, 3}, std::vector<std::uint16_t>{2, 1, 0}}) {
        append(ply, std::int8_t{-1}, order);
        append(ply, static_cast<std::int32_t>(face.size()), order);
        for (const std::uint16_t v : face) append(ply, v, order);
        append(ply, 0.0f, order);
    }
    append(ply, 1, order);
    append(ply, 2u, order);
    return ply;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("ply: an ascii file of triangles has no ring table") {
    const auto mesh = io::parse_ply(kAscii, "file");
    REQUIRE(mesh);
    CHECK(mesh->positions.size() == 4);
    CHECK(mesh->positions[3] == glm::dvec3(0, 0, 0.1));  // The double nearest to 0.1, though declared float.
    CHECK(mesh->indices == std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3});
    CHECK(mesh->ring_starts.empty());
    CHECK(mesh->face_starts.empty());
}

TEST_CASE("ply: carriage returns, blank lines, tabs and plus signs are read") {
    std::string dos;
    for (const char c : kAscii) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const auto mesh = io::parse_ply(replaced(dos, "1 0 0\r\n", "\r\n\t+1  -0.0\t+0e0 \r\n"), "file");
    REQUIRE(mesh);
    CHECK(mesh->positions[1] == glm::dvec3(1, 0, 0));
    CHECK(mesh->view().face_count() == 4);
}

TEST_CASE("ply: any types, any order, both byte orders; the rest is skipped and polygons stay polygons") {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const auto mesh = io::parse_ply(mixed_binary(order), "file");
        REQUIRE(mesh);
        REQUIRE(mesh->positions.size() == 4);
        for (int i = 0; i < 4; ++i) {
            CHECK(mesh->positions[static_cast<std::size_t>(i)] == glm::dvec3(-300 + i, 0.25 * (i * i), 0.1 * i));
        }
        CHECK(mesh->ring_starts == std::vector<std::uint32_t>{0, 4, 7});
        CHECK(mesh->indices == std::vector<std::uint32_t>{0, 1, 2, 3, 2, 1, 0});
    }
}

TEST_CASE("ply: values that are skipped need not be finite") {
    std::string text = replaced(kAscii, "property float z\n", "property float z\nproperty float nx\n");
    for (const char* vertex : {"0 0 0\n", "1 0 0\n", "0 1 0\n", "0 0 0.1\n"}) {
        text = replaced(text, vertex, std::string(vertex, std::strlen(vertex) - 1) + " nan\n");
    }
    CHECK(io::parse_ply(text, "file"));
}

TEST_CASE("ply: a ring table begins with the first polygon that is no triangle") {
    const std::string text = replaced(replaced(kAscii, "3 1 2 3\n", "4 0 1 2 3\n"), "3 2 0 3\n", "3 2 0 3\n");
    const auto mesh = io::parse_ply(text, "file");
    REQUIRE(mesh);
    CHECK(mesh->ring_starts == std::vector<std::uint32_t>{0, 3, 6, 10, 13});
}

TEST_CASE("ply: what is wrong in the header is named with its line") {
    const auto with = [](std::string_view from, std::string_view to) {
        return refusal(kParse, replaced(kAscii, from, to));
    };
    CHECK_THAT(with("ply\n", "plx\n"), contains("file: line 1: ") && contains("'plx\\x0aform'"));
    CHECK_THAT(with("ascii", "binary"), contains("line 2") && contains("'binary'") && contains("binary_little_endian"));
    CHECK_THAT(with("1.0", "2.0"), contains("line 2") && contains("'2.0'"));
    CHECK_THAT(with("vertex 4", "vertex four"), contains("line 4") && contains("'four'"));
    CHECK_THAT(with("vertex 4", "vertex -4"), contains("line 4") && contains("negative"));
    CHECK_THAT(with("vertex 4", "vertex 99999999999999999999"), contains("line 4") && contains("too large"));
    CHECK_THAT(with("float x", "real x"), contains("line 5") && contains("'real'"));
    CHECK_THAT(with("float x", "float y"), contains("line 6") && contains("second property 'y'"));
    CHECK_THAT(with("float x", "list uchar float x"), contains("line 5") && contains("single number"));
    CHECK_THAT(with("float x", "float u"), contains("x, y and z"));
    CHECK_THAT(with("uchar int", "float int"), contains("line 9") && contains("integer"));
    CHECK_THAT(with("uchar int", "uchar float"), contains("line 9") && contains("list of integers"));
    CHECK_THAT(with("vertex_indices", "corners"), contains("no element 'face' with a list vertex_indices"));
    CHECK_THAT(with("face 4", "face 4 5"), contains("line 8") && contains("'5'"));
    CHECK_THAT(with("element face", "element vertex"), contains("line 8") && contains("second element"));
    CHECK_THAT(with("end_header", "end"), contains("line 10") && contains("'end'"));
}

TEST_CASE("ply: what is wrong in ascii data is named with its line") {
    const auto with = [](std::string_view from, std::string_view to) {
        return refusal(kParse, replaced(kAscii, from, to));
    };
    CHECK_THAT(with("0 1 0\n", "0 1\n"),
               contains("line 13") && contains("entry 2 of element 'vertex'") && contains("too few"));
    CHECK_THAT(with("0 1 0\n", "0 1 0 0\n"), contains("line 13") && contains("unexpected '0'"));
    CHECK_THAT(with("0 1 0\n", "0 1,5 0\n"), contains("line 13") && contains("'1,5' is not a number"));
    CHECK_THAT(with("0 1 0\n", "0 nan 0\n"), contains("line 13") && contains("'nan' is not a finite number"));
    CHECK_THAT(with("0 1 0\n", "0 -inf 0\n"), contains("'-inf' is not a finite number"));
    CHECK_THAT(with("0 1 0\n", "0 1e999 0\n"), contains("'1e999' is beyond the range of a double"));
    CHECK_THAT(with("0 1 0\n", "0 0x1p3 0\n"), contains("'0x1p3' is not a number"));
    CHECK_THAT(with("3 0 2 1\n", "3 0 2 4\n"), contains("line 15") && contains("vertex 4 of a file with 4"));
    CHECK_THAT(with("3 0 2 1\n", "3 0 2 -1\n"), contains("vertex -1 of a file with 4"));
    CHECK_THAT(with("3 0 2 1\n", "2 0 2\n"), contains("polygon of 2 corners"));
    CHECK_THAT(with("3 0 2 1\n", "3 0 2 1.5\n"), contains("'1.5' is not a whole number"));
    CHECK_THAT(with("3 0 2 1\n", "9223372036854775807 0 2 1\n"), contains("too few"));
    CHECK_THAT(with("3 2 0 3\n", ""), contains("entry 3 of element 'face': the file ends here; it was cut short"));
    CHECK_THAT(refusal(kParse, kAscii + "3 0 1 2\n"), contains("line 19: unexpected '3' after the last element"));
    CHECK(io::parse_ply(kAscii + " \r\n\n", "file"));
}

TEST_CASE("ply: a count that the bytes cannot hold takes no memory") {
    for (const char* element : {"vertex 4", "face 4"}) {
        const std::string huge = std::string(element, std::strlen(element) - 1) + "4000000000";
        CHECK_THAT(refusal(kParse, replaced(kAscii, element, huge)),
                   contains("line 1") && contains("4000000000 entries") && contains("too short"));
        const std::string binary = mixed_binary(std::endian::little);
        const std::string original = std::string(element) == "face 4" ? "face 2" : element;
        CHECK_THAT(refusal(kParse, replaced(binary, original, huge)), contains("byte ") && contains("too short"));
    }
    // An element without properties has no bytes, however often it is there.
    CHECK(
        io::parse_ply(replaced(mixed_binary(std::endian::little), "nothing 3", "nothing 9000000000000000000"), "file"));
}

TEST_CASE("ply: what is wrong in binary data is named with its byte") {
    std::string header = kAscii.substr(0, kAscii.find("0 0 0\n"));
    header = replaced(header, "ascii", "binary_little_endian");
    const auto file = [&](float x, std::int32_t corner, std::string_view end) {
        std::string ply = header;
        for (int i = 0; i < 12; ++i) append(ply, i == 4 ? x : static_cast<float>(i), std::endian::little);
        for (int f = 0; f < 4; ++f) {
            append(ply, std::uint8_t{3}, std::endian::little);
            for (int i = 0; i < 3; ++i) append(ply, f == 1 ? corner : i, std::endian::little);
        }
        return ply + std::string(end);
    };
    const std::size_t start = header.size();
    CHECK(io::parse_ply(file(0, 0, ""), "file"));
    CHECK_THAT(refusal(kParse, file(NAN, 0, "")),
               contains("byte " + std::to_string(start + 16) + ": entry 1 of element 'vertex'"));
    CHECK_THAT(refusal(kParse, file(INFINITY, 0, "")), contains("not a finite number"));
    CHECK_THAT(refusal(kParse, file(0, -5, "")), contains("byte " + std::to_string(start + 48 + 13 + 1) + ": ") &&
                                                     contains("vertex -5 of a file with 4"));
    CHECK_THAT(refusal(kParse, file(0, 0, "xyz")),
               contains("byte " + std::to_string(start + 48 + 52) + ": 3 more bytes"));
    CHECK_THAT(refusal(kParse, file(0, 0, "").substr(0, start + 99)),
               contains("entry 3 of element 'face': the file ends here; it was cut short"));
    std::string wide = mixed_binary(std::endian::little);
    CHECK_THAT(refusal(kParse, wide.substr(0, wide.size() - 1)), contains("cut short"));
}

TEST_CASE("ply: a polygon of too few corners is named, not the size of the file") {
    const std::string vertices = kAscii.substr(0, kAscii.find("3 0 2 1\n"));
    CHECK_THAT(refusal(kParse, vertices + "2 0 1\n2 0 1\n2 0 1\n2 0 1\n"),
               contains("line 15: entry 0 of element 'face': a polygon of 2 corners; it needs at least three"));
    CHECK_THAT(refusal(kParse, vertices + "-1\n-1\n-1\n-1\n"),
               contains("line 15: ") && contains("a polygon of -1 corners"));
    CHECK_THAT(refusal(kParse, vertices + "3 0 1 2\n0\n0\n0"),
               contains("line 16: ") && contains("a polygon of 0 corners"));

    std::string header = replaced(kAscii.substr(0, kAscii.find("0 0 0\n")), "ascii", "binary_little_endian");
    header = replaced(header, "uchar", "char") + std::string(48, '\0');
    const std::string byte = "byte " + std::to_string(header.size()) + ": entry 0 of element 'face': ";
    CHECK_THAT(refusal(kParse, header + std::string("\2\0\0\0\0\1\0\0\0", 9)),
               contains(byte + "a polygon of 2 corners"));
    CHECK_THAT(refusal(kParse, header + "\xff\xff\xff\xff"), contains(byte + "a polygon of -1 corners"));
}

TEST_CASE("ply: a file of points has no faces to read") {
    const std::string text = replaced(kAscii, "face 4", "face 0");
    CHECK_THAT(refusal(kParse, text.substr(0, text.find("3 0 2 1"))), contains("file: 4 vertices but no faces"));
}

TEST_CASE("ply: cut at every length and mutated at random it gives a mesh or a message") {
    check_hostile_variants(kParse, kAscii);
    check_hostile_variants(kParse, mixed_binary(std::endian::little));
    check_hostile_variants(kParse, mixed_binary(std::endian::big));
}

TEST_CASE("ply: no part of a binary file is a file") {
    const std::string file = mixed_binary(std::endian::big);
    for (std::size_t length = 0; length < file.size(); ++length) {
        CHECK_FALSE(io::parse_ply(std::string_view(file).substr(0, length), "file"));
    }
}
