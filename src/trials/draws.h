// What a trial draws, on the first seed and on fresh ones, and what its draws tell: pdf and f at each, weights,
// rounding, estimates, and what lies under the surface.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "trials/questions.h"
#include "trials/scatter.h"

namespace crescent::inline trials {

/// Draws of one technique on one seed.
struct SampleBatch {
    std::vector<Numbers> u;
    std::vector<Draw> draws;
    std::vector<double> pdf;        // pdf(w) asked afterwards, as the sampler's own arithmetic says it
    mutable std::vector<double> f;  // f of every draw above the horizon, once asked for
    std::vector<std::pair<Vec2d, Draw>>
        dropped;  // draws that cannot be used, too few to matter; a neighbour stands in for each
    mutable std::vector<Vec3d> f_channels;   // the same by channel, where there are three
    mutable std::vector<Vec2d> coordinates;  // of the draws about the axis that was last asked for, {} of nothing drawn
    mutable std::optional<Vec3d> axis;
    std::uint64_t nothing = 0;  // pdf 0, or under the horizon where pdf(w) is 0; draws of delta parts among them
    std::uint64_t deltas = 0;   // draws of delta parts
};

/// No component is NaN or infinite.
inline bool is_finite(Vec3d w) { return std::isfinite(w.x + w.y + w.z); }

/// Nothing drawn as a density: pdf 0, or a direction under the horizon at which pdf(w) is 0.
inline bool is_null_sample(const Draw& d, double pdf_there) {
    return !(d.pdf > 0) || (d.wi.z <= 0 && !(pdf_there > 0));
}

/// The layer of a trial that draws.
class Draws : public Questions {
public:
    /// Draws the screening batch of each technique.
    Draws(const Trial& trial, const TestSettings& settings, std::uint32_t index);

    SampleBatch draw(int technique, int round) const;  // round 0: the screening seed, 1: the confirming one
    const SampleBatch& first(int technique) const { return first_[static_cast<std::size_t>(technique)]; }
    /// Rounding of the directions that come back: 2^-24 for floats, 2^-50 for doubles, or that of short decimals.
    double direction_resolution() const { return direction_resolution_; }
    /// Whether pdf and f are random estimates, right in the mean alone.
    const Scatter& scatter() const { return scatter_; }

    /// Under the surface: whether f is not 0 there, most at `at` of those tried, and whether the sampler reaches it.
    struct Below {
        bool transmits = false, reached = false;
        Vec3d at{};
        double f = 0;
    };
    const Below& below() const { return below_; }
    /// The whole sphere is judged, not its upper half alone.
    bool whole() const { return trial.wo.z < 0 || (below_.transmits && below_.reached); }
    /// Light from wi counts.
    bool counts(Vec3d wi) const { return wi.z > 0 || (wi.z < 0 && whole()); }
    /// Radiance from wi; the fill shines from below too where that counts.
    double light(Vec3d wi) const { return wi.z < 0 && whole() ? trial.light.fill : trial.light(wi); }
    /// Its draws have weights: f cos / p, or what the sampler itself says.
    bool weighs() const;

    /// f of every draw above the horizon, 0 elsewhere; asked once.
    const std::vector<double>& f_of_drawn(const SampleBatch& b) const;
    std::vector<double> pdf_of_drawn(int technique, std::span<const Draw> draws) const;
    /// Of every draw, {} where nothing was drawn; computed once an axis.
    const std::vector<Vec2d>& coordinates_of(const SampleBatch& b, const SphereMap& map) const;
    /// X = sum over techniques of w f L cos / p, sample by sample; even: L = 1 in place of the light.
    std::vector<double> weights(std::span<const SampleBatch> pair, bool even) const;
    /// Those of the screening draws; computed once.
    const std::vector<double>& first_weights(bool even) const;

protected:
    /// Fresh draws for another seed.
    void redraw(std::uint32_t seed);
    /// A limited sampler's confirming draws were fewer than the screening ones: questions ran out.
    bool confirmed_by_fewer() const;

private:
    std::uint32_t seed_;
    std::vector<SampleBatch> first_;
    mutable std::array<std::optional<SampleBatch>, 2> confirming_;  // of a limited sampler, by technique
    double direction_resolution_ = 0;
    Scatter scatter_;
    Below below_;
    mutable std::array<std::vector<double>, 2> first_weights_;  // by even
    std::uint64_t confirming_draws() const;
    void count_nothing(SampleBatch& b) const;
    void settle_zeros(SampleBatch& b) const;
    void look_below();
};

}  // namespace crescent::inline trials
