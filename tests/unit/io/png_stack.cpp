#include <cstdint>
#include <string>
#include <vector>

#include <png.h>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/temp_folder.h"
#include "tests/unit/io/volume_hostile.h"
#include "voxelizer/io/png_picture.h"
#include "voxelizer/io/volume_reader.h"

using namespace xorvox;

namespace {

/// A PNG of `bits` a sample and PNG's colour type; `bytes` has whole rows.
std::string png(std::uint32_t width, std::uint32_t height, int bits, int type, std::vector<std::uint8_t> bytes,
                bool interlaced = false) {
    std::string file;
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(writer);
    png_set_write_fn(
        writer, &file,
        [](png_structp p, png_bytep from, std::size_t size) {
            static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(from), size);
        },
        [](png_structp) {});
    png_set_IHDR(writer, info, width, height, bits, type, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (type == PNG_COLOR_TYPE_PALETTE) {
        const png_color palette[] = {{1, 2, 3}, {4, 5, 6}};
        png_set_PLTE(writer, info, palette, 2);
    }
    png_write_info(writer, info);
    std::vector<png_bytep> rows;
    for (std::uint32_t y = 0; y < height; ++y) rows.push_back(bytes.data() + bytes.size() / height * y);
    png_write_image(writer, rows.data());
    png_write_end(writer, info);
    png_destroy_write_struct(&writer, &info);
    return file;
}

std::string grey8(std::uint8_t value) {
    return png(2, 2, 8, PNG_COLOR_TYPE_GRAY, {value, 1, 2, 3});
}

SampledVolume read(const std::string& path) {
    auto sequence = io::read_volumes(path);
    INFO((sequence ? "" : sequence.error().message));
    REQUIRE(sequence);
    REQUIRE(sequence->frames.size() == 1);
    REQUIRE(test::is_sound(sequence->frames[0]));
    return sequence->frames[0];
}

std::string refused(const std::string& path) {
    const auto sequence = io::read_volumes(path);
    return sequence ? std::string() : sequence.error().message;
}

}  // namespace

TEST_CASE("png: a numbered row is a stack, by number and not by name, from below, and y is up") {
    const TempFolder folder;
    put(folder / "slice8.png", grey8(80));
    put(folder / "slice9.png", grey8(90));
    put(folder / "slice10.png", grey8(100));
    put(folder / "other1.png", "not a part of it");
    const SampledVolume volume = read(folder / "slice9.png");
    CHECK(volume.kind == VolumeKind::Scalar);
    CHECK(glm::uvec3(volume.nx, volume.ny, volume.nz) == glm::uvec3(2, 2, 3));
    CHECK(volume.values == std::vector<float>{2, 3, 80, 1, 2, 3, 90, 1, 2, 3, 100, 1});
    CHECK(volume.to_mm == glm::dmat4(1.0));
}

TEST_CASE("png: a folder with one row, and a picture without a number, are stacks") {
    const TempFolder folder;
    put(folder / "a0.png", grey8(7));
    put(folder / "a1.png", grey8(8));
    put(folder / "notes.txt", "");
    CHECK(io::is_volume_path(folder.path()));
    CHECK(read(folder.path()).nz == 2);
    put(folder / "one.png", grey8(9));
    CHECK(read(folder / "one.png").nz == 1);
}

TEST_CASE("png: grey of 1, 2, 4, 8 and 16 bits") {
    const TempFolder folder;
    const auto values = [&](int bits, std::vector<std::uint8_t> bytes) {
        put(folder / "p.png", png(2, 1, bits, PNG_COLOR_TYPE_GRAY, std::move(bytes)));
        return read(folder / "p.png").values;
    };
    CHECK(values(1, {0x40}) == std::vector<float>{0, 1});
    CHECK(values(2, {0x70}) == std::vector<float>{85, 255});
    CHECK(values(4, {0x1f}) == std::vector<float>{17, 255});
    CHECK(values(8, {3, 200}) == std::vector<float>{3, 200});
    CHECK(values(16, {0x12, 0x34, 0xff, 0xff}) == std::vector<float>{0x1234, 65535});
    put(folder / "p.png", png(2, 1, 1, PNG_COLOR_TYPE_GRAY, {0x40}));
    CHECK(read(folder / "p.png").kind == VolumeKind::Binary);
}

