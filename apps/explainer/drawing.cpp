// Pictures are enlarged a whole number of times, at most 12; image boxes count rows from the bottom, blocks from the
// top. Residuals in W/(sr m^2); a plot's lines are at 1, 2 and 5 times powers of ten.
#include "drawing.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace crescent::explainer {

Closeup close_up(const Data& data, const Box& box, const Rect& slot, double margin) {
    const auto times_for = [&](double w, double h) {
        return std::clamp(static_cast<int>(std::min(slot.w / w, slot.h / h)), 1, 12);
    };
    Closeup c;
    c.times = times_for(margin * box.width(), margin * box.height());
    c.box = around(data, box, static_cast<int>(slot.w) / c.times, static_cast<int>(slot.h) / c.times);
    c.times = times_for(c.box.width(), c.box.height());
    return c;
}

Closeup whole_or_part(const Data& data, const Rect& slot) {
    const Image& image = data.experiment.image;
    if (image.width > slot.w || image.height > slot.h) return close_up(data, data.box(data.cast.highlight), slot, 1e6);
    return close_up(data, {0, 0, image.width - 1, image.height - 1}, slot, 1);
}

Rect show(Frame& f, const Block& block, int times, const Rect& slot, double alpha) {
    return f.picture(block, std::floor(slot.x + (slot.w - double(block.width) * times) / 2), slot.y, times, alpha);
}

Rect on_picture(const Rect& r, const Box& visible_box, const Box& box) {
    const double times = r.w / visible_box.width();
    return {r.x + double(box.x0 - visible_box.x0) * times, r.y + double(visible_box.y1 - box.y1) * times,
        double(box.width()) * times, double(box.height()) * times};
}

void mark(Frame& f, const Rect& r, Colour ink, double alpha) {
    f.outline(r.inset(-2), {0, 0, 0, 0.7}, 8, alpha);
    f.outline(r.inset(-2), ink, 4, alpha);
}

void tag(Frame& f, Point corner, const Words& words, Colour ink, double alpha) {
    Text style = with(with(with(label_text, ground), Align::centre), Weight::semibold);
    const double w = f.measure(words, style).w + 28, h = 48;
    const Rect box{corner.x, corner.y - h, w, h};
    f.fill(box, ink, alpha);
    f.text(box.inset(2), words, style, alpha);
}

std::vector<double> residuals(const Film& film, const ReferenceFilm& reference, const Box& box) {
    std::vector<double> out;
    for (int y = box.y1; y >= box.y0; --y) {
        for (int x = box.x0; x <= box.x1; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(film.width) + std::size_t(x);
            out.push_back(std::abs(double(film.y[i]) - double(reference.y[i])));
        }
    }
    return out;
}

Block residual_of(const Film& film, const ReferenceFilm& reference, const Box& box, double top) {
    Block block(box.width(), box.height());
    const std::vector<double> values = residuals(film, reference, box);
    for (int j = 0; j < box.height(); ++j)
        for (int i = 0; i < box.width(); ++i)
            block.set(i, j, turbo(values[std::size_t(j) * std::size_t(box.width()) + std::size_t(i)] / top));
    return block;
}

Point LogPlot::at(double x, double y) const {
    const double u = math::log(x / x0) / math::log(x1 / x0), v = math::log(y / y0) / math::log(y1 / y0);
    return {plot.x + plot.w * u, plot.bottom() - plot.h * v};
}

void LogPlot::axes(
    Frame& f, const std::vector<std::uint64_t>& x_ticks, const Words& x_name, const Words& y_name, double alpha) const {
    f.line({plot.x, plot.bottom()}, {plot.right(), plot.bottom()}, muted, 2, alpha);
    f.line({plot.x, plot.y}, {plot.x, plot.bottom()}, muted, 2, alpha);
    const Text x_style = with(small_text, Align::centre), y_style = with(small_text, Align::right);
    for (const std::uint64_t n : x_ticks) {
        const Point p = at(double(n), y0);
        f.line({p.x, p.y}, {p.x, p.y + 8}, muted, 2, alpha);
        f.text({p.x - 60, p.y + 12, 120, 36}, Words(count(n, "axis")), x_style, alpha);
    }
    for (const double v : log_ticks(y0, y1)) {
        const Point p = at(x0, v);
        f.line({p.x, p.y}, {plot.right(), p.y}, rule, 1, alpha);
        f.text({p.x - 130, p.y - 18, 116, 36}, Words(number(v, 3, "axis")), y_style, alpha);
    }
    f.text({plot.x + 10, plot.bottom() + 48, plot.w - 10, 40}, x_name, with(small_text, Align::right), alpha);
    f.text({plot.x - 120, plot.y - 56, plot.w, 42}, y_name, with(label_text, Weight::semibold), alpha);
}

