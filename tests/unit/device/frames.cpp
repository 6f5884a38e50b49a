#include <lz4.h>

#include "tests/unit/device/rig.h"

using namespace xorvox;
using namespace xorvox::test;

namespace {

Bytes lz4(std::span<const std::byte> bytes) {
    Bytes block(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))));
    const int size =
        LZ4_compress_default(reinterpret_cast<const char*>(bytes.data()), reinterpret_cast<char*>(block.data()),
                             static_cast<int>(bytes.size()), static_cast<int>(block.size()));
    REQUIRE(size > 0);
    block.resize(static_cast<std::size_t>(size));
    return block;
}

FrameBegin begin_of(std::uint32_t id) {
    return {.frame = id, .frame_bytes = 64};
}

Chunk raw_chunk(std::uint32_t id, std::span<const std::byte> frame, std::size_t offset, std::size_t length) {
    return {.frame = id,
            .offset = static_cast<std::uint32_t>(offset),
            .decoded_length = static_cast<std::uint32_t>(length),
            .codec = Codec::Raw,
            .data = frame.subspan(offset, length)};
}

}  // namespace

TEST_CASE("a keyframe is accepted when whole, and shown from the next boundary on") {
    Desk desk;
    CHECK(desk.hello().free_pages == 2);
    const Bytes frame = frame_of(1);
    const Acknowledge accepted = desk.accept(1, frame);
    CHECK(accepted.page_crc == crc32c(frame));
    CHECK(accepted.free_pages == 1);
    CHECK(desk.shown().empty());
    const Acknowledge presented = desk.present();
    CHECK(presented.frame == 1);
    CHECK(presented.page_crc == crc32c(frame));
    CHECK(presented.device_time_ns == desk.now_ns);
    CHECK(desk.shown() == frame);
    CHECK(desk.device.shown().frame == 1);
    CHECK(desk.silent());
}

TEST_CASE("chunks may be LZ4, and raw and LZ4 mixed") {
    Desk desk;
    desk.hello();
    Bytes frame(64, std::byte{0x5A});
    frame[50] = std::byte{1};
    const Bytes block = lz4(std::span(frame).first(40));
    desk.send(begin_of(1));
    desk.send(Chunk{.frame = 1, .offset = 0, .decoded_length = 40, .codec = Codec::Lz4, .data = block});
    desk.send(raw_chunk(1, frame, 40, 24));
    desk.send(FrameEnd{.frame = 1, .page_crc = crc32c(frame)});
    CHECK(desk.answer<Acknowledge>().stage == AckStage::Accepted);
    desk.present();
    CHECK(desk.shown() == frame);
}

TEST_CASE("two pages suffice for deltas with one frame in flight") {
    Desk desk(2);
    desk.hello();
    Bytes before = frame_of(0);
    desk.accept(100, before);
    CHECK(desk.present().free_pages == 1);
    for (std::uint8_t i = 1; i < 50; ++i) {
        const std::uint32_t id = 100u + i;
        const Bytes frame = frame_of(static_cast<std::uint8_t>(i * 5));
        desk.send_delta(id, frame, id - 1, before);
        const Acknowledge accepted = desk.answer<Acknowledge>();
        REQUIRE(accepted.stage == AckStage::Accepted);
        REQUIRE(accepted.frame == id);
        REQUIRE(accepted.free_pages == 0);
        REQUIRE(desk.shown() == before);
        REQUIRE(desk.present().free_pages == 1);
        REQUIRE(desk.shown() == frame);
        before = frame;
    }
}

TEST_CASE("frame ids wrap") {
    Desk desk;
    desk.hello();
    desk.accept(0xffffffffu, frame_of(1));
    desk.present();
    desk.send_delta(0, frame_of(2), 0xffffffffu, frame_of(1));
    CHECK(desk.answer<Acknowledge>().frame == 0);
    CHECK(desk.present().frame == 0);
    CHECK(desk.shown() == frame_of(2));
}

TEST_CASE("a delta on any frame but the last accepted one needs a keyframe") {
    Desk desk(3);
    desk.hello();
    desk.send_delta(5, frame_of(2), 4, frame_of(1));
    CHECK(desk.refusal(5) == NackReason::NeedKeyframe);
    desk.accept(6, frame_of(1));
    desk.accept(7, frame_of(2));
    desk.send_delta(8, frame_of(3), 6, frame_of(1));
    CHECK(desk.refusal(8) == NackReason::NeedKeyframe);
    CHECK(desk.silent());
    desk.send_delta(9, frame_of(3), 7, frame_of(2));
    CHECK(desk.answer<Acknowledge>().frame == 9);
}

TEST_CASE("a dropped delta leaves its base, so that a keyframe or the same delta again succeeds") {
    Desk desk;
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.present();
    std::vector<Bytes> packets = desk.delta_packets(2, frame_of(2), 1, frame_of(1));
    packets.erase(packets.begin() + 2);
    for (Bytes& packet : packets) desk.put(packet);
    CHECK(desk.refusal(2) == NackReason::Gap);
    CHECK(desk.silent());
    desk.send_delta(3, frame_of(2), 1, frame_of(1));
    CHECK(desk.answer<Acknowledge>().frame == 3);
    desk.present();
    CHECK(desk.shown() == frame_of(2));
}

