#include "transport/framing.h"

#include <cstring>

namespace xorvox::transport {
namespace {

std::uint16_t crc16(std::span<const std::byte> bytes) {
    std::uint32_t crc = 0xffff;
    for (const std::byte byte : bytes) {
        crc ^= std::to_integer<std::uint32_t>(byte) << 8;
        for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x8000) != 0 ? 0x1021u : 0u);
        crc &= 0xffff;
    }
    return static_cast<std::uint16_t>(crc);
}

void put16(std::byte* out, std::size_t value) {
    out[0] = static_cast<std::byte>(value & 0xff);
    out[1] = static_cast<std::byte>(value >> 8 & 0xff);
}

std::size_t get16(const std::byte* in) {
    return std::to_integer<std::size_t>(in[0]) | std::to_integer<std::size_t>(in[1]) << 8;
}

}  // namespace

Status encode_frame_header(std::size_t packet_bytes, std::span<std::byte, kFrameHeaderBytes> out) {
    if (packet_bytes == 0 || packet_bytes > kMaxFramedBytes) return Status::OutOfRange;
    out[0] = kFrameMagic0;
    out[1] = kFrameMagic1;
    put16(&out[2], packet_bytes - 1);
    put16(&out[4], crc16(out.first<4>()));
    return Status::Ok;
}

Status encode_frame(std::span<const std::byte> packet, std::span<std::byte> out, std::size_t& size) {
    if (packet.empty() || packet.size() > kMaxFramedBytes) return Status::OutOfRange;
    if (out.size() < packet.size() + kFrameHeaderBytes) return Status::OutOfMemory;
    const Status status = encode_frame_header(packet.size(), out.first<kFrameHeaderBytes>());
    if (status != Status::Ok) return status;
    std::memcpy(out.data() + kFrameHeaderBytes, packet.data(), packet.size());
    size = packet.size() + kFrameHeaderBytes;
    return Status::Ok;
}

void FrameDecoder::reset() {
    header_filled_ = 0;
    packet_filled_ = 0;
    whole_ = false;
    in_step_ = true;
}

std::size_t FrameDecoder::announced_bytes() const {
    return get16(&header_[2]) + 1;
}

/// Whether a frame may begin with the bytes of the header that are here.
bool FrameDecoder::plausible() const {
    if (header_filled_ >= 1 && header_[0] != kFrameMagic0) return false;
    if (header_filled_ >= 2 && header_[1] != kFrameMagic1) return false;
    if (header_filled_ < kFrameHeaderBytes) return true;
    return get16(&header_[4]) == crc16(std::span(header_).first<4>()) && announced_bytes() <= buffer_.size();
}

Status FrameDecoder::feed(std::span<const std::byte> input, std::size_t& consumed) {
    if (whole_) {
        whole_ = false;
        header_filled_ = 0;
        packet_filled_ = 0;
    }
    consumed = 0;
    while (consumed < input.size()) {
        if (header_filled_ < kFrameHeaderBytes) {
            header_[header_filled_++] = input[consumed++];
            if (plausible()) {
                if (header_filled_ == kFrameHeaderBytes) in_step_ = true;
                continue;
            }
            // The frame may begin at any later byte of what was taken for its header.
            do {
                --header_filled_;
                std::memmove(header_.data(), header_.data() + 1, header_filled_);
            } while (!plausible());
            const bool was_in_step = in_step_;
            in_step_ = false;
            if (was_in_step) return Status::Corrupt;
            continue;
        }
        const std::size_t missing = announced_bytes() - packet_filled_;
        const std::size_t here = input.size() - consumed;
        const std::size_t count = missing < here ? missing : here;
        std::memcpy(buffer_.data() + packet_filled_, input.data() + consumed, count);
        packet_filled_ += count;
        consumed += count;
        if (count == missing) {
            whole_ = true;
            return Status::Ok;
        }
    }
    return Status::WouldBlock;
}

}  // namespace xorvox::transport
