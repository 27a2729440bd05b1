// Values are those of the files, so neighbouring ones are found by the precision of the less precise side.
#include "compare/suite/exact.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "compare/renders.h"

namespace crescent {

namespace {

/// Removes blanks at both ends.
std::string_view stripped(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    return text.substr(begin, text.find_last_not_of(" \t") + 1 - std::min(begin, text.find_last_not_of(" \t") + 1));
}

/// A number of 0 or more, and nothing else.
std::optional<double> number_in(std::string_view text) {
    text = stripped(text);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value) || value < 0) return {};
    return value;
}

/// Counts the steps between values of files.
class Steps {
public:
    Steps(const MeanFilm& a, const MeanFilm& b) : rounding_(std::max(a.rounding, b.rounding)) {
        quantisation_ = a.steps.levels > 0 && a.steps == b.steps ? a.steps : Quantisation{};
    }
    /// Whether both sides have the same whole numbers.
    bool is_whole() const { return quantisation_.levels > 0; }
    double levels() const { return quantisation_.levels; }
    double number_of(double value, bool is_alpha) const {
        return is_alpha ? std::round(value * (quantisation_.levels - 1)) : quantisation_.number_of(value);
    }
    double between(double a, double b, bool is_alpha) const {
        if (is_whole()) return std::fabs(number_of(a, is_alpha) - number_of(b, is_alpha));
        const double larger = std::max(std::fabs(a), std::fabs(b));
        if (larger == 0) return 0;
        const int bits = -std::ilogb(rounding_);  // of the significand: rounding is half an ulp of 1
        constexpr int least_float = -149, least_half = -24, bits_of_half = 11;
        const int exponent = std::max(std::ilogb(larger) + 1 - bits, bits <= bits_of_half ? least_half : least_float);
        return std::fabs(a - b) / std::ldexp(1.0, exponent);
    }

private:
    double rounding_;
    Quantisation quantisation_;
};

/// Whether a pixel is not finite in some render of a side.
bool fails(const ArmStats& arm, std::size_t pixel) { return !arm.not_finite.empty() && arm.not_finite[pixel] > 0; }

}  // namespace

std::optional<Tolerance> parse_tolerance(std::string_view text) {
    text = stripped(text);
    if (text.ends_with("ulp")) {
        const auto size = number_in(text.substr(0, text.size() - 3));
        return size ? std::optional(Tolerance{Tolerance::Unit::ulp, *size}) : std::nullopt;
    }
    if (text.ends_with('%')) {
        const auto size = number_in(text.substr(0, text.size() - 1));
        return size ? std::optional(Tolerance{Tolerance::Unit::percent, *size / 100}) : std::nullopt;
    }
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) return {};
    const auto part = number_in(text.substr(0, slash)), total = number_in(text.substr(slash + 1));
    if (!part || !total || *total == 0) return {};
    return Tolerance{Tolerance::Unit::share, *part / *total};
}

ExactDifference exact_difference(const RenderStats& stats, const std::optional<Tolerance>& tolerance) {
    const MeanFilm &baseline = stats.arms[0].film, &candidate = stats.arms[1].film;
    const Steps steps(baseline, candidate);
    ExactDifference out;
    if (steps.is_whole()) out.step_name = fmt::format("{:g}", steps.levels() - 1);
    const std::size_t first = stats.quantities > 1 ? 1 : 0;  // Y follows from the channels
    constexpr double slack = 1 + 1e-9;                       // "2/255" of values that are themselves rounded
    for (std::size_t i = 0; i < stats.bad.size(); ++i) {
        ++out.pixels;
        if (stats.bad[i]) {
            const bool one_sided = fails(stats.arms[0], i) != fails(stats.arms[1], i);
            out.one_sided += one_sided;
            out.different += one_sided;
            continue;
        }
        bool differs = false, exceeds = false;
        for (std::size_t q = first; q < stats.quantities; ++q) {
            const double b = baseline.of(q).mean[i], c = candidate.of(q).mean[i], difference = std::fabs(c - b);
            if (difference == 0) continue;
            differs = true;
            const bool is_alpha = q == most_quantities - 1;
            const double count = steps.between(b, c, is_alpha), share = b == 0 ? HUGE_VAL : difference / std::fabs(b);
            const double share_of_largest = steps.is_whole() ? count / (steps.levels() - 1) : difference;
            out.share = std::max(out.share, share);
            out.absolute = std::max(out.absolute, difference);
            if (count > out.steps) {
                out.steps = count;
                out.x = static_cast<int>(i) % stats.width;
                out.y = static_cast<int>(i) / stats.width;
            }
            if (!tolerance) continue;
            const double size = tolerance->unit == Tolerance::Unit::ulp ? count
                : tolerance->unit == Tolerance::Unit::percent           ? share
                                                                        : share_of_largest;
            exceeds |= size > tolerance->size * slack;
        }
        out.different += differs;
        out.excess += exceeds;
    }
    return out;
}

}  // namespace crescent
