#include "voxelizer/io/image_file.h"

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "tests/unit/io/contains.h"
#include "tests/unit/io/encode_image.h"
#include "tests/unit/io/temp_folder.h"

using namespace xorvox;

namespace {

std::string refusal(std::string_view bytes) {
    const auto image = io::decode_image(bytes, "file");
    return image ? std::string() : image.error().message;
}

/// A picture that is whole, or one line.
bool is_image_or_message(std::string_view bytes) {
    const auto image = io::decode_image(bytes, "file");
    if (image) return image->pixels.size() == std::size_t{image->width} * image->height && image->width > 0;
    const std::string& message = image.error().message;
    return message.starts_with("file: ") && message.find('\n') == message.npos;
}

void set_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

}  // namespace

TEST_CASE("a PNG is read as it was written") {
    Image written = test_picture(37, 23);
    written.pixels[5] = {10, 20, 30, 0};
    written.pixels[6] = {40, 50, 60, 128};
    const auto read = io::decode_image(encode_png(written), "file").value();
    CHECK(read.width == 37);
    CHECK(read.height == 23);
    CHECK(read.pixels == written.pixels);
}

TEST_CASE("a PNG of 16 bits that states no gamma is sRGB") {
    std::string file = encode_png_of_16_bits(101, 1);
    constexpr std::size_t kChunk = 4 + 4 + 4 + 4;  // length, name, content, checksum
    REQUIRE(file.find("gAMA") != file.npos);
    file.erase(file.find("gAMA") - 4, kChunk);
    const auto read = io::decode_image(file, "file").value();
    for (std::size_t i = 0; i <= 100; ++i) {
        INFO(i);
        CHECK(std::abs(255.0 * static_cast<double>(i) / 100.0 - read.pixels[i][0]) <= 1.0);
        CHECK(read.pixels[i][0] == read.pixels[i][2]);
        CHECK(read.pixels[i][3] == 255);
    }
}

TEST_CASE("a PNG that states a gamma becomes sRGB") {
    const auto read = io::decode_image(encode_png_of_16_bits(101, 1), "file").value();  // Linear: its gamma is 1.
    for (std::size_t i = 0; i <= 100; ++i) {
        INFO(i);
        CHECK(std::abs(255.0 * std::pow(static_cast<double>(i) / 100.0, 1.0 / 2.2) - read.pixels[i][0]) <= 2.0);
    }
}

TEST_CASE("a JPEG is read as it was written, but for its losses") {
    const Image written = test_picture(64, 40);
    for (const bool progressive : {false, true}) {
        const auto read = io::decode_image(encode_jpeg(written, progressive), "file").value();
        REQUIRE(read.width == 64);
        REQUIRE(read.height == 40);
        for (std::size_t i = 0; i < written.pixels.size(); ++i) {
            for (std::size_t c = 0; c < 3; ++c) REQUIRE(std::abs(read.pixels[i][c] - written.pixels[i][c]) <= 12);
            REQUIRE(read.pixels[i][3] == 255);
        }
    }
}

TEST_CASE("a JPEG that tells the same picture for ever is refused") {
    std::string jpeg = encode_jpeg(test_picture(16, 16), true);
    const std::size_t scan = jpeg.rfind("\xff\xda");
    const std::string last = jpeg.substr(scan, jpeg.size() - 2 - scan);
    REQUIRE(refusal(jpeg).empty());
    for (int i = 0; i < 1000; ++i) jpeg.insert(scan, last);
    CHECK_FALSE(refusal(jpeg).empty());
}

TEST_CASE("image files are known by their content, and paths by their name") {
    const TempFolder folder;
    const std::string path = folder / "picture.dat";
    put(path, encode_png(test_picture(3, 2)));
    CHECK(io::read_image(path).value().height == 2);
    for (const char* name : {"a.png", "b/c.JPG", "d.e.jpeg"}) CHECK(io::is_image_path(name));
    for (const char* name : {"png", "a.gif", "a.png/b", "red,blue", ""}) CHECK_FALSE(io::is_image_path(name));
    CHECK_THAT(io::read_image(folder / "none.png").error().message, contains("none.png: cannot be read: No such file"));
    CHECK_THAT(io::read_image(folder.path()).error().message, contains("is a directory; name an image file in it"));
    CHECK_THAT(refusal("GIF89a"), contains("file: byte 0: neither a PNG nor a JPEG"));
    CHECK_THAT(refusal(""), contains("neither a PNG nor a JPEG"));
}

TEST_CASE("images of absurd size are refused before memory is taken") {
    std::string png = encode_png(test_picture(3, 2));
    set_big_endian(png, 16, 16385);
    CHECK_THAT(refusal(png), contains("file: 16385 × 2 pixels are too many; at most 16384 a side"));
    set_big_endian(png, 16, 0);
    CHECK_THAT(refusal(png), contains("are no picture"));
    set_big_endian(png, 16, 0xffff'ffff);
    CHECK_THAT(refusal(png), contains("too many"));
    set_big_endian(png, 16, 16384);
    set_big_endian(png, 20, 16384);
    CHECK_THAT(refusal(png), contains("67108864 in all"));
    set_big_endian(png, 20, 4096);
    CHECK_THAT(refusal(png), contains("bytes cannot hold 16384 × 4096 pixels"));

    std::string jpeg = encode_jpeg(test_picture(8, 8));
    const std::size_t frame = jpeg.find("\xff\xc0");
    REQUIRE(frame != jpeg.npos);
    jpeg.replace(frame + 5, 4, "\xff\x01\xff\x01");
    CHECK_THAT(refusal(jpeg), contains("65281 × 65281 pixels are too many"));
    jpeg.replace(frame + 5, 4, std::string("\x20\x00\x20\x00", 4));
    CHECK_THAT(refusal(jpeg), contains("bytes cannot hold 8192 × 8192 pixels"));
}

TEST_CASE("image files cut short or changed are refused or read, and never crash") {
    for (const std::string& file : {encode_png(test_picture(20, 9)), encode_jpeg(test_picture(20, 9))}) {
        for (std::size_t length = 0; length < file.size(); ++length) {
            INFO("cut at " << length);
            const std::string cut = file.substr(0, length);
            REQUIRE(is_image_or_message(cut));
            // A PNG has its end, which holds nothing, behind the picture.
            if (length + 12 < file.size()) REQUIRE_FALSE(refusal(cut).empty());
        }
        std::mt19937 random(5);
        for (int round = 0; round < 2000; ++round) {
            std::string mutant = file;
            for (int i = 0; i < 3; ++i) mutant[random() % mutant.size()] = static_cast<char>(random());
            REQUIRE(is_image_or_message(mutant));
        }
    }
}
