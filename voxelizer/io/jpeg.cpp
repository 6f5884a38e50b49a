#include "voxelizer/io/jpeg.h"

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <jpeglib.h>

#include <jerror.h>  // after jpeglib.h, which it needs

namespace xorvox::io {
namespace {

/// Files in which the whole picture is told again and again cost time without end.
constexpr int kMostScans = 256;

/// libjpeg leaves its functions by longjmp when it fails: only C's variables may live in their callers.
class Decoder {
public:
    explicit Decoder(std::string_view bytes) : bytes_(bytes) {
        info_.err = jpeg_std_error(&errors_);
        info_.client_data = this;
        errors_.error_exit = [](j_common_ptr info) { give_up(info); };
        errors_.emit_message = [](j_common_ptr info, int level) {
            // Bytes between two segments do no harm; other warnings are about what is missing or was made up.
            if (level < 0 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) give_up(info);
        };
        progress_.progress_monitor = [](j_common_ptr info) {
            if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMostScans) return;
            auto& decoder = *static_cast<Decoder*>(info->client_data);
            decoder.too_many_scans_ = true;
            std::longjmp(decoder.failure_, 1);
        };
    }
    ~Decoder() { jpeg_destroy_decompress(&info_); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    bool read_header() {
        if (setjmp(failure_) != 0) return false;
        jpeg_create_decompress(&info_);
        info_.progress = &progress_;
        jpeg_mem_src(&info_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
        jpeg_read_header(&info_, TRUE);
        info_.out_color_space = JCS_EXT_RGBA;
        return true;
    }
    /// `pixels` has the header's size.
    bool read_pixels(std::array<std::uint8_t, 4>* pixels) {
        if (setjmp(failure_) != 0) return false;
        jpeg_start_decompress(&info_);
        while (info_.output_scanline < info_.output_height) {
            JSAMPROW row = pixels[std::size_t{info_.output_scanline} * info_.output_width].data();
            jpeg_read_scanlines(&info_, &row, 1);
        }
        jpeg_finish_decompress(&info_);
        return true;
    }

    ImageSize size() const { return {info_.image_width, info_.image_height}; }
    bool is_cmyk() const { return info_.jpeg_color_space == JCS_CMYK || info_.jpeg_color_space == JCS_YCCK; }
    std::string message() const {
        return too_many_scans_ ? fmt::format("it has more than {} scans", kMostScans) : message_.data();
    }

private:
    [[noreturn]] static void give_up(j_common_ptr info) {
        auto* const decoder = static_cast<Decoder*>(info->client_data);
        info->err->format_message(info, decoder->message_.data());
        std::longjmp(decoder->failure_, 1);
    }

    std::string_view bytes_;
    jpeg_decompress_struct info_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    std::jmp_buf failure_{};
    std::array<char, JMSG_LENGTH_MAX> message_{};
    bool too_many_scans_ = false;
};

}  // namespace

Expected<Image> decode_jpeg(std::string_view bytes, std::string_view source, const CheckImageSize& check) {
    Decoder decoder(bytes);
    const auto failed = [&] {
        return fail(
            fmt::format("{}: the JPEG cannot be decoded: {}; save the picture again", source, decoder.message()));
    };
    if (!decoder.read_header()) return failed();
    if (const auto ok = check(decoder.size()); !ok) return tl::unexpected(ok.error());
    if (decoder.is_cmyk()) return fail(fmt::format("{}: the JPEG is in CMYK; save the picture as RGB", source));
    Image image{decoder.size().width, decoder.size().height, {}};
    image.pixels.resize(std::size_t{image.width} * image.height);
    if (!decoder.read_pixels(image.pixels.data())) return failed();
    return image;
}

}  // namespace xorvox::io