TEST_CASE("losing any packet of a frame drops it whole, says so once, and the next keyframe is shown") {
    const std::size_t count = Desk().frame_packets(2, frame_of(2)).size();
    for (std::size_t lost = 0; lost < count; ++lost) {
        INFO("packet " << lost << " of " << count);
        Desk desk;
        desk.hello();
        desk.accept(1, frame_of(1));
        desk.present();
        std::vector<Bytes> packets = desk.frame_packets(2, frame_of(2));
        packets.erase(packets.begin() + static_cast<std::ptrdiff_t>(lost));
        for (Bytes& packet : packets) desk.put(packet);
        if (lost + 1 < count) {
            CHECK(desk.refusal(2) == NackReason::Gap);
        }
        CHECK(desk.silent());
        desk.device.boundary(desk.now_ns);
        CHECK(desk.shown() == frame_of(1));

        desk.send_frame(3, frame_of(3));
        if (lost + 1 == count) {
            CHECK(desk.refusal(2) == NackReason::Gap);
        }
        CHECK(desk.answer<Acknowledge>().frame == 3);
        desk.present();
        CHECK(desk.shown() == frame_of(3));
        CHECK(desk.device.status(desk.now_ns).frames_dropped == 1);
    }
}

TEST_CASE("a chunk or an end of another frame ends the one in reception, and both are told") {
    for (const std::size_t first_heard : {std::size_t{1}, std::size_t{5}}) {
        Desk desk;
        desk.hello();
        const std::vector<Bytes> cut = desk.frame_packets(1, frame_of(1));
        desk.put(cut[0]);
        desk.put(cut[1]);
        const std::vector<Bytes> beheaded = desk.frame_packets(2, frame_of(2));
        REQUIRE(beheaded.size() == 6);
        for (std::size_t i = first_heard; i < beheaded.size(); ++i) desk.put(beheaded[i]);
        CHECK(desk.refusal(1) == NackReason::Gap);
        CHECK(desk.refusal(2) == NackReason::Gap);
        CHECK(desk.silent());
    }
}

