// The input plays the host, the display and the link of a device: packets with right CRCs, some in the right order and
// some of any content, the clock, boundaries, a link that takes no answers. However it goes, what is shown has the CRC
// that a frame's end gave, does not change but at a boundary, and nothing is written beside the pages.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <deque>
#include <vector>

#include "driver/device/device.h"

using namespace xorvox;
using namespace xorvox::wire;

namespace {

void check(bool holds) {
    if (!holds) std::abort();
}

constexpr DisplayDescription kDisplay = [] {
    DisplayDescription display;
    display.slices = 4;
    display.cycles_per_second = 60.0;
    display.panels[0] = {.columns = 8, .rows = 5};
    return display;
}();
constexpr std::size_t kPageBytes = frame_bytes(kDisplay);
constexpr std::size_t kGuard = 16;
constexpr std::byte kMark{0xA5};

class Input {
public:
    Input(const std::uint8_t* data, std::size_t size) : left_(data, size) {}
    bool empty() const { return left_.empty(); }
    std::uint8_t byte() {
        if (left_.empty()) return 0;
        const std::uint8_t value = left_.front();
        left_ = left_.subspan(1);
        return value;
    }
    std::span<const std::byte> bytes(std::size_t count) {
        const auto taken = left_.first(std::min(count, left_.size()));
        left_ = left_.subspan(taken.size());
        return std::as_bytes(taken);
    }

private:
    std::span<const std::uint8_t> left_;
};

class World {
public:
    explicit World(std::uint32_t pages) : memory_(pages * kPageBytes + 2 * kGuard, kMark) {
        page_count_ = pages;
        check(
            device_.init(
                {.display = &kDisplay, .link = link(), .pages = pages_memory(), .page_count = pages, .packet = buffer_},
                now_ns_) == Status::Ok);
    }

    void step(Input& input) {
        switch (input.byte() % 9) {
            case 0: now_ns_ += std::uint64_t{input.byte()} * 50'000'000; break;
            case 1:
                device_.boundary(now_ns_);
                frozen_.assign(device_.shown().page.begin(), device_.shown().page.end());
                break;
            case 2: {
                const Header header{.type = static_cast<PacketType>(input.byte()),
                                    .flags = input.byte(),
                                    .session = input.byte(),
                                    .sequence = sequence_ += input.byte() % 3};
                put(header, input.bytes(input.byte() % 64));
                break;
            }
            case 3:
                session_ = static_cast<std::uint16_t>(input.byte() % 3);
                send(HelloRequest{.major = static_cast<std::uint8_t>(input.byte() % 8 == 7 ? 2 : 1),
                                  .host_time_ns = now_ns_});
                break;
            case 4: {
                const std::uint8_t choice = input.byte();
                ++frame_;
                covered_ = 0;
                send(FrameBegin{.frame = frame_,
                                .flags = static_cast<std::uint8_t>(choice & 1u),
                                .base = (choice & 2u) != 0 ? frame_ - 1 : accepted_frame_,
                                .frame_bytes = kPageBytes,
                                .present_at_ns = (choice & 4u) != 0 ? now_ns_ + std::uint64_t{choice} * 1'000'000 : 0});
                break;
            }
            case 5: {
                const std::uint8_t length = input.byte();
                const auto codec = static_cast<Codec>(input.byte() % 3);
                const auto data = input.bytes(codec == Codec::Raw ? length : input.byte());
                send(Chunk{.frame = frame_,
                           .offset = covered_,
                           .decoded_length = codec == Codec::Raw ? static_cast<std::uint32_t>(data.size()) : length,
                           .codec = codec,
                           .data = data});
                covered_ += length;
                break;
            }
            case 6: {
                // The CRC that the fuzzer cannot guess: that of one of the pages as it is.
                device_work();
                const auto page = pages_memory().subspan(input.byte() % page_count_ * kPageBytes, kPageBytes);
                promised_.push_back(crc32c(page));
                send(FrameEnd{.frame = frame_, .page_crc = promised_.back()});
                break;
            }
            case 7: room_ = input.byte() % 4; break;
            case 8:
                device_.set_link(link());
                to_device_.clear();
                break;
        }
        device_work();
    }

