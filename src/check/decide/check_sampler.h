// A check of a sampler at all its w_o, and the tests that need no w_o or several. The w_o run on any thread; a program
// is called by one thread, in an order of its own.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "check/decide/check_at.h"
#include "check/decide/small_tests.h"
#include "check/verdict.h"

namespace crescent::check {

/// The settings of a call.
struct CheckSettings {
    CheckBudget budget = CheckBudget::quick();
    /// For samplers whose answers are expensive; empty: `budget`.
    std::optional<CheckBudget> limited{};
    const CheckBudget& budget_of_limited() const { return limited ? *limited : budget; }
    std::uint32_t seed = 1;
    double alpha = 1e-3;
    /// Samplers times w_o in the whole call; beyond `questions_covered` families the second level is divided.
    double cases = 1;
    /// Evaluations in all by which the checks of w_o that are not decided may go on, and the most at one w_o.
    double further_in_all = 0, most_at_one = 4e6;
    bool keep_evidence = false;  // also of right w_o, with the weights: for pictures
};

/// The reason why the check of a sampler at some w_o ended early.
struct Cut {
    enum class Why { fault, exited, too_slow } why = Why::fault;
    std::string what;
    bool first_draws = false;  // whether the first draws were examined, see CheckOutcome::checks
};

/// The outcome for one sampler.
struct CheckOutcome {
    std::string arm;
    std::vector<std::size_t> check_cases;      // indices into the call's cases
    std::vector<std::vector<CheckAt>> checks;  // by case and technique; if cut short, the faults of the first draws
    std::vector<WeightTail> tails;             // by case
    std::vector<SmallFault> small;             // faults of the sampler as a whole
    std::uint64_t evaluations = 0;
    std::vector<std::optional<Cut>> cut;  // by case
    std::optional<Cut> whole_cut{};       // of the tests of the whole sampler
    bool wrong() const;
};

/// Checks the cases of one or several samplers, grouped by name and sampler, without baselines. Faults of an external
/// sampler (samplers/faults.h) are stored with the w_o at which they occurred.
std::vector<CheckOutcome> check_samplers(
    std::span<const CheckCase> check_cases, const CheckSettings& settings, ProgressMonitor& monitor);

// ---- Tests of a sampler that belong to no single w_o: w_o and w_i exactly on axes, planes and the horizon and one
// rounding step next to them; f in both directions; weights of combined techniques.

/// Directions on axes and planes, and directions one rounding of single precision next to them.
std::vector<Vec3d> special_directions();
/// Draws at special w_o, pdf and f at special w_i and at the directions of a smooth boundary, for one technique.
std::optional<SmallFault> special_places(const SamplerAdapter& adapter, int technique, std::span<const Vec3d> ordinary);
/// f(a, b) against f(b, a), with eta^2 across the surface.
std::optional<SmallFault> reciprocity(const SamplerAdapter& adapter, const StreamKey& key);
/// Tests that the weights of two combined techniques sum to 1 wherever one of them draws.
std::optional<SmallFault> mis_weights(const SamplerAdapter& adapter, Vec3d wo, const StreamKey& key);

/// The ratio f(b, a) / f(a, b): 1 on one side of the surface; across it eta^2 from above to below for radiance, and the
/// reciprocal for importance (Veach 1997, (5.14)).
double reciprocal_ratio(const Traits& traits, const Pair& p, int channel);

// ---- efficiency: variance of X times the time of one sample, compared with every other sampler of the same surface,
// light and w_o and with the baselines (uniform and cosine).

/// The variance and time of one case with their errors.
struct Efficiency {
    std::size_t check_case = 0;
    double variance = 0, relative_se = 0;  // of X; relative standard error of the variance
    double nanoseconds = 0, cost_se = 0;   // per sample, relative standard error; 0: not measured
    bool has_weights = false;
    bool heavy = false;           // whether the tail is too heavy for a variance
    bool is_over_sphere = false;  // over the sphere, not only the upper hemisphere
    std::string fault;            // the error if the sampler failed meanwhile
    double value() const { return variance * nanoseconds; }
    double low() const;
    double high() const;
};

/// Variances of all cases: from the draws of the check or, for a baseline, from a few draws of its own.
std::vector<Efficiency> variances_of(std::span<const CheckCase> check_cases, std::span<const CheckOutcome> outcomes,
    const CheckSettings& settings, const ProgressMonitor& monitor);
/// Measures the time of one sample of each on one thread, in turns, so that a slow phase of the machine affects all
/// equally.
void measure_costs(std::span<const CheckCase> check_cases, std::uint32_t seed, std::span<Efficiency> variances,
    const ProgressMonitor& monitor);
/// One verdict for each case. Two samplers whose intervals overlap are not ranked.
std::vector<Verdict> test_efficiency(std::span<const CheckCase> check_cases, std::span<const Efficiency> variances);

}  // namespace crescent::check
