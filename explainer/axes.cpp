// Round values are 1, 2 or 5 times a power of ten apart; powers of ten above 100 and below 0.01 are set as 10^k.
// Lengths in units of the sheet.
#include "axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "style.h"

namespace crescent::film {

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

std::vector<Tick> round_values(const Axis& axis, int most) {
    const double step = round_up((axis.high - axis.low) / most);
    std::vector<Tick> out;
    const int first = static_cast<int>(std::ceil(axis.low / step - 1e-9));
    for (int k = first; k * step <= axis.high * (1 + 1e-9); ++k) out.push_back(tick(k * step, 3));
    return out;
}

std::vector<Tick> values(const std::vector<double>& at, int digits) {
    std::vector<Tick> out;
    for (const double v : at) out.push_back(tick(v, digits));
    return out;
}

void Axes::draw(Frame& f, const std::vector<Tick>& below, const std::vector<Tick>& left, const Words& across_name,
    const Words& up_name, double alpha) const {
    constexpr double room = 150, line = 36;
    f.line({box.x, box.y}, {box.x, box.bottom()}, muted, 2, alpha);
    f.line({box.x, box.bottom()}, {box.right(), box.bottom()}, muted, 2, alpha);
    for (const Tick& t : below) {
        const double at = x(t.at);
        f.line({at, box.bottom()}, {at, box.bottom() + 10}, muted, 2, alpha);
        f.text({at - room / 2, box.bottom() + 12, room, line}, t.words, with(small_text, Align::centre), alpha);
    }
    for (const Tick& t : left) {
        const double at = y(t.at);
        f.line({box.x - 10, at}, {box.x, at}, muted, 2, alpha);
        f.text({box.x - 18 - room, at - line / 2, room, line}, t.words, with(small_text, Align::right), alpha);
    }
    f.text({box.x, box.bottom() + 52, box.w, line}, across_name, with(small_text, Align::centre), alpha);
    f.text({box.x - 110, box.y - 58, box.w + 110, line}, up_name, small_text, alpha);
}

}  // namespace crescent::film