TEST_CASE("flipping any bit of any packet of a frame never lets another picture through") {
    const std::vector<Bytes> packets = Desk().frame_packets(1, frame_of(1), 0, 64);
    for (std::size_t which = 0; which < packets.size(); ++which) {
        for (std::size_t bit = 0; bit < packets[which].size() * 8; ++bit) {
            Desk desk;
            desk.hello();
            std::vector<Bytes> sent = desk.frame_packets(1, frame_of(1), 0, 64);
            sent[which][bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
            for (Bytes& packet : sent) desk.put(packet);
            desk.work();
            desk.device.boundary(desk.now_ns);
            REQUIRE(desk.shown().empty());
            REQUIRE(desk.device.status(desk.now_ns).packets_bad == 1);
        }
    }
}

TEST_CASE("a packet that comes twice counts once") {
    Desk desk;
    desk.hello();
    for (const Bytes& packet : desk.frame_packets(1, frame_of(1))) {
        desk.put(packet);
        desk.put(packet);
    }
    CHECK(desk.answer<Acknowledge>().stage == AckStage::Accepted);
    CHECK(desk.silent());
    CHECK(desk.device.status(desk.now_ns).frames_dropped == 0);
}

TEST_CASE("two chunks out of order are a gap") {
    Desk desk;
    desk.hello();
    std::vector<Bytes> packets = desk.frame_packets(1, frame_of(1));
    std::swap(packets[1], packets[2]);
    for (Bytes& packet : packets) desk.put(packet);
    CHECK(desk.refusal(1) == NackReason::Gap);
    CHECK(desk.silent());
}

TEST_CASE("a chunk sent again in a packet of its own, or skipped, is a gap") {
    for (const std::size_t second : {std::size_t{0}, std::size_t{8}, std::size_t{24}}) {
        Desk desk;
        desk.hello();
        const Bytes frame = frame_of(1);
        desk.send(begin_of(1));
        desk.send(raw_chunk(1, frame, 0, 16));
        desk.send(raw_chunk(1, frame, second, 16));
        CHECK(desk.refusal(1) == NackReason::Gap);
    }
}

TEST_CASE("a chunk that leaves the page, does not decode or has an unknown codec is a bad chunk") {
    const Bytes frame = frame_of(1);
    const Bytes longer(65);
    const Bytes block = lz4(frame);
    Chunk unknown = raw_chunk(1, frame, 0, 64);
    unknown.codec = static_cast<Codec>(9);
    for (const Chunk& chunk :
         {raw_chunk(1, longer, 0, 65),
          Chunk{.frame = 1, .offset = 0, .decoded_length = 0xffffffffu, .codec = Codec::Lz4, .data = block},
          Chunk{.frame = 1, .offset = 0, .decoded_length = 63, .codec = Codec::Lz4, .data = block},
          Chunk{.frame = 1, .offset = 0, .decoded_length = 64, .codec = Codec::Lz4},
          Chunk{.frame = 1, .offset = 0, .decoded_length = 32, .codec = Codec::Raw, .data = frame}, unknown}) {
        Desk desk;
        desk.hello();
        desk.send(begin_of(1));
        desk.send(chunk);
        desk.send(FrameEnd{.frame = 1});
        CHECK(desk.refusal(1) == NackReason::BadChunk);
        CHECK(desk.silent());
    }
}

TEST_CASE("a page whose CRC differs from frame end's is not shown") {
    Desk desk;
    desk.hello();
    const Bytes frame = frame_of(1);
    desk.send(begin_of(1));
    desk.send(raw_chunk(1, frame, 0, 64));
    desk.send(FrameEnd{.frame = 1, .page_crc = crc32c(frame) ^ 1u});
    CHECK(desk.refusal(1) == NackReason::BadCrc);
    desk.device.boundary(desk.now_ns);
    CHECK(desk.shown().empty());
}

TEST_CASE("a frame of another size or with unknown flags is refused") {
    Desk desk;
    desk.hello();
    desk.send(FrameBegin{.frame = 1, .frame_bytes = 63});
    CHECK(desk.refusal(1) == NackReason::BadFrame);
    desk.send(FrameBegin{.frame = 2, .flags = 2, .frame_bytes = 64});
    CHECK(desk.refusal(2) == NackReason::BadFrame);
    desk.accept(3, frame_of(3));
}

TEST_CASE("a frame without credit is refused and shown frames stay whole") {
    Desk desk(2);
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.present();
    CHECK(desk.accept(2, frame_of(2)).free_pages == 0);
    desk.send_frame(3, frame_of(3));
    const Nack nack = desk.answer<Nack>();
    CHECK(nack.reason == NackReason::NoPage);
    CHECK(nack.free_pages == 0);
    CHECK(desk.silent());
    CHECK(desk.shown() == frame_of(1));
    CHECK(desk.present().frame == 2);
    CHECK(desk.shown() == frame_of(2));
}

TEST_CASE("a frame that is begun anew is received anew") {
    Desk desk;
    desk.hello();
    const std::vector<Bytes> broken = desk.frame_packets(1, frame_of(9));
    desk.put(broken[0]);
    desk.put(broken[1]);
    desk.accept(1, frame_of(1));
    desk.present();
    CHECK(desk.shown() == frame_of(1));
}

TEST_CASE("what comes of an accepted frame is ignored") {
    Desk desk;
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.send(raw_chunk(1, frame_of(2), 0, 64));
    desk.send(FrameEnd{.frame = 1, .page_crc = 1});
    CHECK(desk.silent());
    desk.present();
    CHECK(desk.shown() == frame_of(1));
}

TEST_CASE("while a frame is received, boundaries go on showing the one before, whole") {
    Desk desk;
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.present();
    for (const Bytes& packet : desk.delta_packets(2, frame_of(2), 1, frame_of(1))) {
        REQUIRE(desk.shown() == frame_of(1));
        desk.put(packet);
        desk.work();
        REQUIRE(desk.shown() == frame_of(1));
        desk.device.boundary(desk.now_ns);
    }
    CHECK(desk.shown() == frame_of(2));
}

TEST_CASE("present_at holds a frame back until the first boundary at or after it") {
    Desk desk;
    desk.hello();
    desk.accept(1, frame_of(1), 20'000'000);
    desk.device.boundary(19'999'999);
    CHECK(desk.shown().empty());
    CHECK(desk.silent());
    desk.now_ns = 20'000'000;
    desk.device.boundary(desk.now_ns);
    CHECK(desk.shown() == frame_of(1));
    CHECK(desk.answer<Acknowledge>().stage == AckStage::Presented);
}

TEST_CASE("of several due frames the one due last is presented and the others give up their pages") {
    Desk desk(4);
    desk.hello();
    desk.accept(1, frame_of(1), 30'000'000);
    desk.accept(2, frame_of(2), 20'000'000);
    CHECK(desk.accept(3, frame_of(3), 90'000'000).free_pages == 1);
    desk.now_ns = 40'000'000;
    const Acknowledge presented = desk.present();
    CHECK(presented.frame == 1);
    CHECK(presented.free_pages == 2);
    CHECK(desk.silent());
    CHECK(desk.shown() == frame_of(1));
    desk.now_ns = 95'000'000;
    CHECK(desk.present().frame == 3);
}

TEST_CASE("a frame that comes after its time is shown like one that asks for none") {
    Desk desk(3);
    desk.hello();
    desk.now_ns = 50'000'000;
    desk.accept(1, frame_of(1), 40'000'000);
    desk.now_ns = 51'000'000;
    desk.accept(2, frame_of(2), 10'000'000);
    CHECK(desk.present().frame == 2);
}
