// What the verdicts share: measurements on one trial that more than one of them reads, or that have a file of their
// own.
#pragma once

#include <algorithm>

#include "stats/tail.h"
#include "stats/moments.h"
#include "verdicts/trial_context.h"

namespace crescent::inline verdicts {

struct VerdictKind;

/// What the sum of p over the sphere may differ from one by.
inline constexpr double granted_mass = 1e-4;

/// What is wrong with the first of these draws that cannot be used, "" where all can.
std::string first_fault(const TrialContext& work, int technique, const SampleBatch& b);
/// Faults at corners of u, and how often a generator of 24 bits comes upon such a u.
struct CornerFaults {
    std::string first;
    std::size_t count = 0, tried = 0;
    double chance = 0;  // of one sample
};
/// What comes back at the corners of u.
CornerFaults corner_faults(const TrialContext& work, int technique);

inline constexpr const char* no_weights =
    "There is neither a pdf nor a weight with the draws, hence nothing to weigh them by.";

/// The pdf with a draw may be a random estimate too: the mean of one over it is not one over the mean.
inline bool weighs_by_estimates(const TrialContext& work) {
    const auto& draws = work.first(0).draws;
    return work.scatter().pdf() &&
        std::none_of(draws.begin(), draws.end(), [](const Draw& d) { return d.weight.has_value(); });
}
inline constexpr const char* weight_of_estimates =
    "A weight, f |cos| / p, with each draw: where pdf is a random estimate, f over it is biased and tells nothing of "
    "the draws.";

/// What a reader is told of that: Johnson's t, or the plain one where it is far out, for which Johnson's correction is
/// not made. None where the weights are alike to what p itself is granted: their spread is no measure of chance.
std::optional<double> told_z(const Spread& s, const Integral& expected);
/// How often the largest weight was drawn, to the rounding of floats. One with a tail has a largest that comes once.
std::size_t times_largest(std::span<const double> x);
/// Of the largest of these weights; none where the largest was drawn so often that there is nothing beyond it.
std::optional<Tail> tail_of(std::span<const double> x);
/// A tail with k >= 1/2 has a largest weight of the order of sqrt(n) means; one of a few means among thousands is
/// bounded, whatever a fit to the few weights that stand out may say.
bool is_bounded(const Spread& s);
/// k-hat surely below 1/2 and theory does not say otherwise.
bool mean_is_testable(const Spread& s, const std::optional<Tail>& tail, const ExpectedBehaviour& theory);
/// Two-sided p-value of the mean, the quadrature's own error granted, and the two-stage test. Where |skew| / sqrt(n) >
/// 0.1 the normal law is too far off: Bernstein's inequality between 0 and the largest weight, which never accuses too
/// often.
double mean_p(const Spread& s, const Integral& expected);
bool mean_fails(const TrialContext& work, double p, const Integral& expected, bool even);

/// The mean is short, and a tail that no draw met explains it: such a mean is not accused (unmet.cpp).
bool has_unmet_tail(const TrialContext& work, bool even);
Unmet look_for_unmet(const TrialContext& work, std::span<const double> x, bool even);
/// "heavy tail that no draw met", with its mass and how many draws would meet it; sets `settle` too.
void tell_unmet(Verdict& v, const Unmet& unmet, const Integral& expected, std::size_t draws);

/// How far the sampler's p may move when wo and wi move by their own rounding: the largest change over twelve nudges.
double pdf_conditioning(const TrialContext& work, int technique, Vec3d wi, double p);
double f_conditioning(const TrialContext& work, Vec3d wo, Vec3d wi, double f, int channel = 0);

/// Whether two samplers are of one f; see against_f.cpp. A difference is told, and is wrong where none is expected.
Verdict same_f(const TrialContext& a, const TrialContext& b, bool expect_same);
/// Which of two samplers of one f has the smaller variance; see against_variance.cpp.
Verdict ratio_of_variances(TrialContext& a, TrialContext& b, const Verdict& of_f);
/// What a sampler whose variance is ranked must pass by itself.
std::span<const VerdictKind* const> judged_alone();

/// Whether weights that are estimates, or are told beside estimates, are off in the mean; says so. See
/// weights_in_the_mean.cpp.
bool weights_are_off(const TrialContext& work, int technique, Verdict& v);

/// The same u is answered otherwise, the very direction comes again, or a delta part comes with another weight; says
/// so. See repeats.cpp.
bool answers_otherwise(const TrialContext& work, int technique, Verdict& v);
bool repeats_directions(const TrialContext& work, const SampleBatch& b, Verdict& v);
bool has_uneven_deltas(const TrialContext& work, const SampleBatch& b, Verdict& v);
/// What p |Jacobian of the warp| says of all techniques.
struct WarpSummary {
    double one_to_one = 1;  // the least share of points at which it is 1
    int choosers = 0;       // the most numbers that choose
};
/// It accuses a technique, which it says, or is added to the summary; and what the summary says of a sampler that none
/// accuses. See warp.cpp.
bool warp_is_wrong(const TrialContext& work, int technique, WarpSummary& all, Verdict& v);
std::string told_of_warp(const TrialContext& work, const WarpSummary& warps);

/// What the draws of a sampler without pdf(w) imply of its density, as a map and a table; see implied.cpp.
Verdict implied_density(TrialContext& work, Verdict v);

/// More than there is, granted what eta^2 may do to what comes through; says so. See energy.cpp.
bool creates_energy(const TrialContext& work, const Integral& albedo, Verdict& v);

/// f |cos| depends on the angle between w_o and w_i alone, on both sides of the surface; see phase.cpp.
bool is_phase_function(const TrialContext& work);
/// A delta part goes where neither the index that is told nor a thin wall lets it through; says so. See snell.cpp.
bool refracts_elsewhere(const TrialContext& work, Verdict& v);
/// Where a delta part goes, no delta part comes back from; says so.
bool comes_not_back(const TrialContext& work, Verdict& v);
/// Weights without a pdf whose mean under a light from one side is not the integral; says so. See mean_lights.cpp.
bool directions_are_off(const TrialContext& work, Verdict& v);

/// What light from direction b, under the surface, gives to all directions above: int f(a, b) cos a da. See
/// transmission.cpp.
Integral from_below(const TrialContext& work, Vec3d b);
/// Up to three directions under the surface that the sampler draws, the one of the highest pdf first.
std::vector<Vec3d> drawn_below(const TrialContext& work);

/// A point at which |Jacobian| of the warp is known: 1 / |J| is the density that is drawn there, where one u alone
/// reaches it.
struct WarpPoint {
    Vec3d wi{};
    double jacobian = 0, error = 0;  // sr, over the share of the number that chooses; relative
    Numbers u{};
    double p_jacobian = 0;
};
/// What finite differences say of the warp at these u; nothing where a seam is near.
std::vector<std::optional<WarpPoint>> jacobians_at(
    const TrialContext& work, int technique, std::span<const Numbers> at);
/// The bin that is off most for its size.
std::size_t worst_bin(const std::vector<double>& observed, const std::vector<double>& expected);
/// "Most at theta 31.2 deg, phi 250.1 deg: 812 seen, 640.3 due."
void tell_worst(Verdict& v, const Density& d, const std::vector<double>& observed, const std::vector<double>& expected);

/// What share of the draws may be too many or too few in one bin and not be seen: what takes the chi-square over all
/// bins to its level, half of the time, in the fullest of them.
double unseen_share(const std::vector<double>& expected, double degrees, double draws, double level);

/// The block of draws that is least likely for its room; see clumps.cpp.
struct Clump {
    double p = 1;                         // that any block were so crowded
    double draws = 0, due = 0, room = 0;  // due: at most; room in sr
    Vec3d at{};
};
/// How far a direction goes at least when it goes at all, in the median over these draws: by moves of u of 2^-24 or,
/// where those leave it where it is, by the least that does not. A warp that is steep, as a cell of a large table is,
/// draws no finer than that, and neither does one of which floats make stairs. Where many u are sent to one point
/// without such a stair, the way out of it is as fine as anywhere. Of a sampler that draws numbers of its own: how far
/// apart directions are that come again. 0: not known.
double least_step(const TrialContext& work, int technique, const SampleBatch& b, std::span<const std::size_t> draws);
Clump densest_clump(const TrialContext& work, int technique, const Density& d, const SampleBatch& b);
void tell_clump(Verdict& v, const Clump& clump);

/// What the warp's derivatives say; see jacobian.cpp.
struct WarpFinding {
    std::size_t usable = 0, below = 0;  // points with a trusted |J|, and those with p |J| < 1
    double smallest = 1;                // p |J|
    double nowhere_above = 1;           // p |J| that three of four points with the best |J| do not exceed
    double region_below = 1;            // the least of that over sixteenths of the square of the first two numbers
    Vec2d region{};                     // the corner nearest to u = (0, 0) of that sixteenth
    Numbers at{};
    double one_to_one = 0;                   // share of usable points with p |J| = 1
    std::size_t steps_tried = 0, stuck = 0;  // moves of u by 2^-19 that ought to show, and those that do not
    std::vector<WarpPoint> points;           // the usable ones
    int choosers = 0;                        // numbers beside the first two that move the direction
};
/// How much of the choosing number leads from each of these u to the same direction; 0: not known, because the
/// direction follows that number without a jump or several numbers choose. See branches.cpp.
struct Branches {
    std::vector<double> share;
    double known_to = 0;
    int choosers = 0, chooser = -1;  // chooser: the number that chooses, where it is the only one
};
/// Whether the third number and on choose between continuous branches.
Branches follow_branches(const TrialContext& work, int technique, std::span<const Numbers> at);
/// Directions that several lobes of the sampler reach, each from a u of its own, and what they draw there together; see
/// preimages.cpp.
struct Reached {
    std::size_t looked_at = 0, denser = 0;  // directions; and those drawn more often than p says
    Vec3d worst{};
    double most = 1;  // drawn density over p there
    /// What either of two lobes draws over p where no third was found; `low`: by the lower numbers that choose.
    struct Pair {
        double low, high;
    };
    std::vector<Pair> pairs;
    int chooser = 0;  // the number that chooses; 0: the first leads to both
};
/// Looked at once; kept with the work.
const Reached& preimages_of(const TrialContext& work, int technique);
/// Looked at once; kept with the work.
const WarpFinding& study_warp(const TrialContext& work, int technique);

}  // namespace crescent::inline verdicts
