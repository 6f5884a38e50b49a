#include "voxelizer/io/png_picture.h"

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <png.h>

#include "voxelizer/io/inflate.h"
#include "voxelizer/io/load.h"
#include "voxelizer/io/memory.h"
#include "voxelizer/sampled_volume.h"

// libpng answers errors by longjmp: functions that call setjmp here make no object with a destructor.

namespace xorvox::io {
namespace {

constexpr std::size_t kMessageBytes = 128;

void keep_message(png_structp png, png_const_charp message) {
    auto* const kept = static_cast<char*>(png_get_error_ptr(png));
    std::strncpy(kept, message, kMessageBytes - 1);
    png_longjmp(png, 1);
}

void no_warning(png_structp, png_const_charp) {}

struct Source {
    const char* next;
    std::size_t left;
};

void give_bytes(png_structp png, png_bytep to, std::size_t size) {
    auto* const source = static_cast<Source*>(png_get_io_ptr(png));
    if (size > source->left) png_error(png, "the file is cut short");
    std::memcpy(to, source->next, size);
    source->next += size;
    source->left -= size;
}

class Decoder {
public:
    explicit Decoder(std::string_view bytes) : source_{bytes.data(), bytes.size()} {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, message_, keep_message, no_warning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ != nullptr) png_set_read_fn(png_, &source_, give_bytes);
    }
    ~Decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    /// As a picture in sRGB with opacity, or with the file's own numbers where these are grey.
    enum class Pixels : std::uint8_t { Colors, Numbers };

    bool begin(Pixels pixels) {
        if (info_ == nullptr) {
            std::strncpy(message_, "not enough memory", kMessageBytes - 1);
            return false;
        }
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_info(png_, info_);
        const int type = png_get_color_type(png_, info_);
        const bool transparent = png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
        grey_ = pixels == Pixels::Numbers && type == PNG_COLOR_TYPE_GRAY && !transparent;
        bits_ = png_get_bit_depth(png_, info_);
        if (grey_) {
            if (bits_ == 1) png_set_packing(png_);
            if (bits_ == 2 || bits_ == 4) png_set_expand_gray_1_2_4_to_8(png_);
        } else {
            png_set_expand(png_);
            png_set_scale_16(png_);
            if ((type & PNG_COLOR_MASK_COLOR) == 0) png_set_gray_to_rgb(png_);
            png_set_filler(png_, 0xff, PNG_FILLER_AFTER);
            bits_ = 8;
        }
        if (pixels == Pixels::Colors) png_set_alpha_mode(png_, PNG_ALPHA_PNG, PNG_DEFAULT_sRGB);
        passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }

    bool read_rows(std::uint8_t* rows) {
        if (setjmp(png_jmpbuf(png_))) return false;
        const std::size_t stride = row_bytes();
        for (int pass = 0; pass < passes_; ++pass) {
            for (png_uint_32 y = 0; y < height(); ++y) png_read_row(png_, rows + y * stride, nullptr);
        }
        png_read_end(png_, nullptr);
        return true;
    }

