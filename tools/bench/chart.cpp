#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sim/canvas.h"
#include "tools/bench/result.h"

namespace xorvox::tools {
namespace {

using sim::Canvas;
using sim::Color;
using sim::Dashes;
using sim::text_height;
using sim::text_width;

constexpr Color kPaper{255, 255, 255};
constexpr Color kInk{40, 40, 40};
constexpr Color kGrid{225, 225, 225};
constexpr Color kGuide{170, 170, 170};
/// Okabe and Ito's, which people of all colour visions can tell apart; without their yellow, too pale for lines.
constexpr std::array<Color, 7> kColors{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}, {0, 0, 0}}};
constexpr double kDashed[] = {9.0, 6.0};
constexpr double kDotted[] = {2.0, 5.0};

constexpr int kPanelWidth = 620;
constexpr int kPanelHeight = 620;
constexpr int kLeft = 90;  ///< From a panel's left side to its axis.
constexpr int kRight = 40;
constexpr int kTop = 70;
constexpr int kBottom = 70;
constexpr int kLegendRow = 34;
constexpr int kLegendGap = 36;
constexpr int kSample = 44;  ///< A line in the legend.
constexpr int kLabelGap = 8;

/// What a line or spot means: its model, method and number of threads as places in lists.
struct Style {
    std::size_t model = 0;
    std::size_t method = 0;
    std::size_t threads = 0;
};

template <class T>
std::size_t place_of(std::vector<T>& list, const T& value) {
    const auto found = std::ranges::find(list, value);
    if (found != list.end()) return static_cast<std::size_t>(found - list.begin());
    list.push_back(value);
    return list.size() - 1;
}

std::string whole_number(double number) {
    return fmt::format("{:.0f}", number);
}

/// 20000 as "20k".
std::string short_number(double number) {
    if (number >= 1e9) return fmt::format("{:g}G", number / 1e9);
    if (number >= 1e6) return fmt::format("{:g}M", number / 1e6);
    if (number >= 1e3) return fmt::format("{:g}k", number / 1e3);
    return fmt::format("{:g}", number);
}

/// The range of a logarithmic axis, and where a value stands on it.
class LogAxis {
public:
    void include(double value) {
        if (value <= 0.0) return;
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }
    /// The axis is there for `length` pixels: room on both sides, and at least a decade.
    void lay_out(double length) {
        if (low_ > high_) low_ = high_ = 1.0;  // no values
        const double room = std::max(1.25, std::sqrt(10.0 * low_ / high_));
        low_ /= room;
        high_ *= room;
        length_ = length;
    }
    double low() const { return low_; }
    double high() const { return high_; }
    bool has(double value) const { return value >= low_ && value <= high_; }
    /// Values that no logarithm has stand at the axis' beginning.
    double at(double value) const {
        return length_ * std::log10(std::max(value, low_) / low_) / std::log10(high_ / low_);
    }
    /// 1, 10, 100 … and, where there is room, 2, 20 … and 5, 50 … .
    std::vector<double> ticks() const {
        const double decade = length_ / std::log10(high_ / low_);
        std::vector<double> ticks;
        for (double power = std::pow(10.0, std::floor(std::log10(low_))); power <= high_; power *= 10.0) {
            for (const double step : {1.0, 2.0, 5.0}) {
                if (has(power * step) && (step == 1.0 || decade > 180.0)) ticks.push_back(power * step);
            }
        }
        return ticks;
    }

private:
    double low_ = 1e300;
    double high_ = 1e-300;
    double length_ = 1.0;
};

/// Axes with lines between them, at a place of the canvas.
class Panel {
public:
    Panel(Canvas& canvas, int number, LogAxis x, LogAxis y)
        : canvas_(canvas), left_(number * kPanelWidth), x_(x), y_(y) {
        x_.lay_out(kPanelWidth - kLeft - kRight);
        y_.lay_out(kPanelHeight - kTop - kBottom);
    }

