// Draws on a curve: the derivatives of sample(u) with respect to all of its numbers are parallel. A density over solid
// angle then cannot be right, for any value that it has.
#include "check/decide/curve.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/decide/small_tests.h"

namespace crescent::check {

namespace {

constexpr std::uint32_t point_count = 32;
constexpr std::size_t fewest = 16;  // points with known derivatives
constexpr double most_of_points = 0.9;
constexpr double step = 1 / 1081.0;        // of u: no period of numbers that are cut into two by a power of two
constexpr double largest_change = 0.02;    // relative change of a derivative if the step is halved
constexpr double least_derivative = 1e-2;  // of w by u: rounding in single precision is then 1 % of it
constexpr double parallel = 1e-3;          // sine of the angle between two derivatives
/// The map has at least a thousand times the density p: a thin but right region has a large p there.
constexpr double far_below = 1e-3;
/// The largest derivative that rounding in single precision, by 4 ulp, may hide.
constexpr double unresolved = 4 * ulp / (2 * step);

/// The derivatives at one u that are not 0; `is_known`: whether all of them are.
struct Derivatives {
    std::vector<Vec3d> slopes;
    bool is_known = true, has_fixed_number = false;  // has_fixed_number: a number moves nothing

    /// d: draws at u - step, u + step, u - step / 2 and u + step / 2, for each number.
    Derivatives(std::span<const Draw> d, int numbers) {
        for (std::size_t k = 0; k < static_cast<std::size_t>(numbers); ++k) {
            const std::span<const Draw> q = d.subspan(4 * k, 4);
            is_known = is_known && std::ranges::all_of(q, has_direction);
            if (!is_known) return;
            const Vec3d wide_slope = (q[1].wi - q[0].wi) * (0.5 / step),
                        narrow_slope = (q[3].wi - q[2].wi) * (1 / step);
            const double size = length(wide_slope);
            if (size == 0 && length(narrow_slope) == 0) {
                has_fixed_number = true;
                continue;
            }
            is_known = size > least_derivative && length(wide_slope - narrow_slope) < largest_change * size;
            slopes.push_back(narrow_slope);
        }
    }
    bool is_on_curve(double p) const {
        for (std::size_t k = 0; k < slopes.size(); ++k) {
            if (has_fixed_number && length(slopes[k]) * unresolved * p > far_below) return false;
            for (std::size_t j = 0; j < k; ++j) {
                const double area = length(cross(slopes[k], slopes[j]));
                if (area > parallel * length(slopes[k]) * length(slopes[j]) || area * p > far_below) return false;
            }
        }
        return !slopes.empty();
    }
};

}  // namespace

std::optional<SmallFault> draws_on_curve(Source& source, const StreamKey& key) {
    const int numbers = source.traits.numbers;
    if (source.traits.own_random || !source.declaration.can_draw || numbers < 2 || !source.has_density()) return {};
    std::vector<PrimarySample> u = first_numbers(key, point_count, source.traits), shifted_numbers;
    for (PrimarySample& x : u) {
        for (int k = 0; k < numbers; ++k) x[k] = std::clamp(x[k], 2 * step, 1 - 2 * step);
        for (int k = 0; k < numbers; ++k)
            for (double shift : {-step, step, -step / 2, step / 2}) {
                shifted_numbers.push_back(x);
                shifted_numbers.back()[k] += shift;
            }
    }
    const std::vector<Draw> draws = source.draw(shifted_numbers), point_draws = source.draw(u);
    SmallFault out{
        .family = Family::repeats, .what = "All draws lie on a curve, since no two random numbers move them apart"};
    const auto draws_per_point = static_cast<std::size_t>(4 * numbers);
    for (std::size_t i = 0; i < u.size(); ++i) {
        const Derivatives d(std::span<const Draw>(draws).subspan(draws_per_point * i, draws_per_point), numbers);
        if (!d.is_known || !has_direction(point_draws[i])) continue;
        ++out.trials;
        if (d.is_on_curve(point_draws[i].pdf) && out.times++ == 0)
            out.first = {.u = u[i], .draw = point_draws[i], .p = point_draws[i].pdf, .expected = 0};
    }
    return out.trials >= fewest && out.times >= most_of_points * out.trials ? std::optional(out) : std::nullopt;
}

}  // namespace crescent::check
