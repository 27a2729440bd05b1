// Linear axes tick at 1, 2 or 5 times a power of ten, four to eight steps long. Log axes tick at those numbers of a
// table that its row for their length in decades has.
#include "pages/axis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/functions.h"

namespace crescent::inline pages {

double Axis::share(double x) const {
    if (log) return x > 0 ? math::log(x / low) / math::log(high / low) : 0;
    return (x - low) / (high - low);
}

bool Axis::can_hold(double x) const { return std::isfinite(x) && (!log || x > 0); }

double round_up(double least, std::initializer_list<double> leads) {
    const double power = math::pow(10.0, std::floor(math::log10(least)));
    for (const double lead : leads)
        if (lead * power >= least * (1 - 1e-9)) return lead * power;
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

Axis log_axis(std::string label, const std::vector<double>& values, double wider) {
    Axis axis;
    axis.label = std::move(label);
    axis.log = true;
    std::vector<double> positive;
    for (const double v : values)
        if (axis.can_hold(v)) positive.push_back(v);
    if (positive.empty()) positive = {1, 10};
    axis.low = *std::min_element(positive.begin(), positive.end()) / wider;
    axis.high = *std::max_element(positive.begin(), positive.end()) * wider;
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
    std::vector<double> moved = places;
    double least = first, most = last;
    for (const std::size_t i : order) moved[i] = std::max(moved[i], least), least = moved[i] + pitch;
    for (auto i = order.rbegin(); i != order.rend(); ++i)
        moved[*i] = std::min(moved[*i], most), most = moved[*i] - pitch;
    return moved;
}

}  // namespace crescent::inline pages
