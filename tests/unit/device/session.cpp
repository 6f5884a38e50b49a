#include "tests/unit/device/rig.h"

using namespace xorvox;
using namespace xorvox::test;

TEST_CASE("hello says what the device is") {
    Desk desk(3, 1000);
    const Hello hello = desk.hello();
    CHECK(hello.major == kMajor);
    CHECK(hello.minor == kMinor);
    CHECK(hello.features == (kFeatureDelta | kFeaturePresentAt));
    CHECK(hello.boot_nonce == 7);
    CHECK(hello.serial.view() == "XV-0001");
    CHECK(hello.display.view() == "cube8");
    CHECK(hello.geometry_digest == geometry_digest(kCube8));
    CHECK(hello.format == PixelFormat::Mono1);
    CHECK(hello.planes == 1);
    CHECK(hello.frame_bytes == 64);
    CHECK(hello.pages == 3);
    CHECK(hello.max_packet_bytes == 1000);
    CHECK(hello.codecs == 3);
    CHECK(hello.fault == Fault::None);
    CHECK(hello.free_pages == 3);
    CHECK(hello.device_time_ns == desk.now_ns);
    CHECK(hello.host_time_ns == desk.now_ns);
}

TEST_CASE("max_packet is the shorter of the buffer and what the link carries") {
    Desk desk(2, 1000);
    desk.link.max_packet_bytes = 300;
    CHECK(desk.hello().max_packet_bytes == 300);
}

TEST_CASE("init refuses what cannot work") {
    DeskLink link;
    Bytes pages(128);
    Bytes packet(256);
    const device::DeviceConfig good{
        .display = &kCube8, .link = link.link(), .pages = pages, .page_count = 2, .packet = packet};
    const auto init_with = [&](auto&& change) {
        device::DeviceConfig config = good;
        change(config);
        return device::Device().init(config, 0);
    };
    Bytes long_packet(kMaxPacketBytes + 1);
    DisplayDescription nothing;
    DisplayDescription many_panels = kCube8;
    many_panels.panel_count = kMaxPanels + 1;
    using Config = device::DeviceConfig;
    CHECK(init_with([](Config&) {}) == Status::Ok);
    CHECK(init_with([](Config& c) { c.display = nullptr; }) == Status::InvalidArgument);
    CHECK(init_with([](Config& c) { c.pages = {}; }) == Status::InvalidArgument);
    CHECK(init_with([](Config& c) { c.packet = {}; }) == Status::InvalidArgument);
    CHECK(init_with([](Config& c) { c.packet = c.packet.first(255); }) == Status::InvalidArgument);
    CHECK(init_with([&](Config& c) { c.packet = long_packet; }) == Status::InvalidArgument);
    CHECK(init_with([&](Config& c) { c.packet = std::span(long_packet).first(kMaxPacketBytes); }) == Status::Ok);
    CHECK(init_with([](Config& c) { c.page_count = 1; }) == Status::InvalidArgument);
    CHECK(init_with([](Config& c) { c.page_count = 9; }) == Status::InvalidArgument);
    CHECK(init_with([](Config& c) { c.page_count = 3; }) == Status::OutOfMemory);
    CHECK(init_with([](Config& c) { c.pages = c.pages.first(127); }) == Status::OutOfMemory);
    CHECK(init_with([&](Config& c) { c.display = &nothing; }) == Status::InvalidArgument);
    CHECK(init_with([&](Config& c) { c.display = &many_panels; }) == Status::InvalidArgument);
}

TEST_CASE("nothing is answered before a session began, or to another session") {
    Desk desk;
    desk.send(Ping{.host_time_ns = 5});
    desk.send_frame(1, frame_of(1));
    CHECK(desk.silent());
    desk.hello();
    desk.put(packet_of(8, 1000, Ping{.host_time_ns = 5}));
    desk.put(packet_of(0, 1001, Ping{.host_time_ns = 5}));
    CHECK(desk.silent());
    CHECK(desk.device.status(desk.now_ns).packets_bad == 0);
    desk.send(Ping{.host_time_ns = 6});
    CHECK(desk.answer<Pong>().host_time_ns == 6);
}

TEST_CASE("session 0 is no session") {
    Desk desk;
    desk.put(packet_of(0, 0, HelloRequest{}));
    CHECK(desk.silent());
}