    /// Ascending ticks; their labels are left out where they would touch the one before.
    void frame(std::string_view title, std::string_view subtitle, std::string_view x_title,
               std::span<const double> x_ticks, std::string (*x_label)(double)) {
        canvas_.text({left_ + kLeft, 22}, title, kInk);
        canvas_.text({left_ + kLeft, 42}, subtitle, kInk);
        canvas_.text({left_ + 16, 56}, "ms", kInk);
        double taken = left_;  // By labels, up to here.
        for (const double tick : x_ticks) {
            const glm::dvec2 foot = at(tick, y_.low());
            canvas_.line(foot, at(tick, y_.high()), 1.0, kGrid);
            const std::string label = x_label(tick);
            const double half = 0.5 * text_width(label);
            if (foot.x - half < taken + kLabelGap) continue;
            centered(label, foot + glm::dvec2(0.0, 12 + text_height()));
            taken = foot.x + half;
        }
        for (const double tick : y_.ticks()) {
            const glm::dvec2 foot = at(x_.low(), tick);
            canvas_.line(foot, at(x_.high(), tick), 1.0, kGrid);
            const std::string label = short_number(tick);
            canvas_.text(glm::ivec2(foot) + glm::ivec2(-10 - text_width(label), text_height() / 2), label, kInk);
        }
        const glm::dvec2 corners[] = {at(x_.low(), y_.high()), at(x_.low(), y_.low()), at(x_.high(), y_.low())};
        canvas_.line(corners, 1.5, kInk);
        centered(x_title, {left_ + (kLeft + kPanelWidth - kRight) / 2, kPanelHeight - 14});
    }

    /// A grey line of growth by `power` through a value, as far as it is in the panel.
    void guide(double power, glm::dvec2 through, std::string_view label) {
        if (through.x <= 0.0 || through.y <= 0.0) return;
        const auto x_for = [&](double y) { return through.x * std::pow(y / through.y, 1.0 / power); };
        const double xs[] = {std::max(x_.low(), x_for(y_.low())), std::min(x_.high(), x_for(y_.high()))};
        std::vector<glm::dvec2> ends;
        for (const double x : xs) ends.push_back(at(x, through.y * std::pow(x / through.x, power)));
        canvas_.line(ends, 1.5, kGuide, kDashed);
        const glm::dvec2 corner = at(x_.high(), y_.high());
        canvas_.text(glm::ivec2(corner) + glm::ivec2(-text_width(label), -8), label, kGuide);
    }

    void line(std::span<const glm::dvec2> values, Color color, Dashes dashes = {}) {
        std::vector<glm::dvec2> points;
        for (const glm::dvec2& value : values) points.push_back(at(value.x, value.y));
        canvas_.line(points, 2.0, color, dashes);
    }
    glm::dvec2 at(double x, double y) const { return {left_ + kLeft + x_.at(x), kPanelHeight - kBottom - y_.at(y)}; }
    const LogAxis& x() const { return x_; }

private:
    void centered(std::string_view text, glm::dvec2 foot) {
        canvas_.text(glm::ivec2(foot) - glm::ivec2(text_width(text) / 2, 0), text, kInk);
    }

    Canvas& canvas_;
    int left_;
    LogAxis x_;
    LogAxis y_;
};

/// A shape for each round of colours, full, hollow or with a hole by the number of threads.
void spot(Canvas& canvas, glm::dvec2 at, const Style& style, Color color) {
    const auto draw = [&](double radius, Color ink) {
        switch (style.model / kColors.size() % 3) {
            case 0: return canvas.disc(at, radius, ink);
            case 1: return canvas.square(at, radius, ink);
            default: return canvas.diamond(at, 1.4 * radius, ink);
        }
    };
    draw(5.0, color);
    if (style.threads % 3 == 1) draw(3.2, kPaper);
    if (style.threads % 3 == 2) draw(1.8, kPaper);
}

Dashes dashes_of(std::size_t method) {
    if (method % 3 == 0) return {};
    return method % 3 == 1 ? Dashes(kDashed) : Dashes(kDotted);
}

Color color_of(std::size_t model) {
    return kColors[model % kColors.size()];
}

using Value = std::function<double(const BenchResult&)>;
constexpr auto kTime = [](const BenchResult& r) { return r.ms; };