TEST_CASE("png: colours, with and without opacity, of palettes and interlaced") {
    const TempFolder folder;
    const auto colors = [&](int type, int bits, std::vector<std::uint8_t> bytes) {
        put(folder / "p.png", png(1, 1, bits, type, std::move(bytes), true));
        const SampledVolume volume = read(folder / "p.png");
        REQUIRE(volume.kind == VolumeKind::Colors);
        return volume.colors[0];
    };
    CHECK(colors(PNG_COLOR_TYPE_RGB, 8, {1, 2, 3}) == Rgba{1, 2, 3, 255});
    CHECK(colors(PNG_COLOR_TYPE_RGBA, 8, {1, 2, 3, 4}) == Rgba{1, 2, 3, 4});
    CHECK(colors(PNG_COLOR_TYPE_GRAY_ALPHA, 8, {9, 4}) == Rgba{9, 9, 9, 4});
    CHECK(colors(PNG_COLOR_TYPE_RGB, 16, {1, 1, 2, 2, 3, 3}) == Rgba{1, 2, 3, 255});
    CHECK(colors(PNG_COLOR_TYPE_PALETTE, 1, {0x80}) == Rgba{4, 5, 6, 255});
}

TEST_CASE("png: one picture in colour makes all of them colours") {
    const TempFolder folder;
    put(folder / "a0.png", png(1, 1, 8, PNG_COLOR_TYPE_GRAY, {100}));
    put(folder / "a1.png", png(1, 1, 8, PNG_COLOR_TYPE_RGB, {1, 2, 3}));
    put(folder / "a2.png", png(1, 1, 16, PNG_COLOR_TYPE_GRAY, {0xff, 0xff}));
    CHECK(read(folder / "a0.png").colors ==
          std::vector<Rgba>{{100, 100, 100, 255}, {1, 2, 3, 255}, {255, 255, 255, 255}});
}

TEST_CASE("png: stacks that are not one are refused by name") {
    const TempFolder folder;
    CHECK_THAT(refused(folder.path()), contains("holds no pictures"));
    put(folder / "a0.png", grey8(1));
    put(folder / "a2.png", grey8(1));
    CHECK_THAT(refused(folder / "a0.png"), contains("number 1 is missing"));
    put(folder / "a1.png", png(2, 3, 8, PNG_COLOR_TYPE_GRAY, {1, 2, 3, 4, 5, 6}));
    CHECK_THAT(refused(folder / "a0.png"), contains("a1.png: the picture has 2 × 3 pixels") && contains("2 × 2"));
    put(folder / "a1.png", png(2, 2, 16, PNG_COLOR_TYPE_GRAY, {1, 2, 3, 4, 5, 6, 7, 8}));
    CHECK_THAT(refused(folder / "a0.png"), contains("16 bits a pixel") && contains("8"));
    put(folder / "a01.png", grey8(1));
    CHECK_THAT(refused(folder / "a0.png"), contains("the same number"));
    put(folder / "b1.png", grey8(1));
    CHECK_THAT(refused(folder.path()), contains("named a…") && contains("b…"));
    CHECK_THAT(refused(folder / "none7.png"), contains("No such file"));
    put(folder / "c1234567890.png", grey8(1));
    CHECK_THAT(refused(folder / "c1234567890.png"), contains("more than 9 digits"));
}

TEST_CASE("png: pictures cut short, damaged or of absurd size are refused") {
    const std::string file = png(20, 9, 8, PNG_COLOR_TYPE_GRAY, std::vector<std::uint8_t>(180, 7));
    for (std::size_t length = 0; length < file.size(); ++length) {
        const std::string cut = file.substr(0, length);
        const auto picture = io::parse_png(cut, "file");
        REQUIRE_FALSE(picture);
        REQUIRE_THAT(picture.error().message, contains("file: the picture cannot be read: "));
    }
    CHECK_FALSE(io::parse_png(png(16385, 1, 1, PNG_COLOR_TYPE_GRAY, std::vector<std::uint8_t>(2049)), "file"));
    std::string damaged = file;
    damaged[file.size() / 2] = static_cast<char>(damaged[file.size() / 2] ^ 1);
    CHECK_FALSE(io::parse_png(damaged, "file"));
}