TEST_CASE("another major version is refused, in the message and in the packet, and ends no session") {
    Desk desk;
    desk.hello();
    desk.put(packet_of(desk.session, desk.sequence++, HelloRequest{.major = kMajor + 1}));
    CHECK(desk.refusal(0) == NackReason::BadVersion);

    Bytes packet = packet_of(desk.session, desk.sequence++, HelloRequest{});
    packet[2] = std::byte{kMajor + 1};
    const std::uint32_t crc = crc32c(std::span(packet).first(packet.size() - kCrcBytes));
    for (std::size_t i = 0; i < 4; ++i) packet[packet.size() - 4 + i] = static_cast<std::byte>(crc >> 8 * i & 0xff);
    desk.put(packet);
    CHECK(desk.refusal(0) == NackReason::BadVersion);
    desk.accept(1, frame_of(1));
}

TEST_CASE("a higher minor version is welcome") {
    Desk desk;
    desk.send(HelloRequest{.minor = 9});
    CHECK(desk.answer<Hello>().minor == kMinor);
}

TEST_CASE("a new session forgets the frame in reception and the delta base, and keeps what is shown") {
    Desk desk(3);
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.present();
    const std::vector<Bytes> packets = desk.frame_packets(2, frame_of(2));
    desk.put(packets[0]);
    desk.put(packets[1]);
    desk.work();
    ++desk.session;
    desk.sequence = 0;
    CHECK(desk.hello().free_pages == 2);
    CHECK(desk.shown() == frame_of(1));
    desk.send_delta(3, frame_of(3), 1, frame_of(1));
    CHECK(desk.refusal(3) == NackReason::NeedKeyframe);
    CHECK(desk.silent());
    desk.accept(4, frame_of(4));
}

TEST_CASE("a frame accepted in the session before is still shown, and the new host hears of the free pages") {
    Desk desk(2);
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.present();
    desk.accept(2, frame_of(2), 1'000'000'000'000);
    ++desk.session;
    CHECK(desk.hello().free_pages == 0);
    desk.device.boundary(desk.now_ns);
    const DeviceStatus status = desk.answer<DeviceStatus>();
    CHECK(status.shown_frame == 2);
    CHECK(status.free_pages == 1);
    CHECK(desk.shown() == frame_of(2));
}

TEST_CASE("a hello request that comes twice begins one session") {
    Desk desk;
    const Bytes request = desk.next_packet(HelloRequest{.host_time_ns = 100});
    desk.put(request);
    desk.answer<Hello>();
    desk.accept(1, frame_of(1));
    desk.put(request);
    CHECK(desk.silent());
    desk.send_delta(2, frame_of(2), 1, frame_of(1));
    CHECK(desk.answer<Acknowledge>().frame == 2);
}

TEST_CASE("a host that was started anew with the same session id is heard") {
    Desk desk;
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.sequence = 0;
    desk.now_ns += 1;
    desk.hello();
    desk.accept(1, frame_of(2));
}

TEST_CASE("asking again in a session goes on counting the device's packets") {
    Desk desk;
    const auto sequence_of_hello = [&] {
        desk.send(HelloRequest{.host_time_ns = desk.now_ns});
        desk.work();
        Header header;
        std::span<const std::byte> payload;
        REQUIRE(decode_packet(desk.link.from_device.front(), header, payload) == Status::Ok);
        desk.link.from_device.pop_front();
        return header.sequence;
    };
    CHECK(sequence_of_hello() == 0);
    CHECK(sequence_of_hello() == 1);
    ++desk.session;
    CHECK(sequence_of_hello() == 0);
}

TEST_CASE("sequence numbers wrap") {
    Desk desk;
    desk.sequence = 0xfffffffeu;
    desk.hello();
    desk.accept(1, frame_of(1));
    CHECK(desk.sequence < 100);
}

TEST_CASE("unknown types, unknown flags and undecodable payloads are ignored") {
    Desk desk;
    desk.hello();
    const auto put_packet = [&](Header header, std::size_t payload_bytes) {
        Bytes packet(kPacketOverhead + payload_bytes);
        std::size_t size = 0;
        header.session = desk.session;
        header.sequence = desk.sequence++;
        REQUIRE(encode_packet(header, Bytes(payload_bytes), packet, size) == Status::Ok);
        desk.put(packet);
    };
    put_packet({.type = static_cast<PacketType>(0x7f)}, 9);
    put_packet({.type = PacketType::Pong}, 16);
    for (const PacketType type : {PacketType::HelloRequest, PacketType::FrameBegin, PacketType::Chunk,
                                  PacketType::FrameEnd, PacketType::Control, PacketType::Ping}) {
        put_packet({.type = type}, 1);
    }
    CHECK(desk.silent());
    put_packet({.type = PacketType::Ping, .flags = 0xffff}, 8);
    CHECK(desk.answer<Pong>().host_time_ns == 0);
    CHECK(desk.device.status(desk.now_ns).packets_bad == 0);
}

