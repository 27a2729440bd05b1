// An exponent follows by least squares of logarithms, its trimmed tenth left out; what counts is how many ratios agree
// with the simple exponent next to it.
#include "check/explain/ratios.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "math/functions.h"

namespace crescent::check {

namespace {

/// A ratio agrees if it is off by less than this and than a tenth of how far the ratios are from 1 at most, beside its
/// own error: of what is nearly constant much looks alike.
constexpr double agrees = 2e-3, part_that_agrees = 0.1, most_agree = 0.9, to_half = 0.05;
constexpr std::size_t fewest_ratios = 40;

double median(std::vector<double> v) {
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
}

/// The slope of y over x, twice without the tenth that is furthest off.
double slope_of(std::vector<std::pair<double, double>> points) {
    double slope = 0;
    for (int round = 0; round < 3; ++round) {
        const double n = static_cast<double>(points.size());
        double x = 0, y = 0, xx = 0, xy = 0;
        for (const auto& [a, b] : points) x += a / n, y += b / n;
        for (const auto& [a, b] : points) xx += (a - x) * (a - x), xy += (a - x) * (b - y);
        if (!(xx > 1e-6 * n)) return 0;
        slope = xy / xx;
        const auto off = [&](const auto& p) { return std::fabs(p.second - y - slope * (p.first - x)); };
        std::ranges::sort(points, {}, off);
        points.resize(points.size() * 9 / 10);
    }
    return slope;
}

/// ln ratio = ln constant + exponent x: the constant, and the share that agrees.
RatioCause agreeing(const std::vector<double>& logs, const std::vector<double>& x, double exponent, double close,
    std::span<const KnownRatio> ratios) {
    std::vector<double> rest;
    for (std::size_t i = 0; i < logs.size(); ++i) rest.push_back(logs[i] - exponent * x[i]);
    double middle = median(rest), near = 0;
    if (std::fabs(middle) < close / 2) middle = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) near += std::fabs(rest[i] - middle) < close + 2 * ratios[i].error;
    return {"", exponent, math::exp(middle), near / static_cast<double>(rest.size())};
}

}  // namespace

std::optional<RatioCause> explain_ratios(std::span<const KnownRatio> ratios, std::span<const Factor> factors) {
    std::vector<double> logs;
    for (const KnownRatio& r : ratios) logs.push_back(r.value > 0 && std::isfinite(r.value) ? math::log(r.value) : 1e3);
    if (logs.size() < fewest_ratios) return {};
    if (2 * std::ranges::count_if(logs, [](double v) { return std::fabs(v) < same_number; }) >
        static_cast<std::ptrdiff_t>(logs.size()))
        return {};
    std::vector<double> sizes;
    for (double v : logs) sizes.push_back(std::fabs(v));
    const double close = std::min(agrees, part_that_agrees * median(sizes));
    RatioCause best = agreeing(logs, logs, 0, close, ratios);
    best.name = "constant";
    if (best.explained >= most_agree) return best;
    bool several = false;
    for (const Factor& f : factors) {
        std::vector<double> x;
        std::vector<std::pair<double, double>> points;
        for (std::size_t i = 0; i < ratios.size(); ++i) {
            const double g = f.value(ratios[i].wo, ratios[i].wi);
            x.push_back(g > 0 ? math::log(g) : 1e3);
            if (g > 0 && logs[i] < 100) points.emplace_back(x[i], logs[i]);
        }
        if (points.size() < fewest_ratios) continue;
        const double b = slope_of(std::move(points)), simple = std::round(2 * b) / 2;
        if (simple == 0 || std::fabs(b - simple) > to_half) continue;
        RatioCause with = agreeing(logs, x, simple, close, ratios);
        if (with.explained < most_agree) continue;
        with.name = f.name;
        several = best.explained >= most_agree && with.explained > best.explained - 0.02;
        if (with.explained > best.explained + 0.02 || best.explained < most_agree) best = with;
    }
    return best.explained >= most_agree && !several ? std::optional(best) : std::nullopt;
}

}  // namespace crescent::check
