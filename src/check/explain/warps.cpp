// A number is warped wrongly: sample(u) draws p if one of its numbers is replaced by a power of itself, such as
// sqrt(u1) for the radius in a disk. With v = u^a in place of a uniform u, the density of the map at v is that of p
// times du/dv = a v^((a - 1) / a), which the derivatives of the map show without noise. The corrected sampler is then
// checked.
#include "check/explain/warps.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "check/decide/jacobian.h"
#include "check/explain/causes.h"
#include "check/explain/constants.h"
#include "check/explain/hypothesis.h"

namespace crescent::check {

namespace {

/// u_k replaced by its power, or 1 - u_k by the power of 1 - u_k.
struct Warp {
    int number = 0;
    double power = 1;
    bool is_from_one = false;

    double apply(double u) const {
        const double x = is_from_one ? 1 - u : u, y = x > 0 ? math::exp(power * math::log(x)) : 0;
        return std::clamp(is_from_one ? 1 - y : y, 0.0, 1 - ulp);
    }
    /// The density of the map over p where the number has the value v.
    double ratio(double v) const {
        const double x = std::max(is_from_one ? 1 - v : v, 1e-12);
        return power * math::exp((power - 1) / power * math::log(x));
    }
    std::string text() const {
        const std::string u = fmt::format("u{}", number + 1), x = is_from_one ? "1 - " + u : u;
        const std::string y = power == 0.5 ? "sqrt(" + x + ")"
            : power < 1                    ? fmt::format("({})^(1/{:g})", x, std::round(1 / power))
            : is_from_one                  ? fmt::format("({})^{:g}", x, power)
                                           : fmt::format("{}^{:g}", x, power);
        return is_from_one ? "1 - " + y : y;
    }
};

/// The sampler with this warp of a number, for a test of its density alone.
DecoratedSampler warped(std::shared_ptr<const SamplerAdapter> sampler, const Warp& warp) {
    const auto evaluate = [warp](const SamplerAdapter& inner, SamplerQuery query, const SamplerAnswers& out) {
        std::vector<PrimarySample> room;
        const std::span<const PrimarySample> u = query.u.samples(room);
        std::vector<PrimarySample> v(u.begin(), u.end());
        for (PrimarySample& x : v) x[warp.number] = warp.apply(x[warp.number]);
        query.u = std::span<const PrimarySample>(v);
        inner.evaluate(query, out);
    };
    return {std::move(sampler), evaluate, without_f};
}

/// Whether the ratio of the map is that of the warp at nine of ten points, and not 1 there.
bool explains(const Warp& warp, std::span<const Place> places) {
    double points = 0, agreements = 0, differences = 0;
    for (const Place& place : places)
        for (const MapDensity& m : place.map) {
            const double deviation = std::fabs(math::log(m.density / m.p / warp.ratio(m.u[warp.number])));
            ++points;
            agreements += deviation < agreement + 2 * m.error;
            differences += std::fabs(math::log(m.density / m.p)) > least_warp;
        }
    return points >= static_cast<double>(fewest_of_form) && agreements >= share_in_agreement * points &&
        differences > points / 2;
}

}  // namespace

std::optional<Cause> warp_cause(std::span<const Place> places) {
    for (int k = 0; k < places[0].traits.numbers; ++k)
        for (double power : {1.0 / 2, 2.0, 1.0 / 3, 3.0})
            for (bool is_from_one : {false, true}) {
                const Warp warp{k, power, is_from_one};
                if (!explains(warp, places)) continue;
                const DecoratedSampler corrected = warped(places[0].check_case->adapter, warp);
                if (!follows_density(corrected, places, 1)) continue;
                return Cause{.factor = "root",
                    .exponent = power,
                    .error = 0,
                    .text = fmt::format("With {} in place of u{} the draws follow p: in sample a {} is {}{}.",
                        warp.text(), k + 1,
                        power == 0.5     ? "square root"
                            : power < 1  ? "cubic root"
                            : power == 2 ? "square root"
                                         : "cubic root",
                        power < 1 ? "missing" : "taken once too often",
                        power == 0.5 ? ", as that of a radius in a disk or of a barycentric coordinate" : "")};
            }
    return {};
}

}  // namespace crescent::check
