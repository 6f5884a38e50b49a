#include "sim/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "sim/canvas.h"
#include "sim/exposed_voxels.h"

namespace xorvox::sim {
namespace {

constexpr Color kGround{18, 20, 26};
constexpr Color kInk{225, 228, 235};
constexpr float kGrey = 0.35f;     ///< Of light that is as it was sent.
constexpr double kChanged = 0.25;  ///< Part of the light sent.
constexpr Color kAsSent{128, 128, 128};
constexpr float kShinesThrough = 0.6f;  ///< How much of a difference is seen through what stands before it.
constexpr int kRow = 34;
constexpr int kMargin = 20;

struct MarkStyle {
    const char* name;
    Color color;      ///< In the legend,
    glm::vec3 light;  ///< and in the picture, linear.
};
// Okabe and Ito's, which people of all colour visions can tell apart.
/// A voxel has the first that holds.
constexpr std::array<MarkStyle, 4> kMarks{{{"lost", {213, 94, 0}, {1.0f, 0.12f, 0.0f}},
                                           {"extra", {240, 228, 66}, {0.9f, 0.8f, 0.05f}},
                                           {"displaced", {86, 180, 233}, {0.08f, 0.45f, 1.0f}},
                                           {"changed", {204, 121, 167}, {0.75f, 0.12f, 0.5f}}}};

constexpr std::size_t kDisplaced = 2;
/// Laid over each other in this order, so that what is missing is seen among what is out of place.
constexpr std::array<std::size_t, kMarks.size()> kShineThrough{3, 2, 1, 0};

/// Light of its own colour.
class Fields {
public:
    void add(LightField& field, const glm::dvec3& place_mm, const glm::vec3& light) {
        field.flashes.push_back({place_mm, 0, 0});
        field.measured.push_back(light);
        all.flashes.push_back({place_mm, 0, 0});
    }

    LightField sent;
    LightField differences;  ///< And what was lit as it was sent, in grey.
    std::array<LightField, kMarks.size()> marked;
    LightField all;
    std::array<std::size_t, kMarks.size()> counts{};
    std::size_t voxels = 0;
    std::size_t as_sent = 0;
    double displaced_mm = 0.0;  ///< At most.
};

bool is_changed(const ExposedVoxel& voxel) {
    for (int channel = 0; channel < 3; ++channel) {
        const double away = std::abs(double{voxel.light[channel]} / voxel.due - double{voxel.sent[channel]});
        const double most = std::max({voxel.sent.x, voxel.sent.y, voxel.sent.z});
        if (away > kChanged * most) return true;
    }
    return false;
}

Fields fields_of(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness) {
    Fields fields;
    for_each_voxel(exposure, page, brightness, [&](const ExposedVoxel& voxel) {
        if (voxel.sent != glm::vec3(0.0f)) {
            fields.add(fields.sent, voxel.place_mm, voxel.sent);
            ++fields.voxels;
        }
        const std::array<bool, kMarks.size()> is{
            voxel.is_lost(), voxel.is_extra(), voxel.outside != glm::vec3(0.0f),
            !voxel.is_lost() && !voxel.is_extra() && voxel.due > 0.0 && is_changed(voxel)};
        for (std::size_t mark = 0; mark < is.size(); ++mark) fields.counts[mark] += is[mark];
        const auto first = static_cast<std::size_t>(std::ranges::find(is, true) - is.begin());
        if (voxel.outside != glm::vec3(0.0f)) fields.displaced_mm = std::max(fields.displaced_mm, voxel.stray_mm);
        if (first < is.size()) {
            const glm::dvec3& place_mm = voxel.is_lost() ? voxel.place_mm : voxel.seen_mm;
            fields.add(fields.differences, place_mm, kMarks[first].light);
            fields.add(fields.marked[first], place_mm, kMarks[first].light);
        } else if (voxel.light != glm::vec3(0.0f)) {
            fields.add(fields.differences, voxel.seen_mm, glm::vec3(kGrey));
            ++fields.as_sent;
        }
    });
    return fields;
}

/// The outermost flashes, each way: what a camera must see of all of them.
LightField outermost(const LightField& all) {
    constexpr int kWays = 128;  // Spread over a sphere as seeds are in a sunflower.
    LightField outer;
    for (int way = 0; way < kWays && !all.flashes.empty(); ++way) {
        const double z = (2.0 * way + 1.0) / kWays - 1.0;
        const double angle = way * std::numbers::pi * (3.0 - std::sqrt(5.0));
        const glm::dvec3 towards(std::sqrt(1.0 - z * z) * glm::dvec3(std::cos(angle), std::sin(angle), 0.0) +
                                 glm::dvec3(0.0, 0.0, z));
        outer.flashes.push_back(*std::ranges::max_element(
            all.flashes, {}, [&](const Flash& flash) { return glm::dot(flash.place_mm, towards); }));
    }
    return outer;
}

void blend(Image& under, const Picture& over) {
    for (std::size_t i = 0; i < over.cover.size(); ++i) {
        const float part = kShinesThrough * over.cover[i];
        for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
            const float mixed = glm::mix(static_cast<float>(under.rgb[c]), static_cast<float>(over.image.rgb[c]), part);
            under.rgb[c] = static_cast<std::uint8_t>(std::lround(mixed));
        }
    }
}

void paste(Image& sheet, const Image& image, std::uint32_t left, std::uint32_t top) {
    for (std::uint32_t row = 0; row < image.height; ++row) {
        std::memcpy(&sheet.rgb[3 * (std::size_t{top + row} * sheet.width + left)],
                    &image.rgb[3 * std::size_t{row} * image.width], std::size_t{3} * image.width);
    }
}

/// Draws the legend, on a canvas if there is one; the rows that it takes.
int place_legend(Canvas* canvas, int width, int top, const Fields& fields) {
    int x = kMargin;
    int rows = 1;
    const auto entry = [&](const std::string& label, const Color* color) {
        const int wide = text_width(label) + (color != nullptr ? 28 : 0);
        if (x > kMargin && x + wide > width - kMargin) {
            x = kMargin;
            ++rows;
        }
        const int y = top + kRow * rows - (kRow - text_height()) / 2;
        if (canvas != nullptr) {
            if (color != nullptr) canvas->box({x, y - text_height()}, {x + 18, y}, *color);
            canvas->text({x + (color != nullptr ? 28 : 0), y}, label, kInk);
        }
        x += wide + 32;
    };
    entry(fmt::format("voxels sent: {}", fields.voxels), nullptr);
    entry(fmt::format("as sent: {}", fields.as_sent), &kAsSent);
    for (std::size_t i = 0; i < kMarks.size(); ++i) {
        std::string label = fmt::format("{}: {}", kMarks[i].name, fields.counts[i]);
        if (fields.displaced_mm > 0.0 && i == kDisplaced)
            label += fmt::format(" (up to {:.3g} mm)", fields.displaced_mm);
        entry(label, &kMarks[i].color);
    }
    return rows;
}

}  // namespace

