// Each mark is one SVG element, placed by the axes' shares of the frame. Lines and bands are clipped by an inner <svg>;
// names at the ends of lines are at least 13 pixels apart.
#include "output/charts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "base/text.h"
#include "math/functions.h"
#include "output/format.h"

namespace crescent {

// ---- Linear axes have ticks at 1, 2 or 5 times a power of ten, with four to eight steps; log axes have ticks from the
// row of a table for their length in decades.

double Axis::share(double x) const {
    if (log) return x > 0 ? math::log(x / low) / math::log(high / low) : 0;
    return (x - low) / (high - low);
}

bool Axis::can_hold(double x) const { return std::isfinite(x) && (!log || x > 0); }

double round_up(double value, std::initializer_list<double> leads) {
    const double power = math::pow(10.0, std::floor(math::log10(value)));
    for (const double lead : leads)
        if (lead * power >= value * (1 - 1e-9)) return lead * power;
    return 10 * power;
}

Axis linear_axis(std::string label, const std::vector<double>& values) {
    Axis axis;
    axis.label = std::move(label);
    std::vector<double> finite;
    for (const double v : values)
        if (std::isfinite(v)) finite.push_back(v);
    if (finite.empty()) finite = {0, 1};
    double low = *std::min_element(finite.begin(), finite.end()),
           high = *std::max_element(finite.begin(), finite.end());
    if (high <= low) high = low + std::max(1e-12, std::fabs(low));
    const double step = round_up((high - low) / 8);
    axis.low = step * std::floor(low / step + 1e-9);
    axis.high = step * std::ceil(high / step - 1e-9);
    const int count = static_cast<int>(std::lround((axis.high - axis.low) / step));
    for (int i = 0; i <= count; ++i) {
        const double tick = axis.low + i * step;
        axis.ticks.push_back(std::fabs(tick) < 1e-9 * step ? 0 : tick);
    }
    return axis;
}

Axis log_axis(std::string label, const std::vector<double>& values, double factor) {
    Axis axis;
    axis.label = std::move(label);
    axis.log = true;
    std::vector<double> positive;
    for (const double v : values)
        if (axis.can_hold(v)) positive.push_back(v);
    if (positive.empty()) positive = {1, 10};
    axis.low = *std::min_element(positive.begin(), positive.end()) / factor;
    axis.high = *std::max_element(positive.begin(), positive.end()) * factor;
    axis.ticks = log_ticks(axis.low, axis.high);
    return axis;
}

std::vector<double> log_ticks(double low, double high) {
    struct Row {
        double decades;  // and more
        std::vector<double> leads;
    };
    static const Row rows[] = {
        {3, {1}}, {2, {1, 3}}, {1, {1, 2, 5}}, {0.5, {1, 2, 3, 5, 7}}, {0, {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9}}};
    const double decades = math::log10(high / low);
    const Row& row =
        *std::find_if(std::begin(rows), std::end(rows) - 1, [&](const Row& r) { return decades >= r.decades; });
    std::vector<double> ticks;
    for (int power = static_cast<int>(std::floor(math::log10(low))); math::pow(10.0, power) <= high; ++power)
        for (const double lead : row.leads) {
            const double tick = lead * math::pow(10.0, power);
            if (tick >= low && tick <= high) ticks.push_back(tick);
        }
    return ticks;
}

std::vector<double> moved_apart(const std::vector<double>& places, double pitch, double first, double last) {
    std::vector<std::size_t> order(places.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
    std::vector<double> positions = places;
    double lowest = first, highest = last;
    for (const std::size_t i : order) {
        positions[i] = std::max(positions[i], lowest);
        lowest = positions[i] + pitch;
    }
    for (auto i = order.rbegin(); i != order.rend(); ++i) {
        positions[*i] = std::min(positions[*i], highest);
        highest = positions[*i] - pitch;
    }
    return positions;
}

namespace {

constexpr double left_margin = 58, right_margin = 16, top_margin = 12, bottom_margin = 44;

std::string tick_text(double x, bool log) {
    if (log && x >= 1e4) {
        const int power = static_cast<int>(std::lround(math::log10(x)));
        if (std::fabs(math::pow(10.0, power) / x - 1) < 1e-9)
            return fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", power);
    }
    return fmt::format("{:g}", x);
}

}  // namespace

Chart::Chart(int w, int h, Axis x, Axis y, std::string title)
    : width_(w), height_(h), x_(std::move(x)), y_(std::move(y)), title_(std::move(title)) {}

double Chart::px(double x) const { return left_margin + x_.share(x) * (width_ - left_margin - right_margin); }
double Chart::py(double y) const {
    return height_ - bottom_margin - y_.share(y) * (height_ - top_margin - bottom_margin);
}

void Chart::line(const std::vector<Point>& points, std::string_view css) {
    std::string path;
    for (const Point& p : points)
        if (drawable(p.x, p.y)) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", px(p.x), py(p.y));
    if (!path.empty()) frame_content_ += fmt::format("<path class=\"line {}\" d=\"{}\" />\n", css, path);
}

void Chart::dots(const std::vector<Point>& points, std::string_view css) {
    for (const Point& p : points)
        if (drawable(p.x, p.y))
            body_ += fmt::format(
                "<circle class=\"dot {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\" />\n", css, px(p.x), py(p.y));
}

void Chart::diamonds(const std::vector<Point>& points, std::string_view css) {
    for (const Point& p : points)
        if (drawable(p.x, p.y))
            body_ += fmt::format(
                "<path class=\"diamond {}\" d=\"M{:.1f} {:.1f} l5 5 l-5 5 l-5 -5 z\" />\n", css, px(p.x), py(p.y) - 5);
}

void Chart::band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
    std::string_view css) {
    std::string upper_edge, lower_edge;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!drawable(x[i], low[i]) || !drawable(x[i], high[i])) continue;
        upper_edge += fmt::format("{}{:.1f} {:.1f}", upper_edge.empty() ? "M" : " L", px(x[i]), py(high[i]));
        lower_edge = fmt::format(" L{:.1f} {:.1f}", px(x[i]), py(low[i])) + lower_edge;
    }
    if (!upper_edge.empty())
        frame_content_ += fmt::format("<path class=\"area {}\" d=\"{}{} Z\" />\n", css, upper_edge, lower_edge);
}

