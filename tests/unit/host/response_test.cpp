#include <cmath>
#include <random>

#include "driver/host/pixel_encoder.h"
#include "driver/host/response.h"
#include "tests/catch.h"
#include "tests/unit/host/light_reference.h"

using namespace xorvox;
using namespace xorvox::host;

TEST_CASE("levels give the light that the display's response says") {
    for (const Light& light : test::kResponses) {
        for (std::uint32_t bits = 1; bits <= 8; ++bits) {
            const ChannelLevels levels(light, bits);
            REQUIRE(levels.most() == (1u << bits) - 1);
            for (std::uint32_t level = 0; level <= levels.most(); ++level) {
                CHECK(levels.light(level) ==
                      Approx(test::response(light, static_cast<double>(level) / levels.most())).epsilon(1e-6));
            }
            CHECK(levels.light(0) == 0.0f);
            CHECK(levels.light(levels.most()) == 1.0f);
        }
    }
}

TEST_CASE("a place among the levels is the level below and the part of the way in light to the next") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> exponent(-34.0, 0.0);
    for (const Light& light : test::kResponses) {
        for (std::uint32_t bits = 1; bits <= 8; ++bits) {
            const ChannelLevels levels(light, bits);
            const auto of = [&](std::uint32_t level) {
                return test::response(light, static_cast<double>(level) / levels.most());
            };
            for (std::uint32_t level = 0; level <= levels.most(); ++level) {
                CHECK(levels.place(levels.light(level)) == static_cast<float>(level));
            }
            CHECK(levels.place(-0.0f) == 0.0f);
            for (int i = 0; i < 3000; ++i) {
                const auto wanted = static_cast<float>(i % 2 == 0 ? std::exp2(exponent(random)) : (i + 0.5) / 3000.0);
                std::uint32_t below = 0;
                while (below + 1 < levels.most() && of(below + 1) <= wanted) ++below;
                const double place = below + (wanted - of(below)) / (of(below + 1) - of(below));
                REQUIRE(levels.place(wanted) == Approx(place).margin(1e-4));
            }
        }
    }
}

TEST_CASE("the nearest code is nearest in light, in every format and response, of the bits that are shown") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> part(0.0f, 1.0f);
    for (const Light& light : test::kResponses) {
        for (const PixelFormat format : kPixelFormats) {
            for (std::uint8_t planes = 1; planes <= bits_per_channel(format); ++planes) {
                DisplayDescription display;
                display.format = format;
                display.light = light;
                display.scan.bit_planes = planes;
                const PixelEncoder encoder(display);
                for (int i = 0; i < 300; ++i) {
                    const glm::vec3 color(part(random), part(random), part(random));
                    const std::uint32_t code = encoder.nearest(color);
                    bool is_faint = true;
                    for (int c = 0; c < static_cast<int>(channel_count(format)); ++c) {
                        const test::Level at = test::level_of(display, code, c);
                        is_faint = is_faint && at.level <= 1;
                    }
                    if (is_faint) continue;
                    for (int c = 0; c < static_cast<int>(channel_count(format)); ++c) {
                        const test::Level at = test::level_of(display, code, c);
                        const double wanted = test::wanted(display, color, c);
                        const double off = std::abs(test::light_of(display, code, c) - wanted);
                        for (std::uint32_t other = 0; other <= at.most; ++other) {
                            const double its = test::response(light, static_cast<double>(other) / at.most);
                            REQUIRE(off <= std::abs(its - wanted) + 1e-6);
                        }
                    }
                }
            }
        }
    }
}

TEST_CASE("a code has no bit that is not shown, and light that is not black has one that is") {
    for (const Light& light : test::kResponses) {
        for (const PixelFormat format : kPixelFormats) {
            for (std::uint8_t planes = 1; planes <= bits_per_channel(format); ++planes) {
                DisplayDescription display;
                display.format = format;
                display.light = light;
                display.scan.bit_planes = planes;
                const PixelEncoder encoder(display);
                std::uint32_t shown = encoder.nearest(glm::vec3(1.0f));
                for (int c = 0; c < static_cast<int>(channel_count(format)); ++c) {
                    const test::Level at = test::level_of(display, shown, c);
                    CHECK(at.level == at.most);
                }
                for (const float gray : {1e-30f, 1e-6f, 0.01f, 0.3f, 0.9f}) {
                    for (const glm::vec3 color : {glm::vec3(gray), glm::vec3(gray, 0, 0), glm::vec3(0, gray, gray)}) {
                        const std::uint32_t code = encoder.nearest(color);
                        CHECK(code != 0);
                        CHECK((code & ~shown) == 0);
                        CHECK((encoder.dithered(color, 0.3f) & ~shown) == 0);
                    }
                }
                CHECK(encoder.nearest(glm::vec3(0.0f)) == 0);
            }
        }
    }
}

TEST_CASE("a dithered code is the level below or above by its threshold") {
    DisplayDescription display;
    display.format = PixelFormat::Mono2;
    const PixelEncoder encoder(display);
    const glm::vec3 gray(1.25f / 3.0f);
    CHECK(encoder.dithered(gray, 0.2f) == 2);
    CHECK(encoder.dithered(gray, 0.3f) == 1);
    CHECK(encoder.dithered(glm::vec3(0.05f), 0.5f) == 0);
    CHECK(encoder.dithered(glm::vec3(1.0f), 0.01f) == 3);
    CHECK(encoder.dithered(glm::vec3(0.0f), 1.0f / 128.0f) == 0);
}