TEST_CASE("damaged packets and what the link reports as damage are counted") {
    Desk desk;
    desk.hello();
    desk.put(Bytes(30, std::byte{0x58}));
    desk.link.damaged = true;
    desk.work();
    CHECK(desk.device.status(desk.now_ns).packets_bad == 2);
}

TEST_CASE("answers that the link does not take now are sent later, and nothing is received meanwhile") {
    Desk desk;
    desk.hello();
    desk.link.room = 0;
    desk.send_frame(1, frame_of(1));
    desk.send(Ping{.host_time_ns = 3});
    desk.work();
    CHECK(desk.link.to_device.size() == 1);
    desk.now_ns += 1'000'000;
    desk.device.boundary(desk.now_ns);
    CHECK(desk.shown() == frame_of(1));
    CHECK(desk.device.poll(desk.now_ns) == Status::WouldBlock);
    desk.link.room = 1;
    CHECK(desk.answer<Acknowledge>().stage == AckStage::Accepted);
    const Acknowledge presented = desk.answer<Acknowledge>();
    CHECK(presented.stage == AckStage::Presented);
    CHECK(presented.device_time_ns == 2'000'000);
    CHECK(desk.answer<Pong>().host_time_ns == 3);
    CHECK(desk.silent());
}

TEST_CASE("a device waits for room while it has answers to send, and for packets otherwise") {
    Desk desk;
    CHECK(desk.device.events() == kLinkReadable);
    desk.hello();
    CHECK(desk.device.events() == kLinkReadable);
    desk.link.room = 0;
    desk.send(Ping{});
    desk.work();
    CHECK(desk.device.events() == kLinkWritable);
    desk.link.room = 1;
    desk.answer<Pong>();
    CHECK(desk.device.events() == kLinkReadable);
}

TEST_CASE("a frame cut short by a refused one gets both answers, in order, one at a time") {
    Desk desk;
    desk.hello();
    desk.link.room = 1;
    desk.put(desk.frame_packets(1, frame_of(1))[0]);
    desk.send(FrameBegin{.frame = 2, .frame_bytes = 1});
    CHECK(desk.refusal(1) == NackReason::Gap);
    CHECK(desk.refusal(2) == NackReason::BadFrame);
    CHECK(desk.silent());
}

TEST_CASE("poll returns after a bounded number of packets") {
    Desk desk;
    desk.hello();
    for (std::uint64_t i = 0; i < 1000; ++i) desk.send(Ping{.host_time_ns = i});
    CHECK(desk.device.poll(desk.now_ns) == Status::Ok);
    CHECK(desk.link.to_device.size() > 900);
}

TEST_CASE("a packet beyond max_packet and a closed link close, and set_link gives another client a fresh session") {
    Desk desk;
    desk.hello();
    desk.accept(1, frame_of(1));
    desk.present();
    desk.put(Bytes(257));
    CHECK(desk.device.poll(desk.now_ns) == Status::Closed);
    desk.device.set_link({});
    CHECK(desk.device.poll(desk.now_ns) == Status::Closed);

    DeskLink other;
    desk.device.set_link(other.link());
    CHECK(desk.device.poll(desk.now_ns) == Status::WouldBlock);
    CHECK(desk.shown() == frame_of(1));
    other.to_device.push_back(packet_of(desk.session, 0, HelloRequest{}));
    CHECK(desk.device.poll(desk.now_ns) == Status::Ok);
    REQUIRE(other.from_device.size() == 1);
    other.closed = true;
    CHECK(desk.device.poll(desk.now_ns) == Status::Closed);
}

TEST_CASE("a longest packet is taken") {
    Desk desk(2, kMinPacketBytes);
    desk.hello();
    Bytes packet(kMinPacketBytes);
    std::size_t size = 0;
    const Header header{.type = PacketType::Ping, .session = desk.session, .sequence = desk.sequence++};
    REQUIRE(encode_packet(header, Bytes(kMinPacketBytes - kPacketOverhead), packet, size) == Status::Ok);
    desk.put(packet);
    CHECK(desk.answer<Pong>().host_time_ns == 0);
}
