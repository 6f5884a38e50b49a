// The example that a plan measures compression on.
#include "driver/host/example_frames.h"

#include "driver/host/encoder.h"
#include "driver/wire/packet.h"
#include "tests/catch.h"
#include "tests/unit/plan/displays.h"

using namespace xorvox;
using namespace xorvox::host;
using namespace xorvox::test;

namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

}  // namespace

TEST_CASE("every kind of display can show the example, in every format", "[plan]") {
    for (const PixelFormat format : kPixelFormats) {
        for (const DisplayDescription& display : every_kind(format)) {
            CAPTURE(to_string(format), display.name.view());
            const auto example = measure_example(display, kAll);
            REQUIRE(example.has_value());
            CHECK(example->measured_slices == display.slices);
            CHECK(example->lit > 0.05);
            CHECK(example->lit < 0.7);
            const auto raw = static_cast<double>(raw_wire_bytes(frame_bytes(display)));
            for (const ExampleBytes& bytes : {example->constant, example->gradient}) {
                CHECK(bytes.moving > 0.0);
                CHECK(bytes.moving <= raw);
                CHECK(bytes.keyframe <= raw);
            }
        }
    }
}

TEST_CASE("a large display's example is measured on some of its slices and scaled up", "[plan]") {
    DisplayDescription display = rotor(PixelFormat::Rgb332);
    display.slices = 360;
    for (std::uint32_t p = 0; p < 2; ++p) display.panels[p].columns = display.panels[p].rows = 64;
    const auto whole = measure_example(display, kAll);
    const auto part = measure_example(display, frame_pixels(display) / 8 + 5);
    REQUIRE(whole.has_value());
    REQUIRE(part.has_value());
    CHECK(part->measured_slices == 45);
    CHECK(part->lit == Approx(whole->lit).epsilon(0.02));
    CHECK(part->constant.keyframe == Approx(whole->constant.keyframe).epsilon(0.15));
    CHECK(part->gradient.moving == Approx(whole->gradient.moving).epsilon(0.15));
    CHECK(measure_example(display, 1)->measured_slices == 1);
    DisplayDescription uneven = uneven_stack(PixelFormat::Mono1);
    CHECK(measure_example(uneven, 3 * 63)->measured_slices == 3);
}

TEST_CASE("a frame in motion takes less than a keyframe, and white less than a gradient", "[plan]") {
    DisplayDescription display = rotor(PixelFormat::Rgb332);
    display.slices = 180;
    for (std::uint32_t p = 0; p < 2; ++p) display.panels[p].columns = display.panels[p].rows = 64;
    const auto example = measure_example(display, kAll);
    REQUIRE(example.has_value());
    CHECK(example->constant.moving < 0.8 * example->constant.keyframe);
    CHECK(example->constant.moving < example->gradient.moving);
    CHECK(example->constant.keyframe < 0.2 * static_cast<double>(frame_bytes(display)));
}

TEST_CASE("raw bytes on the wire are those that the encoder makes", "[plan]") {
    for (const std::size_t size : {1u, 64u, 65'502u, 65'503u, 65'504u, 200'000u, 655'030u}) {
        std::vector<std::byte> content(size, std::byte{7});
        FrameEncoder encoder({.max_packet_bytes = wire::kMaxPacketBytes, .lz4 = false});
        encoder.encode({.id = 1, .content = content});
        std::size_t bytes = 0;
        for (std::size_t i = 0; i < encoder.payload_count(); ++i) {
            bytes += encoder.payload(i).bytes.size() + wire::kPacketOverhead;
        }
        CHECK(raw_wire_bytes(size) == bytes);
    }
}
