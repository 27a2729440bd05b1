// Estimates with a combination of samplers (samplers/combination_plan.h): one sample of it is one direction or several,
// each with its weight. Films have the same bits on every instruction set.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/kernel.h"
#include "render/technique.h"
#include "samplers/combination_plan.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// One direction of a sample: X gains weight f L cos / pdf.
struct WeightedDirection {
    DrawnByAny<float> draw;
    float weight = 0;
};

/// Returns two random numbers in (0, 1) of a row of a run; each block has others.
using NumberBlocks = std::function<Vec2<float>(std::size_t run, std::size_t row, std::uint32_t block)>;

/// The directions and evaluations of one sample.
struct SampleCost {
    std::uint64_t directions = 1;  // that are estimated, and so also rays
    std::uint64_t f = 1;           // evaluations of f
    std::uint64_t densities = 0;   // evaluations of a density, except those of draws
};

class Combination : public SamplerAdapter {
public:
    /// `target`: the density of ris with a sampler as target; else null. `weights_at`, `probabilities_at`: their places
    /// in the experiment. `weigh`: gives the weights of mis in their place, or null. Throws InputError if they cannot
    /// be read.
    Combination(std::string name, CombinationPlan plan, Techniques parts, std::shared_ptr<const Technique> target,
        const SourceLocation& weights_at, const SourceLocation& probabilities_at,
        std::shared_ptr<const SamplerAdapter> weigh = nullptr);

    SamplerDeclaration declaration() const override {
        return {.name = name_, .traits = {.has_pdf = false}, .device = device_of(parts_)};
    }
    /// Is not called: a combination is estimated at shading points, by sample().
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override;

    const CombinationPlan& plan() const { return plan_; }
    SampleCost cost() const;
    /// Returns the number of directions of one sample.
    std::size_t directions() const { return cost().directions; }

    /// Writes directions() entries for each row.
    void sample(const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const;

    /// Returns its density if a sample is one direction that is weighted by its density; else null.
    std::shared_ptr<const Technique> technique() const;

    /// Its samplers, and the weight of a direction of sampler k, w_k, from the densities of all at it.
    const Techniques& parts() const { return parts_; }
    double mis_weight(std::size_t k, FormulaInputs in, std::span<const double> p) const;
    /// Whether they come from a function, which mis_weight() does not call.
    bool has_weight_function() const { return weigh_ != nullptr; }
    /// The same for each row, whose direction is of sampler k[row]; the densities are p[sampler][row].
    std::vector<double> mis_weights(const PointRows& rows, std::span<const std::size_t> k,
        std::span<const Vec3<float>> wi, const std::vector<std::vector<double>>& p) const;

    /// Whether kernels can estimate it: all samplers are built in, and it needs neither candidates nor a function.
    bool runs_in_kernels() const;
    /// Refers to this object. `numbers`: see estimate_combination().
    CombinationCall kernel_call(const PixelNumbers* numbers) const;
    /// The probabilities with which its samplers are chosen at a point, or their shares of the mixture.
    void shares_at(const ShadingPoints& points, std::size_t point, std::span<double> out) const;

private:
    void sample_every(const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const;
    void sample_mixture(const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const;
    void sample_one(const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const;
    void sample_resampled(const PointRows& point_rows, const NumberBlocks& u, std::span<WeightedDirection> out) const;
    std::uint64_t samples_of(std::size_t k) const;
    /// n_k of draw = "every", c_k of draw = "one".
    std::vector<double> shares(const FormulaInputs& in) const;

    std::string name_;
    CombinationPlan plan_;
    Techniques parts_;
    std::shared_ptr<const Technique> target_;
    WeightList weights_, probabilities_;
    std::shared_ptr<const Technique> mixture_;  // of a mixture
    std::shared_ptr<const SamplerAdapter> weigh_;
    std::vector<int> built_in_;           // of each sampler, see Technique
    std::vector<std::uint64_t> repeats_;  // samples_of each
};

/// Returns the combination that a sampler is, or null.
inline const Combination* combination_of(const SamplerAdapter* sampler) {
    return dynamic_cast<const Combination*>(sampler);
}

/// Estimates like a kernel of the table. `isa`: a name of isas(), "" for the best. `numbers`: others than those of
/// films, or null. `in_kernels`: false for the general path alone, which has the same bits.
void estimate_combination(const Combination& combination, const KernelCall& call, const std::string& isa,
    const PixelNumbers* numbers = nullptr, bool in_kernels = true);

}  // namespace crescent