    png_uint_32 width() const { return png_get_image_width(png_, info_); }
    png_uint_32 height() const { return png_get_image_height(png_, info_); }
    std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    bool grey() const { return grey_; }
    unsigned bits() const { return bits_; }
    const char* message() const { return message_; }

private:
    Source source_;
    char message_[kMessageBytes] = {};
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    bool grey_ = true;
    unsigned bits_ = 8;
    int passes_ = 1;
};

tl::unexpected<Error> unreadable(std::string_view source, std::string_view what) {
    return fail(fmt::format("{}: the picture cannot be read: {}; save it again", source, what));
}

// Before libpng sees them: sizes that are no picture's, and those that the bytes cannot become.
Expected<void> check_header(std::string_view bytes, std::string_view source, const CheckImageSize& check) {
    constexpr std::size_t kHeader = 8 + 4 + 4 + 13;  // signature, then IHDR's length, name and content
    if (bytes.size() < kHeader || bytes.substr(12, 4) != "IHDR") return unreadable(source, "it has no whole header");
    const ImageSize size{load<std::uint32_t>(bytes.data() + 16, std::endian::big),
                         load<std::uint32_t>(bytes.data() + 20, std::endian::big)};
    if (size.width == 0 || size.height == 0) {
        return fail(fmt::format("{}: {} × {} pixels are no picture; save it again", source, size.width, size.height));
    }
    if (auto ok = check(size); !ok) return ok;
    // A row of a picture of one bit a pixel, with the byte that says how it is filtered.
    if (can_inflate_to(bytes, std::size_t{size.height} * (1 + (std::size_t{size.width} + 7) / 8))) return {};
    return fail(fmt::format("{}: {} bytes cannot hold {} × {} pixels; save the picture again", source, bytes.size(),
                            size.width, size.height));
}

void append_bytes(png_structp png, png_bytep from, std::size_t size) {
    auto* const to = static_cast<std::string*>(png_get_io_ptr(png));
    to->append(reinterpret_cast<const char*>(from), size);
}

void flush_nothing(png_structp) {}

bool write_bits(png_structp png, png_infop info, std::uint32_t width, std::uint32_t height, std::uint8_t* rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_IHDR(png, info, width, height, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    const std::size_t stride = (std::size_t{width} + 7) / 8;
    for (std::uint32_t y = 0; y < height; ++y) png_write_row(png, rows + y * stride);
    png_write_end(png, info);
    return true;
}

}  // namespace

Expected<PngPicture> parse_png(std::string_view bytes, std::string_view source) {
    const auto size_fits = [source](ImageSize size) -> Expected<void> {
        constexpr std::uint32_t kMostSide = SampledVolume::kMostSide;
        if (size.width <= kMostSide && size.height <= kMostSide) return {};
        return fail(fmt::format("{}: the picture has {} × {} pixels; sides are at most {}", source, size.width,
                                size.height, kMostSide));
    };
    if (auto ok = check_header(bytes, source, size_fits); !ok) return tl::unexpected(std::move(ok.error()));
    Decoder decoder(bytes);
    if (!decoder.begin(Decoder::Pixels::Numbers)) return unreadable(source, decoder.message());
    PngPicture picture;
    picture.width = decoder.width();
    picture.height = decoder.height();
    picture.bits = decoder.bits();
    picture.channels = decoder.grey() ? 1 : 4;
    const std::size_t row_bytes = decoder.row_bytes();
    if (auto ok = check_memory(row_bytes * picture.height, source); !ok) return tl::unexpected(std::move(ok.error()));
    picture.bytes.resize(row_bytes * picture.height);
    if (!decoder.read_rows(picture.bytes.data())) return unreadable(source, decoder.message());
    return picture;
}

Expected<Image> decode_png(std::string_view bytes, std::string_view source, const CheckImageSize& check) {
    if (auto ok = check_header(bytes, source, check); !ok) return tl::unexpected(std::move(ok.error()));
    Decoder decoder(bytes);
    if (!decoder.begin(Decoder::Pixels::Colors)) return unreadable(source, decoder.message());
    Image image{decoder.width(), decoder.height(), {}};
    image.pixels.resize(std::size_t{image.width} * image.height);
    if (!decoder.read_rows(image.pixels.data()->data())) return unreadable(source, decoder.message());
    return image;
}

Expected<std::string> encode_png_bits(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t>& rows) {
    std::string bytes;
    char message[kMessageBytes] = {};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, message, keep_message, no_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    bool ok = info != nullptr;
    if (ok) {
        png_set_write_fn(png, &bytes, append_bytes, flush_nothing);
        ok = write_bits(png, info, width, height, rows.data());
    }
    png_destroy_write_struct(&png, &info);
    if (!ok) return fail(fmt::format("a picture of {} × {} cannot be written: {}", width, height, message));
    return bytes;
}

}  // namespace xorvox::io