std::vector<Point> begun(const std::vector<Point>& path, double part) {
    double length = 0;
    for (std::size_t k = 1; k < path.size(); ++k)
        length += math::hypot(path[k].x - path[k - 1].x, path[k].y - path[k - 1].y);
    double remainder = part * length;
    std::vector<Point> out;
    for (std::size_t k = 0; k < path.size(); ++k) {
        if (k == 0) {
            out.push_back(path[0]);
            continue;
        }
        const Point a = path[k - 1], b = path[k];
        const double step = math::hypot(b.x - a.x, b.y - a.y);
        if (step >= remainder) {
            if (step > 0) out.push_back({a.x + (b.x - a.x) * remainder / step, a.y + (b.y - a.y) * remainder / step});
            break;
        }
        out.push_back(b);
        remainder -= step;
    }
    return out;
}

Rect column_of(double x, double w, double gap, std::size_t k) {
    return {x + double(k) * (w + gap), stage.y, w, stage.h};
}

Order order_of(const Data& data, const RunKey& a, const RunKey& b, const std::string& region) {
    const RegionMetrics *ra = data.region(a, region), *rb = data.region(b, region);
    ensure(ra && rb, "the film compares runs that were made");
    return ra->rmse <= rb->rmse ? Order{a, b, ra->rmse, rb->rmse} : Order{b, a, rb->rmse, ra->rmse};
}

// ---- Round values are 1, 2 or 5 times a power of ten; powers of ten above 100 and below 0.01 are set as 10^k. Lengths
// in units of the sheet.

namespace {

const char* const axis_source = "a mark on an axis";

Tick tick(double v, int digits) { return {v, Words(number(v, digits, axis_source))}; }

}  // namespace

std::vector<Tick> decades(const Axis& axis, int step) {
    std::vector<Tick> out;
    const int first = static_cast<int>(std::ceil(math::log10(axis.low) - 1e-9));
    const int last = static_cast<int>(std::floor(math::log10(axis.high) + 1e-9));
    for (int k = first; k <= last; ++k) {
        const double v = math::pow(10.0, k);
        if ((k - first) % step != 0) out.push_back({v, {}});
        else if (std::abs(k) <= 2) out.push_back(tick(v, 3));
        else
            out.push_back(
                {v, Words(Number{fmt::format("10<sup>{}{}</sup>", k < 0 ? "−" : "", std::abs(k)), axis_source})});
    }
    return out;
}

std::vector<Tick> round_values(const Axis& axis, int limit) {
    const double step = round_up((axis.high - axis.low) / limit);
    std::vector<Tick> out;
    const int first = static_cast<int>(std::ceil(axis.low / step - 1e-9));
    for (int k = first; k * step <= axis.high * (1 + 1e-9); ++k) out.push_back(tick(k * step, 3));
    return out;
}

std::vector<Tick> values(const std::vector<double>& positions, int digits) {
    std::vector<Tick> out;
    for (const double v : positions) out.push_back(tick(v, digits));
    return out;
}

void Axes::draw(Frame& f, const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks, const Words& x_name,
    const Words& y_name, double alpha) const {
    constexpr double room = 150, line = 36;
    f.line({box.x, box.y}, {box.x, box.bottom()}, muted, 2, alpha);
    f.line({box.x, box.bottom()}, {box.right(), box.bottom()}, muted, 2, alpha);
    for (const Tick& t : x_ticks) {
        const double position = x(t.position);
        f.line({position, box.bottom()}, {position, box.bottom() + 10}, muted, 2, alpha);
        f.text({position - room / 2, box.bottom() + 12, room, line}, t.words, with(small_text, Align::centre), alpha);
    }
    for (const Tick& t : y_ticks) {
        const double position = y(t.position);
        f.line({box.x - 10, position}, {box.x, position}, muted, 2, alpha);
        f.text({box.x - 18 - room, position - line / 2, room, line}, t.words, with(small_text, Align::right), alpha);
    }
    f.text({box.x, box.bottom() + 52, box.w, line}, x_name, with(small_text, Align::centre), alpha);
    f.text({box.x - 110, box.y - 58, box.w + 110, line}, y_name, small_text, alpha);
}

}  // namespace crescent::explainer