    void check_invariants() const {
        const auto is_mark = [](std::byte byte) { return byte == kMark; };
        check(std::all_of(memory_.begin(), memory_.begin() + kGuard, is_mark));
        check(std::all_of(memory_.end() - kGuard, memory_.end(), is_mark));
        const auto page = device_.shown().page;
        const DeviceStatus status = device_.status(now_ns_);
        check(status.free_pages <= page_count_);
        if (page.empty()) return;
        check(page.size() == kPageBytes);
        check(crc32c(page) == status.shown_crc);
        check(std::find(promised_.begin(), promised_.end(), status.shown_crc) != promised_.end());
        check(frozen_.empty() || std::equal(page.begin(), page.end(), frozen_.begin(), frozen_.end()));
    }

private:
    std::span<std::byte> pages_memory() { return std::span(memory_).subspan(kGuard, page_count_ * kPageBytes); }

    template <class Message>
    void send(const Message& message) {
        std::size_t size = 0;
        if (encode_packet(session_, ++sequence_, message, packet_, size) == Status::Ok) {
            to_device_.emplace_back(packet_.begin(), packet_.begin() + static_cast<std::ptrdiff_t>(size));
        }
    }
    void put(const Header& header, std::span<const std::byte> payload) {
        FrameEnd end;
        if (header.type == PacketType::FrameEnd && decode(payload, end) == Status::Ok)
            promised_.push_back(end.page_crc);
        std::size_t size = 0;
        check(encode_packet(header, payload, packet_, size) == Status::Ok);
        to_device_.emplace_back(packet_.begin(), packet_.begin() + static_cast<std::ptrdiff_t>(size));
    }

    void device_work() {
        for (int i = 0; i < 4; ++i) (void)device_.poll(now_ns_);
    }

    Link link() {
        static constexpr LinkOperations kOperations{
            .info =
                [](const void*) {
                    return LinkInfo{"fuzz", kMaxPacketBytes, true};
                },
            .send = [](void* self,
                       std::span<const std::byte> packet) { return static_cast<World*>(self)->hear(packet); },
            .receive =
                [](void* self, std::span<std::byte> buffer, std::size_t& size) {
                    auto& queue = static_cast<World*>(self)->to_device_;
                    if (queue.empty()) return Status::WouldBlock;
                    if (queue.front().size() > buffer.size()) return Status::OutOfMemory;
                    std::copy(queue.front().begin(), queue.front().end(), buffer.begin());
                    size = queue.front().size();
                    queue.pop_front();
                    return Status::Ok;
                },
            .flush = nullptr,
            .wait = nullptr,
            .close = [](void*) {},
        };
        return {&kOperations, this};
    }

    /// An answer of the device; all of them decode.
    Status hear(std::span<const std::byte> packet) {
        if (room_ == 0) return Status::WouldBlock;
        Header header;
        std::span<const std::byte> payload;
        check(decode_packet(packet, header, payload) == Status::Ok);
        if (header.type != PacketType::Acknowledge) return Status::Ok;
        Acknowledge message;
        check(decode(payload, message) == Status::Ok);
        if (message.stage == AckStage::Accepted) accepted_frame_ = message.frame;
        return Status::Ok;
    }

    std::vector<std::byte> memory_;
    std::array<std::byte, kMinPacketBytes> buffer_{};
    std::array<std::byte, 1024> packet_{};
    std::deque<std::vector<std::byte>> to_device_;
    device::Device device_;
    std::uint32_t page_count_ = 0;
    std::uint64_t now_ns_ = 1'000'000;
    std::uint16_t session_ = 1;
    std::uint32_t sequence_ = 0;
    std::uint32_t frame_ = 0;
    std::uint32_t covered_ = 0;
    std::uint32_t accepted_frame_ = 0;
    unsigned room_ = 1;
    std::vector<std::uint32_t> promised_;  ///< Of every frame end sent.
    std::vector<std::byte> frozen_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Input input(data, size);
    World world(2 + input.byte() % 3);
    while (!input.empty()) {
        world.step(input);
        world.check_invariants();
    }
    return 0;
}
