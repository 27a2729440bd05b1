// A sampler over all its w_o: each w_o by itself on any thread, a program by one in an order of its own, and the tests
// that need no w_o or several.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "check/decide/check_at.h"
#include "check/decide/small_tests.h"
#include "check/decide/tail.h"

namespace crescent::check {

/// What a call asks for.
struct CheckSettings {
    CheckBudget budget = CheckBudget::quick();
    /// Where each answer costs something; empty: `budget`.
    std::optional<CheckBudget> limited{};
    std::uint32_t seed = 1;
    double alpha = 1e-3;
    /// Samplers and w_o in the whole call; beyond `questions_covered` families the second level is divided.
    double cases = 1;
    bool keep_evidence = false;  // of right w_o too, and the weights: for pictures
};

/// Why a sampler was not examined to the end at some w_o.
struct Cut {
    enum class Why { fault, gone, too_slow } why = Why::fault;
    std::string what;
    bool first_draws = false;  // whether the first draws were examined before, see CheckOutcome::at
};

/// Of one sampler.
struct CheckOutcome {
    std::string arm;
    std::vector<std::size_t> check_cases;  // indices into the call's cases
    std::vector<std::vector<CheckAt>> at;  // by case and technique; cut short: what the first draws showed
    std::vector<WeightTail> tails;         // by case
    std::vector<SmallFault> small;         // of the sampler as a whole
    std::uint64_t evaluations = 0;
    std::vector<std::optional<Cut>> cut;  // by case
    std::optional<Cut> whole_cut{};       // of what belongs to no w_o
    bool wrong() const;
};

/// CheckCases of one or of several samplers; those of one name and sampler belong together. Baselines are left out.
/// Faults of a sampler from outside (samplers/faults.h) are kept with the w_o at which they occurred.
std::vector<CheckOutcome> check_samplers(
    std::span<const CheckCase> check_cases, const CheckSettings& settings, ProgressMonitor& monitor);

// ---- Tests of a sampler that belong to no single w_o: w_o and w_i exactly on axes, planes and the horizon and next to
// them; f in both directions; weights of combined techniques.

/// Directions on axes and planes, and one rounding of single precision beside them.
std::vector<Vec3d> special_directions();
/// Draws at special w_o, pdf and f at special w_i; of one technique.
std::optional<SmallFault> special_places(const SamplerAdapter& adapter, int technique, std::span<const Vec3d> ordinary);
/// f(a, b) against f(b, a), with eta^2 across the surface.
std::optional<SmallFault> reciprocity(const SamplerAdapter& adapter, const StreamKey& key);
/// Weights of two techniques that are combined sum to 1 wherever one of them draws.
std::optional<SmallFault> mis_weights(const SamplerAdapter& adapter, Vec3d wo, const StreamKey& key);

/// What f(b, a) is over f(a, b): 1 on one side of the surface; across it eta^2 from above to below, for radiance, and
/// one over that for importance (Veach 1997, (5.14)).
double reciprocal_ratio(const Traits& traits, const Pair& p, int channel);

}  // namespace crescent::check
