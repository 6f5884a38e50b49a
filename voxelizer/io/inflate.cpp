#include "voxelizer/io/inflate.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <zlib.h>

namespace xorvox::io {
namespace {

constexpr int kGzip = 16 + MAX_WBITS;
constexpr std::size_t kMostRatio = 1032;

/// A z_stream that ends with its scope.
class Inflater {
public:
    Inflater() : ready_(::inflateInit2(&stream_, kGzip) == Z_OK) {}
    ~Inflater() {
        if (ready_) ::inflateEnd(&stream_);
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    bool ready() const { return ready_; }
    z_stream& stream() { return stream_; }

private:
    z_stream stream_{};
    bool ready_;
};

struct Inflated {
    std::string bytes;
    bool ended = false;  // By the end of the gzip member, checksum and all.
};

Expected<Inflated> run(std::string_view packed, std::size_t most, std::string_view source, std::size_t first_byte) {
    constexpr std::size_t kMostIn = std::size_t{1} << 30;  // zlib counts in 32 bits.
    constexpr std::size_t kMostOut = std::size_t{1} << 16;
    Inflater inflater;
    if (!inflater.ready()) return fail(fmt::format("{}: not enough memory to unpack it", source));
    z_stream& stream = inflater.stream();
    Inflated result;
    result.bytes.reserve(std::min(most + 1, kMostRatio * packed.size()));
    std::string buffer(kMostOut, '\0');  // Of its own: a pass may give nothing, as that of an empty member.
    std::size_t read = 0;
    for (;;) {
        // One beyond the most tells whether there are more.
        const std::size_t room = std::min(most + 1 - result.bytes.size(), kMostOut);
        const std::size_t piece = std::min(packed.size() - read, kMostIn);
        // zlib does not write through next_in.
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + read));
        stream.avail_in = static_cast<uInt>(piece);
        stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
        stream.avail_out = static_cast<uInt>(room);
        const int answer = ::inflate(&stream, Z_NO_FLUSH);
        read += piece - stream.avail_in;
        result.bytes.append(buffer, 0, room - stream.avail_out);
        if (answer == Z_STREAM_END) {
            // Files of several members, as parallel packers write them, are their bytes one after the other.
            if (packed.substr(read).starts_with("\x1f\x8b") && result.bytes.size() <= most) {
                if (::inflateReset(&stream) == Z_OK) continue;
            }
            result.ended = true;
            return result;
        }
        if (answer == Z_MEM_ERROR) return fail(fmt::format("{}: not enough memory to unpack it", source));
        if (answer != Z_OK && answer != Z_BUF_ERROR) {
            return fail(fmt::format("{}: byte {}: the gzip data are damaged ({}); copy the file again", source,
                                    first_byte + read, stream.msg != nullptr ? stream.msg : "no reason given"));
        }
        if (result.bytes.size() > most) return result;
        if (read == packed.size() && stream.avail_out != 0) {
            return fail(fmt::format("{}: byte {}: the gzip data are cut short; copy the file again", source,
                                    first_byte + packed.size()));
        }
    }
}

}  // namespace

bool can_inflate_to(std::string_view packed, std::size_t bytes) {
    return bytes / kMostRatio <= packed.size();
}

Expected<std::string> inflate_gzip(std::string_view packed, std::size_t most, std::string_view source,
                                   std::size_t first_byte) {
    auto result = run(packed, most, source, first_byte);
    if (!result) return tl::unexpected(std::move(result.error()));
    result->bytes.resize(std::min(result->bytes.size(), most));
    return std::move(result->bytes);
}

Expected<std::string> inflate_gzip_exactly(std::string_view packed, std::size_t bytes, std::string_view source,
                                           std::size_t first_byte) {
    if (!can_inflate_to(packed, bytes)) {
        return fail(fmt::format("{}: byte {}: {} bytes of gzip data cannot hold the {} bytes that the header announces",
                                source, first_byte, packed.size(), bytes));
    }
    auto result = run(packed, bytes, source, first_byte);
    if (!result) return tl::unexpected(std::move(result.error()));
    if (result->bytes.size() != bytes || !result->ended) {
        return fail(fmt::format("{}: byte {}: the gzip data hold {} bytes and the header announces {}", source,
                                first_byte,
                                result->bytes.size() > bytes ? "more" : std::to_string(result->bytes.size()), bytes));
    }
    return std::move(result->bytes);
}

}  // namespace xorvox::io
