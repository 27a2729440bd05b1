// What a sampler takes and returns: its random numbers, its properties, a draw, and a pair of directions. Local frame,
// n = +z, wo given, wi drawn, both leave the surface; pdf in 1/sr; f without the cosine, in 1/sr.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "base/vec.h"
#include "samplers/domains/domain_chart.h"

namespace crescent {

/// The random numbers of one sample, each in [0, 1): radius and angle first, then as many more as the sampler takes.
struct PrimarySample {
    static constexpr int most_numbers = 8;
    double x = 0, y = 0;
    std::array<double, most_numbers - 2> more{};
    PrimarySample() = default;
    PrimarySample(double u1, double u2) : x(u1), y(u2) {}
    PrimarySample(Vec2d u) : x(u.x), y(u.y) {}
    double operator[](int k) const { return k == 0 ? x : k == 1 ? y : more[static_cast<std::size_t>(k) - 2]; }
    double& operator[](int k) { return k == 0 ? x : k == 1 ? y : more[static_cast<std::size_t>(k) - 2]; }
    operator Vec2d() const { return {x, y}; }
};

/// The index below over above: one for each channel, one for all channels, or unknown.
struct Index : std::optional<Vec3d> {
    Index() = default;
    Index(double of_all) : optional({of_all, of_all, of_all}) {}
    Index(Vec3d by_channel) : optional(by_channel) {}
    Index(std::optional<Vec3d> by_channel) : optional(by_channel) {}
};

/// The properties of a sampler: its inputs and outputs, and what is known of its surface.
struct Traits {
    enum class WoDomain { upper, both, none };  // the w_o that it accepts; none: it does not depend on w_o
    using Asked = WoDomain;
    int numbers = 2;   // random numbers of a sample, and those that spread a point of `domain`
    int channels = 1;  // of f and of the weight, 1 or 3
    WoDomain wo = WoDomain::upper;
    bool has_pdf = true;             // false: no pdf(w), and the pdf of a draw is 1 or 0
    bool own_random = false;         // it uses its own random numbers: the same u may give another answer
    bool delta = false;              // some of its draws belong to delta parts
    bool reciprocal = true;          // false: f is known not to be reciprocal
    Index eta{};                     // index below over above
    bool importance = false;         // f is scaled by eta^2 as importance is, not as radiance
    int bits = 0;                    // precision of its arithmetic: 24, 53; 0: determined from the answers
    int u_bits = 24;                 // of its random numbers: 24, or 53 if it asks for them
    bool reciprocal_weight = false;  // a draw's weight is random and estimates 1/p; f is the target, without a cosine
    int neighbours = 0;              // whose reservoirs a draw merges, see neighbours.h; 0: none
    bool number = false;             // each draw is one value, its weight: an estimate of a number
    /// The chart through which it draws directions for points of another domain; null: it draws directions.
    std::shared_ptr<const DomainChart> domain{};
    /// Whether n has a meaning: draws below it are no samples, and f is multiplied by the cosine.
    bool has_surface() const { return wo != WoDomain::none && !domain && !reciprocal_weight; }
    /// |cos| of f's integrand: 1 where there is no surface at all.
    double cosine(Vec3d wi) const { return domain || reciprocal_weight ? 1 : std::fabs(wi.z); }
    /// A density per solid angle as one over the domain.
    double density(Vec3d w, double per_sr) const { return domain ? domain->density(w, per_sr) : per_sr; }
    /// Random numbers that the sampler itself takes.
    int own_numbers() const { return numbers - (domain ? static_cast<int>(domain->spreads()) : 0); }
};

/// A direction and its density; pdf 0: no sample. weight: f cos / p if the sampler returns it.
struct Draw {
    Vec3d wi{};
    double pdf = 0;
    std::optional<double> weight{};  // for three channels: their luminance
    std::optional<double> f{};       // if it is known only at the draws
    /// Not 0: a draw of a delta part, with the probability of its selection; then pdf is 0, and weight is set.
    double delta = 0;
    Vec3d weights{};  // by channel, if there are three and weight is set
};

/// The draw of a point of a domain with its density over it. u: the sampler's `numbers`, then those that spread the
/// point. A point outside the domain has the direction NaN.
Draw draw_of_point(
    const DomainChart& domain, std::span<const double> point, double pdf, const PrimarySample& u, int numbers);

/// Random numbers that a sampler of points may take, besides those that spread a point.
inline int most_numbers(const DomainChart& domain) {
    return PrimarySample::most_numbers - static_cast<int>(domain.spreads());
}

/// Marks a delta part with selection probability 0; the verdict `valid` reports it.
inline constexpr double delta_never_chosen = -std::numeric_limits<double>::infinity();

inline double luminance(Vec3d c) { return luminance(Rgb{c.x, c.y, c.z}); }

/// wo and wi of one evaluation.
struct Pair {
    Vec3d wo, wi;
};

}  // namespace crescent