void Chart::bar(double x, double low, double high, std::string_view css) {
    if (!drawable(x, low) || !drawable(x, high)) return;
    const double column = px(x), from = py(low), to = py(high);
    body_ += fmt::format(
        "<path class=\"line {}\" d=\"M{:.1f} {:.1f} h8 m-4 0 V{:.1f} m-4 0 h8\" />\n", css, column - 4, from, to);
}

void Chart::rule(double y, std::string_view css, std::string_view name) {
    if (!drawable(x_.low, y)) return;
    body_ += fmt::format(
        "<path class=\"rule {}\" d=\"M{:.1f} {:.1f} H{:.1f}\" />\n", css, left_margin, py(y), width_ - right_margin);
    if (!name.empty())
        body_ += fmt::format("<text class=\"name {}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", css,
            width_ - right_margin - 3, py(y) - 5, escape(name));
}

void Chart::name(Point point, std::string_view text, std::string_view css) {
    if (!drawable(point.x, point.y)) return;
    names_.push_back({px(point.x) + 8, py(point.y) + 4, escape(text), std::string(css)});
}

std::string Chart::names() const {
    constexpr double line = 13;
    std::vector<double> y;
    for (const Name& name : names_) y.push_back(name.y);
    y = moved_apart(y, line, 0, height_ - bottom_margin + 4);
    std::string out;
    for (std::size_t i = 0; i < names_.size(); ++i)
        out += fmt::format("<text class=\"name {}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", names_[i].css, names_[i].x,
            y[i], names_[i].text);
    return out;
}

