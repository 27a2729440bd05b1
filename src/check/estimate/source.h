// One technique of a sampler at one w_o: draws, densities and f in batches, with a count of all evaluations.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "check/estimate/budget.h"
#include "check/estimate/stream.h"
#include "check/sources/recorded_sampler.h"
#include "check/verdict.h"

namespace crescent::check {

/// Answers of pdf(w) and f(w) that are not finite or negative, and the first of them.
struct InvalidAnswers {
    std::uint64_t pdf = 0, f = 0;                          // directions
    std::uint64_t pdf_evaluations = 0, f_evaluations = 0;  // directions that were evaluated
    enum class Function { none, pdf, f };
    Function first = Function::none;
    Vec3d wi{};
    double value = 0;
    std::uint64_t count() const { return pdf + f; }
};

/// For one thread. `adapter` and `light` must outlive it.
class Source {
public:
    Source(const SamplerAdapter& adapter, int technique, Vec3d wo, const CaseLighting& light)
        : adapter(adapter),
          technique(technique),
          wo(wo),
          light(light),
          declaration(adapter.declaration()),
          traits(declaration.traits) {}

    const SamplerAdapter& adapter;
    const int technique;
    const Vec3d wo;
    const CaseLighting& light;
    const SamplerDeclaration declaration;
    const Traits traits;
    /// Whether p, and f, are random estimates that are right only in the mean: h must not depend on them.
    bool estimates = false, f_estimates = false;
    /// Whether the density is ignored, so that tests use the draws alone.
    bool by_draws = false;
    /// Whether no index is stated and none scales f across the surface, see both_ways().
    bool unscaled = false;

    /// The file that contains the draws, if there is one.
    const RecordedSampler* recorded() const { return recorded_; }
    std::uint32_t batch_rows() const { return declaration.costly_query ? large_batch_size : batch_size; }
    int numbers() const { return std::max(traits.numbers, 1); }
    bool single() const { return traits.bits == 24; }
    Resolution resolution() const { return resolution_of(traits); }
    bool has_density() const { return traits.has_pdf && !by_draws; }
    bool has_f() const { return declaration.has_f; }
    int channels() const { return traits.channels == 3 ? 3 : 1; }

    void draw(std::span<const PrimarySample> u, std::span<Draw> out);
    std::vector<Draw> draw(std::span<const PrimarySample> u);
    /// Draws `from` to `from + u.size()` of a stream, with their random numbers. A file returns its rows in place of
    /// new draws: of each eight the first for the pilot, four for stage 1, three for stage 2, none of them twice.
    void draw(const StreamKey& key, std::uint32_t from, std::span<PrimarySample> u, std::span<Draw> out);
    /// The number of draws of a stream that are available, up to `limit`.
    std::uint32_t available(const StreamKey& key, std::uint32_t limit) const;
    /// 1/sr, in double if the sampler has it; replaced by 0 and counted if it is not finite or negative.
    void density(std::span<const Vec3d> wi, std::span<double> out);
    double density(Vec3d wi);
    /// The same from another w_o, unchanged; for directions whose lengths are off by rounding.
    void density_from(Vec3d other_wo, std::span<const Vec3d> wi, std::span<double> out);
    /// Whether another technique draws there although this one does not.
    bool reached_otherwise(Vec3d wi);
    /// 1/sr, in the sampler's own arithmetic, unchanged.
    void stated_pdf(std::span<const Vec3d> wi, std::span<double> out);
    /// f |cos| by channel, without the light; 1/sr. truth: of the BRDF itself, if that is known independently of f.
    void f_cos(std::span<const Vec3d> wi, std::span<Vec3d> out, bool truth = false);

    /// MIS weights of directions drawn by this technique.
    void mis_weights(std::span<const Vec3d> wi, std::span<double> out);
    /// Whether the azimuth carries nothing, since a single dimension is spread over it: it is not cut.
    bool is_line() const { return traits.domain && traits.domain->is_line(); }
    /// Whether a draw there is possible for a sampler of this kind; p: the density there.
    bool may_draw(Vec3d w, double p) const { return p > 0 || (traits.domain ? traits.domain->has_point(w) : w.z > 0); }
    /// Radiance of the light from w; below the surface that of its uniform part.
    double radiance(Vec3d w) const { return light.even() || w.z <= 0 ? light.fill : light(w); }

    std::uint64_t evaluations() const { return evaluations_; }
    /// Counts calls that go directly to the sampler.
    void count(std::size_t evaluations) { evaluations_ += evaluations; }
    /// Answers of density() and f_cos() that were not finite or negative.
    const InvalidAnswers& invalid() const { return invalid_; }

private:
    std::uint64_t evaluations_ = 0;
    InvalidAnswers invalid_;
    std::vector<Pair> pairs_;
    const RecordedSampler* recorded_ = dynamic_cast<const RecordedSampler*>(&adapter);
    std::span<const Pair> pairs_of(std::span<const Vec3d> wi) { return pairs_of(wo, wi); }
    std::span<const Pair> pairs_of(Vec3d from, std::span<const Vec3d> wi);
    void note_invalid(InvalidAnswers::Function function, Vec3d wi, double value);
};

/// Whether the draw is a direction with a density: neither a delta part nor empty, and of finite numbers.
inline bool has_direction(const Draw& d) {
    return d.delta == 0 && d.pdf > 0 && std::isfinite(d.pdf + d.wi.x + d.wi.y + d.wi.z) && dot(d.wi, d.wi) > 0;
}

/// Whether the draw is a direction of the tested density. p: the density there. Below the surface a draw counts only if
/// p is positive; otherwise the estimator ignores it. A sampler that does not depend on w_o, such as that of a light,
/// has no surface.
inline bool is_direction(const Traits& traits, const Draw& d, double p) {
    return has_direction(d) && (d.wi.z > 0 || p > 0 || !traits.has_surface());
}

/// The weight of a draw by channel; 0 for a draw without one.
inline Vec3d weight_by_channel(const Draw& d, int channels) {
    const double weight = d.weight.value_or(0);
    return channels == 3 ? d.weights : Vec3d{weight, weight, weight};
}

/// Draws that are directions of the tested density: their rows, their directions, and p there.
struct UsableDraws {
    std::vector<std::size_t> row;
    std::vector<Vec3d> w;
    std::vector<double> p;
};
/// Evaluates p at these draws. lower_source: if given, p is evaluated only below the surface and by it, to decide which
/// draws count; elsewhere it is the pdf of the draw.
UsableDraws usable_draws(Source& source, std::span<const Draw> draws, Source* lower_source = nullptr);
/// Replaces p by that of `source` at directions below the surface.
void evaluate_below(Source& source, std::span<const Vec3d> w, std::span<double> p);

}  // namespace crescent::check