class Chart {
public:
    explicit Chart(std::span<const BenchResult> results) : results_(results) {
        for (const BenchResult& r : results_) {
            styles_.push_back(
                {place_of(models_, r.model), place_of(methods_, r.method), place_of(threads_, r.threads)});
            place_of(sizes_, r.size);
        }
        std::ranges::sort(sizes_);
    }

    sim::Image draw() {
        const int rows = place_legend(nullptr);
        Canvas canvas(3 * kPanelWidth, static_cast<std::uint32_t>(kPanelHeight + rows * kLegendRow + 10), kPaper);
        draw_sizes(canvas);
        const std::string first = fmt::format("{}, {} thread{}", methods_[0], threads_[0], threads_[0] == 1 ? "" : "s");
        draw_triangles(canvas, first);
        draw_surface(canvas, first);
        place_legend(&canvas);
        return canvas.image();
    }

private:
    bool is_first(std::size_t i) const { return styles_[i].method == 0 && styles_[i].threads == 0; }

    /// The axis of a value of the first method and number of threads, or of all.
    LogAxis axis_of(const Value& value, bool first_only) const {
        LogAxis axis;
        for (std::size_t i = 0; i < results_.size(); ++i) {
            if (is_first(i) || !first_only) axis.include(value(results_[i]));
        }
        return axis;
    }

    /// Where guides go through: the longest time of the first method and number of threads.
    glm::dvec2 slowest(const Value& x) const {
        const BenchResult* slowest = &results_[0];
        for (std::size_t i = 0; i < results_.size(); ++i) {
            if (is_first(i) && results_[i].ms > slowest->ms) slowest = &results_[i];
        }
        return {x(*slowest), slowest->ms};
    }

    /// Lines through the results that `is_of` takes, sorted along x, with their spots.
    void series(Canvas& canvas, Panel& panel, const Value& x, const std::function<bool(std::size_t)>& is_of,
                Color color, Dashes dashes) {
        std::vector<std::pair<glm::dvec2, Style>> points;
        for (std::size_t i = 0; i < results_.size(); ++i) {
            if (is_of(i) && x(results_[i]) > 0.0) points.push_back({{x(results_[i]), results_[i].ms}, styles_[i]});
        }
        std::ranges::sort(points, {}, [](const auto& point) { return point.first.x; });
        std::vector<glm::dvec2> values;
        for (const auto& point : points) values.push_back(point.first);
        panel.line(values, color, dashes);
        for (const auto& [value, style] : points) {
            spot(canvas, panel.at(value.x, value.y), style, color_of(style.model));
        }
    }

    void draw_sizes(Canvas& canvas) {
        const Value size = [](const BenchResult& r) { return r.size; };
        Panel panel(canvas, 0, axis_of(size, false), axis_of(kTime, false));
        panel.frame("time against size", "", "samples a side", std::vector<double>(sizes_.begin(), sizes_.end()),
                    whole_number);
        panel.guide(2.0, slowest(size), "- - as the square of size");
        for (std::size_t model = 0; model < models_.size(); ++model) {
            for (std::size_t method = 0; method < methods_.size(); ++method) {
                for (std::size_t threads = 0; threads < threads_.size(); ++threads) {
                    const auto is_of = [&](std::size_t i) {
                        return styles_[i].model == model && styles_[i].method == method &&
                               styles_[i].threads == threads;
                    };
                    series(canvas, panel, size, is_of, color_of(model), dashes_of(method));
                }
            }
        }
    }

    /// Of the first method and number of threads, from the fewest triangles to the most.
    std::vector<const BenchResult*> by_triangles(std::uint32_t size) const {
        std::vector<const BenchResult*> found;
        for (std::size_t i = 0; i < results_.size(); ++i) {
            if (is_first(i) && results_[i].size == size) found.push_back(&results_[i]);
        }
        std::ranges::sort(found, {}, &BenchResult::triangles);
        return found;
    }