std::string Chart::axes() const {
    const double bottom = height_ - bottom_margin, right = width_ - right_margin;
    std::string out;
    for (const double t : x_.ticks)
        out += fmt::format(
            "<path class=\"grid\" d=\"M{0:.1f} {1:.1f} V{2:.1f}\" /><text class=\"tick\" x=\"{0:.1f}\" "
            "y=\"{3:.1f}\" text-anchor=\"middle\">{4}</text>\n",
            px(t), bottom, top_margin, bottom + 16, tick_text(t, x_.log));
    for (const double t : y_.ticks)
        out += fmt::format(
            "<path class=\"grid\" d=\"M{0:.1f} {1:.1f} H{2:.1f}\" /><text class=\"tick\" x=\"{3:.1f}\" "
            "y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
            left_margin, py(t), right, left_margin - 7, py(t) + 4, tick_text(t, y_.log));
    out += fmt::format(
        "<path class=\"axis\" d=\"M{:.1f} {:.1f} V{:.1f} H{:.1f}\" />\n", left_margin, top_margin, bottom, right);
    out += fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
        (left_margin + right) / 2, height_ - 8, escape(x_.label));
    const double middle = (top_margin + bottom) / 2;
    return out +
        fmt::format(
            "<text class=\"label\" transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            middle, escape(y_.label));
}

std::string Chart::framed() const {  // an inner svg hides what is outside
    const double w = width_ - left_margin - right_margin, h = height_ - top_margin - bottom_margin;
    return fmt::format(
        "<svg x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" viewBox=\"{0} {1} {2} {3}\">\n{4}</svg>\n", left_margin,
        top_margin, w, h, frame_content_);
}

std::string Chart::str() const {
    return fmt::format(
        "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n<title>{}</title>\n{}{}</svg>\n",
        width_, height_, escape(title_), escape(title_), axes(), framed() + body_ + names());
}

std::string strip_svg(const Strip& s) {
    constexpr double w = 132, h = 18, margin = 8, middle = h / 2;
    std::vector<double> values{s.median, s.measured};
    if (s.bar) values.insert(values.end(), {s.q05, s.q95});
    if (s.has_published) values.push_back(s.published);
    for (const double v : values)
        if (!std::isfinite(v)) return {};
    const double low = *std::min_element(values.begin(), values.end()),
                 high = *std::max_element(values.begin(), values.end());
    const auto position = [&](double v) {
        return high > low ? margin + (v - low) / (high - low) * (w - 2 * margin) : w / 2;
    };
    std::string marks = fmt::format("<path class=\"grid\" d=\"M0 {} H{}\" />", middle, w);
    if (s.bar)
        marks += fmt::format("<rect class=\"reach\" x=\"{:.1f}\" y=\"4.5\" width=\"{:.1f}\" height=\"9\" />",
            position(s.q05), std::max(1.0, position(s.q95) - position(s.q05)));
    marks += fmt::format("<path class=\"median\" d=\"M{:.1f} 2 V16\" />", position(s.median));
    if (s.has_published)
        marks +=
            fmt::format("<path class=\"diamond pub\" d=\"M{:.1f} 4 l5 5 l-5 5 l-5 -5 z\" />", position(s.published));
    marks += fmt::format("<circle class=\"dot meas\" cx=\"{:.1f}\" cy=\"9\" r=\"3\" />", position(s.measured));
    std::string words = fmt::format("median {}, measured {}", figures(s.median), figures(s.measured));
    if (s.bar) words += fmt::format(", 5 to 95 % from {} to {}", figures(s.q05), figures(s.q95));
    if (s.has_published) words += fmt::format(", published {}", figures(s.published));
    return fmt::format(
        "<svg class=\"strip\" viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"{}\">{}</svg>",
        w, h, w, h, words, marks);
}

}  // namespace crescent
