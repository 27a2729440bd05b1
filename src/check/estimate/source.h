// One technique of a sampler at one w_o: draws, densities and f in batches, each evaluation counted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "check/estimate/stream.h"
#include "check/sources/sampler_adapter.h"

namespace crescent::check {

/// Calls are for one thread. `sampler` and `light` outlive it.
class Source {
public:
    Source(const SamplerAdapter& adapter, int technique, Vec3d wo, const CaseLighting& light)
        : adapter(adapter), technique(technique), wo(wo), light(light), traits(adapter.traits()) {}

    const SamplerAdapter& adapter;
    const int technique;
    const Vec3d wo;
    const CaseLighting& light;
    const Traits traits;
    /// p is a random estimate, right in the mean alone: h must not depend on it. The same of f.
    bool estimates = false, f_estimates = false;
    /// The density is left out: what is asked is a matter of the draws alone.
    bool by_draws = false;
    /// No index is stated, and none scales f across the surface (scatter.h).
    bool unscaled = false;

    /// The file that the draws are read from, if they are.
    const RecordedSampler* recorded() const { return recorded_; }
    int numbers() const { return std::max(traits.numbers, 1); }
    bool single() const { return traits.bits == 24; }
    bool has_density() const { return traits.has_pdf && !by_draws; }
    bool has_f() const { return adapter.has_f(); }
    int channels() const { return traits.channels == 3 ? 3 : 1; }

    void draw(std::span<const PrimarySample> u, std::span<Draw> out);
    /// Draws `from` to `from + u.size()` of a stream, with the numbers that they are of. A file gives its rows in place
    /// of new draws: of each eight the first to the pilot, four to stage 1, three to stage 2, none of them twice.
    void draw(const StreamKey& key, std::uint32_t from, std::span<PrimarySample> u, std::span<Draw> out);
    /// How many of `wanted` draws of a stream there are.
    std::uint32_t available(const StreamKey& key, std::uint32_t wanted) const;
    /// 1/sr, in double where the sampler has it; 0 and counted where it is not finite or negative.
    void density(std::span<const Vec3d> wi, std::span<double> out);
    double density(Vec3d wi);
    /// Whether another technique draws there, where this one does not.
    bool reached_otherwise(Vec3d wi);
    /// 1/sr, by the sampler's own arithmetic, as it comes.
    void stated_pdf(std::span<const Vec3d> wi, std::span<double> out);
    /// f |cos| by channel, without the light; 1/sr. truth: of the BRDF itself, where that is known apart from f.
    void f_cos(std::span<const Vec3d> wi, std::span<Vec3d> out, bool truth = false);

    /// MIS weights of directions that this technique drew.
    void mis_weights(std::span<const Vec3d> wi, std::span<double> out);
    /// Of the light from w; below the surface that of its even part.
    double radiance(Vec3d w) const { return light.even() || w.z <= 0 ? light.fill : light(w); }

    std::uint64_t evaluations() const { return evaluations_; }
    /// Of calls that go to the sampler itself.
    void count(std::size_t evaluations) { evaluations_ += evaluations; }
    /// Answers of density() and f_cos() that were not finite or negative, and where the first was.
    std::uint64_t invalid() const { return invalid_; }
    Vec3d first_invalid() const { return first_invalid_; }
    double first_invalid_value() const { return first_invalid_value_; }

private:
    std::uint64_t evaluations_ = 0, invalid_ = 0;
    Vec3d first_invalid_{};
    double first_invalid_value_ = 0;
    std::vector<Pair> pairs_;
    const RecordedSampler* recorded_ = dynamic_cast<const RecordedSampler*>(&adapter);
    std::span<const Pair> pairs_of(std::span<const Vec3d> wi);
    double checked(double value, Vec3d at);
};

/// A direction of the density that is tested: not a delta part, not nothing. p: the density there. Below the surface a
/// draw counts where p is positive; else it is what the estimator takes for nothing.
inline bool is_direction(const Draw& d, double p) {
    return d.delta == 0 && d.pdf > 0 && std::isfinite(d.wi.x + d.wi.y + d.wi.z) && (d.wi.z > 0 || p > 0);
}

}  // namespace crescent::check