    void draw_triangles(Canvas& canvas, const std::string& first) {
        const Value triangles = [](const BenchResult& r) { return static_cast<double>(r.triangles); };
        LogAxis x = axis_of(triangles, true);
        x.include(x.low() * std::pow(x.low() / x.high(), 0.15));  // room for the labels
        Panel panel(canvas, 1, x, axis_of(kTime, true));
        panel.frame("time against triangles", first, "triangles", panel.x().ticks(), short_number);
        const BenchResult& most = *by_triangles(sizes_.front()).back();
        panel.guide(1.0, {triangles(most), most.ms}, "- - in proportion");
        std::vector<double> heights;  // Of labels.
        for (const std::uint32_t size : sizes_) {
            const auto is_of = [&](std::size_t i) { return is_first(i) && results_[i].size == size; };
            series(canvas, panel, triangles, is_of, kGuide, {});
            const BenchResult& fewest = *by_triangles(size).front();
            const glm::dvec2 start = panel.at(triangles(fewest), fewest.ms);
            const auto touches = [&](double y) { return std::abs(start.y - y) < text_height() + 4; };
            if (std::ranges::any_of(heights, touches)) continue;
            heights.push_back(start.y);
            const std::string label = std::to_string(size);
            canvas.text(glm::ivec2(start) + glm::ivec2(-10 - text_width(label), text_height() / 2), label, kInk);
        }
    }

    void draw_surface(Canvas& canvas, const std::string& first) {
        const Value surface = [](const BenchResult& r) { return static_cast<double>(r.surface); };
        Panel panel(canvas, 2, axis_of(surface, true), axis_of(kTime, true));
        panel.frame("time against surface", first, "surface voxels", panel.x().ticks(), short_number);
        panel.guide(1.0, slowest(surface), "- - in proportion");
        for (std::size_t model = 0; model < models_.size(); ++model) {
            const auto is_of = [&](std::size_t i) { return is_first(i) && styles_[i].model == model; };
            series(canvas, panel, surface, is_of, color_of(model), {});
        }
    }

    /// Draws the legend, on a canvas if there is one; the number of its rows.
    int place_legend(Canvas* canvas) const {
        glm::ivec2 at(kLeft, kPanelHeight + kLegendRow - 6);
        int rows = 1;
        const auto entry = [&](const std::string& label, const std::function<void(Canvas&, glm::dvec2)>& sample) {
            const int width = kSample + 10 + text_width(label);
            if (at.x > kLeft && at.x + width > 3 * kPanelWidth - kRight) {
                at = {kLeft, at.y + kLegendRow};
                ++rows;
            }
            if (canvas != nullptr) {
                sample(*canvas, glm::dvec2(at) - glm::dvec2(0.0, 0.5 * text_height()));
                canvas->text(at + glm::ivec2(kSample + 10, 0), label, kInk);
            }
            at.x += width + kLegendGap;
        };
        const auto stroke = [](Color color, Dashes dashes) {
            return [=](Canvas& c, glm::dvec2 left) {
                const glm::dvec2 ends[] = {left, left + glm::dvec2(kSample, 0.0)};
                c.line(ends, dashes.empty() ? 3.0 : 2.0, color, dashes);
            };
        };
        for (std::size_t i = 0; i < models_.size(); ++i) {
            entry(models_[i], [&stroke, i](Canvas& c, glm::dvec2 left) {
                stroke(color_of(i), {})(c, left);
                spot(c, left + glm::dvec2(0.5 * kSample, 0.0), {.model = i}, color_of(i));
            });
        }
        for (std::size_t i = 0; i < methods_.size(); ++i) entry(methods_[i], stroke(kInk, dashes_of(i)));
        for (std::size_t i = 0; i < threads_.size(); ++i) {
            entry(fmt::format("{} thread{}", threads_[i], threads_[i] == 1 ? "" : "s"),
                  [i](Canvas& c, glm::dvec2 left) {
                      spot(c, left + glm::dvec2(0.5 * kSample, 0.0), {.threads = i}, kInk);
                  });
        }
        return rows;
    }

    std::span<const BenchResult> results_;
    std::vector<Style> styles_;
    std::vector<std::string> models_;
    std::vector<std::string> methods_;
    std::vector<unsigned> threads_;
    std::vector<std::uint32_t> sizes_;
};

}  // namespace

sim::Image bench_chart(std::span<const BenchResult> results) {
    return Chart(results).draw();
}

}  // namespace xorvox::tools
