#include "driver/wire/messages.h"

#include <concepts>
#include <cstring>
#include <type_traits>

namespace xorvox::wire {
namespace {

template <class Type, class Message>
concept Is = std::same_as<std::remove_const_t<Type>, Message>;

// The fields of each message, once, for both directions: `visit` is a Writer, a Reader or a Counter.
void fields(Is<HelloRequest> auto& m, auto& visit) {
    visit(m.major, m.minor, m.host_time_ns);
}
void fields(Is<Hello> auto& m, auto& visit) {
    visit(m.major, m.minor, m.features, m.boot_nonce, m.serial, m.display, m.geometry_digest, m.format, m.planes,
          m.frame_bytes, m.pages, m.max_packet_bytes, m.codecs, m.fault, m.free_pages, m.device_time_ns,
          m.host_time_ns);
}
void fields(Is<FrameBegin> auto& m, auto& visit) {
    visit(m.frame, m.flags, m.base, m.frame_bytes, m.present_at_ns);
}
void fields(Is<Chunk> auto& m, auto& visit) {
    visit(m.frame, m.offset, m.decoded_length, m.codec, m.data);
}
void fields(Is<FrameEnd> auto& m, auto& visit) {
    visit(m.frame, m.page_crc);
}
void fields(Is<Control> auto& m, auto& visit) {
    visit(m.operation, m.value);
}
void fields(Is<Ping> auto& m, auto& visit) {
    visit(m.host_time_ns);
}
void fields(Is<Pong> auto& m, auto& visit) {
    visit(m.host_time_ns, m.device_time_ns);
}
void fields(Is<Acknowledge> auto& m, auto& visit) {
    visit(m.stage, m.frame, m.page_crc, m.free_pages, m.device_time_ns);
}
void fields(Is<Nack> auto& m, auto& visit) {
    visit(m.reason, m.frame, m.free_pages, m.device_time_ns);
}
void fields(Is<DeviceStatus> auto& m, auto& visit) {
    visit(m.brightness, m.blank, m.silence_action, m.watchdog_ms, m.fault, m.shown_frame, m.has_frame, m.shown_crc,
          m.free_pages, m.frames_accepted, m.frames_dropped, m.packets_bad, m.device_time_ns, m.faults);
}

template <class T>
concept Number = std::integral<T> || std::is_enum_v<T>;

class Counter {
public:
    std::size_t bytes = 0;
    void operator()(const auto&... values) { (count(values), ...); }

private:
    void count(const Number auto& value) { bytes += sizeof value; }
    void count(const DisplayName& name) { bytes += name.text.size(); }
    void count(std::span<const std::byte> rest) { bytes += rest.size(); }
};

class Writer {
public:
    explicit Writer(std::byte* at) : at_(at) {}
    void operator()(const auto&... values) { (put(values), ...); }

private:
    void put(const Number auto& value) {
        auto bits = static_cast<std::uint64_t>(value);
        for (std::size_t i = 0; i < sizeof value; ++i, bits >>= 8) *at_++ = static_cast<std::byte>(bits & 0xff);
    }
    void put(const DisplayName& name) {
        for (const char c : name.text) *at_++ = static_cast<std::byte>(c);
    }
    void put(std::span<const std::byte> rest) {
        if (!rest.empty() && rest.data() != at_) std::memmove(at_, rest.data(), rest.size());
        at_ += rest.size();
    }

    std::byte* at_;
};

class Reader {
public:
    explicit Reader(std::span<const std::byte> payload) : rest_(payload) {}
    bool whole() const { return whole_; }
    void operator()(auto&... values) { (get(values), ...); }

private:
    template <Number T>
    void get(T& value) {
        std::uint64_t bits = 0;
        if (!enough(sizeof value)) return;
        for (std::size_t i = 0; i < sizeof value; ++i) bits |= std::to_integer<std::uint64_t>(rest_[i]) << (8 * i);
        rest_ = rest_.subspan(sizeof value);
        value = static_cast<T>(bits);
    }
    void get(DisplayName& name) {
        if (!enough(name.text.size())) return;
        for (std::size_t i = 0; i < name.text.size(); ++i) name.text[i] = static_cast<char>(rest_[i]);
        rest_ = rest_.subspan(name.text.size());
    }
    void get(std::span<const std::byte>& data) {
        data = rest_;
        rest_ = {};
    }
    bool enough(std::size_t bytes) {
        whole_ = whole_ && rest_.size() >= bytes;
        return whole_;
    }

    std::span<const std::byte> rest_;
    bool whole_ = true;
};

// What cannot be, whatever the minor version. Numbers of enumerations are let through: a later minor version may have
// more of them, and only the receiver knows what to answer.
bool can_be(const DisplayName& name) {
    std::size_t end = name.view().size();
    if (end == name.text.size()) return false;
    while (end < name.text.size() && name.text[end] == '\0') ++end;
    return end == name.text.size();
}
bool can_be(const Hello& hello) {
    return can_be(hello.serial) && can_be(hello.display) && hello.planes > 0 && hello.frame_bytes > 0 &&
           hello.pages >= 2 && hello.free_pages <= hello.pages && hello.max_packet_bytes >= kMinPacketBytes &&
           hello.max_packet_bytes <= kMaxPacketBytes && (hello.codecs & 1u << static_cast<unsigned>(Codec::Raw)) != 0;
}
bool can_be(const Chunk& chunk) {
    return chunk.decoded_length > 0 && (chunk.codec != Codec::Raw || chunk.data.size() == chunk.decoded_length);
}
bool can_be(const auto&) {
    return true;
}

template <class Message>
Status encode_message(const Message& message, std::span<std::byte> out, std::size_t& size) {
    Counter counter;
    fields(message, counter);
    if (out.size() < counter.bytes) return Status::OutOfMemory;
    Writer writer(out.data());
    fields(message, writer);
    size = counter.bytes;
    return Status::Ok;
}

template <class Message>
Status decode_message(std::span<const std::byte> payload, Message& message) {
    Message read;
    Reader reader(payload);
    fields(read, reader);
    if (!reader.whole() || !can_be(read)) return Status::Corrupt;
    message = read;
    return Status::Ok;
}

}  // namespace

#define XORVOX_WIRE_MESSAGE(Message)                                                     \
    Status encode(const Message& message, std::span<std::byte> out, std::size_t& size) { \
        return encode_message(message, out, size);                                       \
    }                                                                                    \
    Status decode(std::span<const std::byte> payload, Message& message) {                \
        return decode_message(payload, message);                                         \
    }

XORVOX_WIRE_MESSAGE(HelloRequest)
XORVOX_WIRE_MESSAGE(Hello)
XORVOX_WIRE_MESSAGE(FrameBegin)
XORVOX_WIRE_MESSAGE(Chunk)
XORVOX_WIRE_MESSAGE(FrameEnd)
XORVOX_WIRE_MESSAGE(Control)
XORVOX_WIRE_MESSAGE(Ping)
XORVOX_WIRE_MESSAGE(Pong)
XORVOX_WIRE_MESSAGE(Acknowledge)
XORVOX_WIRE_MESSAGE(Nack)
XORVOX_WIRE_MESSAGE(DeviceStatus)

#undef XORVOX_WIRE_MESSAGE

}  // namespace xorvox::wire
