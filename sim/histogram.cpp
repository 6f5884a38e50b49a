#include "sim/histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "sim/canvas.h"
#include "sim/pixel_light.h"
#include "sim/pixel_rows.h"

namespace xorvox::sim {
namespace {

constexpr Color kPaper{255, 255, 255};
constexpr Color kInk{40, 40, 40};
constexpr Color kGrid{225, 225, 225};
// Okabe and Ito's, which people of all colour visions can tell apart.
constexpr Color kLit{86, 180, 233};
constexpr Color kSent{213, 94, 0};

constexpr int kWidth = 960;
constexpr int kHeight = 540;
constexpr int kLeft = 96;
constexpr int kRight = 32;
constexpr int kTop = 100;
constexpr int kBottom = 76;
constexpr double kTitleTicks = 0.2;  ///< Light from one label to the next.

std::size_t bin_of(const glm::vec3& light) {
    const double mean = (double{light.x} + double{light.y} + double{light.z}) / 3.0;
    // Levels that lie between two bins must not be thrown to either side by rounding.
    const double bin = std::floor(mean / LightHistogram::kBinWidth + 1e-3);
    return static_cast<std::size_t>(std::clamp(bin, 0.0, LightHistogram::kBins - 1.0));
}

/// Where bins and counts are on the chart.
class Axes {
public:
    explicit Axes(std::uint64_t most) {
        while (std::pow(10.0, decades_) < static_cast<double>(most)) ++decades_;
    }
    double x(double bin) const { return kLeft + bin / LightHistogram::kBins * (kWidth - kLeft - kRight); }
    /// Half a voxel is at the axis, so that one can be seen.
    double y(double count) const {
        const double up = count < 0.5 ? 0.0 : std::log10(count / 0.5) / (decades_ + std::log10(2.0));
        return kHeight - kBottom - up * (kHeight - kTop - kBottom);
    }
    int decades() const { return decades_; }

private:
    int decades_ = 1;
};

std::string count_label(int decade) {
    constexpr const char* kUnits[] = {"", "k", "M", "G"};
    const auto unit = std::min<std::size_t>(static_cast<std::size_t>(decade) / 3, 3);
    return fmt::format("{:.0f}{}", std::pow(10.0, decade - 3 * static_cast<int>(unit)), kUnits[unit]);
}

void centered(Canvas& canvas, std::string_view text, double x, int y) {
    canvas.text({static_cast<int>(x) - text_width(text) / 2, y}, text, kInk);
}

void draw_axes(Canvas& canvas, const Axes& axes) {
    for (int decade = 0; decade <= axes.decades(); ++decade) {
        const double y = axes.y(std::pow(10.0, decade));
        canvas.line({kLeft, y}, {kWidth - kRight, y}, 1.0, kGrid);
        const std::string label = count_label(decade);
        canvas.text({kLeft - 10 - text_width(label), static_cast<int>(y) + text_height() / 2}, label, kInk);
    }
    canvas.text({16, kTop - 16}, "voxels", kInk);
    constexpr double kBinsToLabel = kTitleTicks / LightHistogram::kBinWidth;
    for (double bin = 0.0; bin < LightHistogram::kBins; bin += kBinsToLabel) {
        const double x = axes.x(bin);
        canvas.line({x, kHeight - kBottom}, {x, kHeight - kBottom + 6}, 1.5, kInk);
        centered(canvas, fmt::format("{:.1f}", bin * LightHistogram::kBinWidth), x,
                 kHeight - kBottom + 12 + text_height());
    }
    constexpr double kMore = (LightHistogram::kBins - 1) * LightHistogram::kBinWidth;
    const std::string more = fmt::format("{:.2f} +", kMore);
    canvas.text({kWidth - kRight - text_width(more), kHeight - kBottom + 12 + text_height()}, more, kInk);
    centered(canvas, "light of a voxel, steady full light is 1", (kLeft + kWidth - kRight) / 2.0, kHeight - 18);
    const glm::dvec2 corners[] = {{kLeft, kTop}, {kLeft, kHeight - kBottom}, {kWidth - kRight, kHeight - kBottom}};
    canvas.line(corners, 1.5, kInk);
}

void draw_bars(Canvas& canvas, const Axes& axes, const LightHistogram& histogram) {
    for (std::size_t bin = 0; bin < LightHistogram::kBins; ++bin) {
        const auto at = static_cast<double>(bin);
        canvas.box({axes.x(at) + 1.0, axes.y(static_cast<double>(histogram.lit[bin]))},
                   {axes.x(at + 1.0) - 1.0, axes.y(0.0)}, kLit);
    }
    std::vector<glm::dvec2> outline;
    for (std::size_t bin = 0; bin < LightHistogram::kBins; ++bin) {
        const double y = axes.y(static_cast<double>(histogram.sent[bin]));
        outline.emplace_back(axes.x(static_cast<double>(bin)), y);
        outline.emplace_back(axes.x(static_cast<double>(bin) + 1.0), y);
    }
    canvas.line(outline, 2.0, kSent);
}

void draw_legend(Canvas& canvas, const LightHistogram& histogram) {
    int x = kLeft;
    const auto entry = [&](std::string_view label, Color color, bool filled) {
        const glm::dvec2 at(x, 66.0);
        canvas.line(at, at + glm::dvec2(26.0, 0.0), filled ? 10.0 : 2.0, color);
        x += 38;
        canvas.text({x, 66 + text_height() / 2}, label, kInk);
        x += text_width(label) + 36;
    };
    entry("lit", kLit, true);
    entry("sent", kSent, false);
    const std::string lost = fmt::format("{} lost (sent, not lit)", histogram.lost);
    canvas.text({x, 66 + text_height() / 2}, lost, kInk);
}

}  // namespace

LightHistogram make_histogram(const Exposure& exposure, std::span<const std::byte> page, std::uint8_t brightness) {
    LightHistogram histogram;
    histogram.display = exposure.display().name.view();
    histogram.exposure_ms = static_cast<double>(exposure.to_ns() - exposure.from_ns()) * 1e-6;
    const DisplayDescription& display = exposure.display();
    const PixelLight pixels(display);
    const float full = static_cast<float>(brightness) / 255.0f;
    const std::vector<std::byte> dark(page.empty() ? frame_bytes(display) : 0);
    std::vector<glm::vec3> sent;
    std::vector<glm::vec3> light;
    const auto count = [&](std::uint32_t slice, std::uint32_t p, std::uint32_t row, std::span<const std::byte> bytes) {
        const auto due = static_cast<float>(exposure.due(slice));
        if (due <= 0.0f) return;
        const std::uint32_t columns = display.panels[p].columns;
        sent.assign(columns, glm::vec3(0.0f));
        light.assign(columns, glm::vec3(0.0f));
        for_each_lit(bytes, columns, bits_per_pixel(display.format), pixels.shown_bits(),
                     [&](std::uint32_t column, std::uint32_t code) { sent[column] = full * pixels.of(code); });
        (void)exposure.add_row_light(slice, p, row, light);
        for (std::uint32_t column = 0; column < columns; ++column) {
            const bool is_sent = sent[column] != glm::vec3(0.0f);
            const bool is_lit = light[column] != glm::vec3(0.0f);
            if (is_sent) ++histogram.sent[bin_of(sent[column])];
            if (is_lit) ++histogram.lit[bin_of(light[column] / due)];
            histogram.lost += is_sent && !is_lit;
        }
    };
    for_each_row(display, page.empty() ? dark : page, count);
    return histogram;
}

std::string to_csv(const LightHistogram& histogram) {
    std::string csv = "from,to,sent,lit\n";
    for (std::size_t bin = 0; bin < LightHistogram::kBins; ++bin) {
        const double from = static_cast<double>(bin) * LightHistogram::kBinWidth;
        const bool last = bin + 1 == LightHistogram::kBins;
        const std::string to = last ? "inf" : fmt::format("{:.2f}", from + LightHistogram::kBinWidth);
        fmt::format_to(std::back_inserter(csv), "{:.2f},{},{},{}\n", from, to, histogram.sent[bin], histogram.lit[bin]);
    }
    return csv;
}

Image draw_chart(const LightHistogram& histogram) {
    Canvas canvas(kWidth, kHeight, kPaper);
    const Axes axes(std::max(*std::ranges::max_element(histogram.sent), *std::ranges::max_element(histogram.lit)));
    canvas.text({kLeft, 34}, fmt::format("light per voxel: {}, {:.4g} ms", histogram.display, histogram.exposure_ms),
                kInk);
    draw_axes(canvas, axes);
    draw_bars(canvas, axes, histogram);
    draw_legend(canvas, histogram);
    return canvas.image();
}

}  // namespace xorvox::sim