Expected<Picture> render_comparison(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness,
                                    const PictureOptions& options) {
    const DisplayDescription& display = exposure.display();
    const Fields fields = fields_of(exposure, page, brightness);
    const LightField framed = outermost(fields.all);
    PictureOptions in_view = options;
    in_view.framed = &framed;
    const Expected<Picture> sent = render_perspective(display, fields.sent, in_view);
    if (!sent) return sent;
    const Expected<Picture> lit = render_perspective(display, exposure.light(), in_view);
    if (!lit) return lit;
    Expected<Picture> differences = render_perspective(display, fields.differences, in_view);
    if (!differences) return differences;
    for (const std::size_t mark : kShineThrough) {
        if (fields.marked[mark].flashes.empty()) continue;
        const Expected<Picture> marks = render_perspective(display, fields.marked[mark], in_view);
        if (!marks) return marks;
        blend(differences->image, *marks);
    }

    const std::uint32_t width = 3 * options.width;
    const int columns = static_cast<int>(width);
    const int rows = place_legend(nullptr, columns, 0, fields);
    const std::uint32_t top = kRow;
    Canvas canvas(width, top + options.height + static_cast<std::uint32_t>(kRow * rows), kGround);
    const int title = (kRow + text_height()) / 2;
    canvas.text({kMargin, title}, "sent", kInk);
    canvas.text({columns / 3 + kMargin, title}, "lit", kInk);
    canvas.text({2 * columns / 3 + kMargin, title}, "differences", kInk);
    (void)place_legend(&canvas, columns, static_cast<int>(top + options.height), fields);

    Picture picture;
    picture.image = canvas.image();
    paste(picture.image, sent->image, 0, top);
    paste(picture.image, lit->image, options.width, top);
    paste(picture.image, differences->image, 2 * options.width, top);
    picture.covered = sent->covered;
    picture.clipped = sent->clipped;
    picture.drawn_by = sent->drawn_by;
    return picture;
}

}  // namespace xorvox::sim
