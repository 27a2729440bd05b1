// Every constant of the engine that can change a verdict, with its derivation, or with what it costs where it is a
// choice. Constants that only move effort are in estimate/budget.h.
#pragma once

namespace crescent::check {

// ---- decision

/// A family of questions is suspected below this p-value (its members counted) and reported if the same member, on
/// fresh draws and fresh points, is below `alpha2` with the same sign. Chosen: alpha1 alpha2 = 1e-8. With
/// `questions_covered` families in one call, a right suite is reported with probability at most 1e-3; a call that puts
/// more questions divides alpha2 by the excess. Cost: a fault is found if it exceeds about 4.4 + 1.3 standard errors;
/// ten times smaller levels would raise that by 5 %.
inline constexpr double alpha1 = 1e-5, alpha2 = 1e-3;
inline constexpr double questions_covered = 1e5;  // 1e-3 / (alpha1 alpha2)

/// The two levels of a call.
struct Levels {
    double first = alpha1, second = alpha2;
};
/// Levels by which a right call is reported with probability at most `alpha` if it puts so many questions: the second
/// stage is scaled by what alpha is above 1e-3 and the questions are above `questions_covered`. It stays between alpha1
/// and 1/10, and the first stage takes the rest: below alpha1 a confirmation would be harder to pass than a suspicion,
/// above 1/10 it would confirm nothing.
constexpr Levels levels_of(double alpha, double questions) {
    const double both = alpha / (questions > questions_covered ? questions : questions_covered);
    const double scaled = both / alpha1;
    const double second = scaled < alpha1 ? alpha1 : scaled > 0.1 ? 0.1 : scaled;
    return {both / second, second};
}

/// How alpha1 is shared among the looks of a staged budget, the last look having what is left. Chosen: an early look
/// may only stop for a clear fault, and 1/8 of alpha1 costs it 3 % in the size found.
inline constexpr double early_look = 1.0 / 8;
/// The level of one of so many looks.
constexpr double level_at(const Levels& levels, int look, int looks) {
    return levels.first * (look == looks - 1 ? 1 - (looks - 1) * early_look : early_look);
}

/// A deviation below this share of the quantity is not reported. Chosen: below every fault of the public reports (the
/// smallest, sin(theta) taken at a texel's centre, is 4e-4), and four times the error the integrals are built for.
inline constexpr double detection_floor = 2e-4;

/// Expected draws below which a node is not tested: 1 / sqrt(20) = 22 %, and fewer cannot reach alpha1.
inline constexpr double least_count = 20;

/// A replicate's sum has at least this standard deviation, in draws. Derived: if a share f of 32 replicates has one
/// draw more than the others, none of them shows it with probability (1 - f)^32, and their mean is then off by f draws.
/// With 0.3 that passes alpha1 from f = 0.28 on, where both stages together have a probability below 1e-9.
inline constexpr double least_jumps = 0.3;

/// Standard deviation, of the mass, that is added where the integral alone is uncertain: its variance may rest on the
/// few cells at an edge, whose few degrees of freedom would ask for any multiple of a number far below the floor. Cost:
/// a tenth of the floor.
inline constexpr double least_spread = detection_floor / 20;

// ---- arithmetic of the sampler

inline constexpr double ulp = 0x1p-24;  // of single precision, relative to 1
/// No leaf is narrower, in radians, for any arithmetic that the sampler declares. Derived: float inside double
/// interfaces moves a direction by up to 8 ulp (an azimuth near 2 pi), which is then at most 1/8 of a leaf.
inline constexpr double least_width = 64 * ulp;
/// Lattices coarser than this are no arithmetic but a fault (u of few bits, texel centres). Derived: single precision
/// gives coordinates in [-1, 1] a step of at most 2^-23 and the azimuths behind them 8 ulp; 16 covers their sum.
inline constexpr double coarsest_step = 16 * ulp;
/// Of an angle over that of a coordinate: an azimuth in (4, 2 pi) held in float has a step of 2^-21 = 8 ulp.
inline constexpr double angle_per_step = 8;

// ---- counted checks: tolerances of single precision

/// Relative difference of two statements of one number: pdf with a draw and pdf(w), weight and f cos / p. Derived: a
/// float expression of ten operations errs by 10 ulp = 6e-7 times its conditioning, which up to 100 is covered; worse
/// conditioned ones are looked at over moves of w.
inline constexpr double same_number = 1e-4;
/// Share of the draws that may break `pointwise` or `weight`, and the share at which p may be 0 (`zero`): chosen. A
/// draw on the edge of the support is rounded to the other side once in 1e5.
inline constexpr double tolerated_share = 1e-4, tolerated_zeros = 1e-5;
/// Breaks that are tolerated for any number of draws: 3, so that one odd draw is no finding.
inline constexpr double tolerated_breaks = 3;
/// |w| may differ from 1 by this much: 84 ulp of float, more than any normalisation leaves.
inline constexpr double unit_length = 1e-5;
/// A weight may be below 0 by this much: 1 - F in single precision.
inline constexpr double negative_weight = 1e-6;

/// Equal directions beyond what the lattice of the sampler's arithmetic explains, times this, plus that: chosen.
/// A lattice is not even (float steps halve towards 0), which the factor 4 covers; 8 pairs are no fault for anyone.
inline constexpr double repeats_factor = 4, repeats_floor = 8;
/// Solid angle that single precision may make one direction. Derived: a cosine computed with an error of 4 ulp rounds
/// to 1 up to an angle of sqrt(8 ulp) from the axis, and about a half vector the direction turns by twice that; the
/// disk has pi (2 sqrt(8 ulp))^2. A ring of one cosine has as much: 2 pi times a step of 16 ulp.
inline constexpr double one_direction = 3.14159265358979 * 32 * ulp;

/// Directions of a delta part and probabilities that are stated with it, at most this many of each: chosen; a boundary
/// has two, three indices have four.
inline constexpr std::size_t most_delta_parts = 16;

/// A delta part leads where the index says to within this, in radians: an index that is stated in four digits.
inline constexpr double delta_direction = 1e-3;
/// Relative difference of the power of a delta part and of its way back: Fresnel near the critical angle, in single
/// precision.
inline constexpr double delta_power_tolerance = 1e-2;
/// Cosine from the surface below which the way back is not asked for: samplers clamp there.
inline constexpr double grazing_cosine = 0.02;

/// Numbers are of few bits if a step of this size moves most draws not at all where it should move them by
/// `few_bits_move`: up to 16 bits are found. Derived: a cosine in single precision near 1, drawn as u^(1 / (s + 1)),
/// hides steps of the direction up to 2^-18 / sqrt(2 (s + 1)), at most half of that.
inline constexpr double few_bits_step = 0x1p-18, few_bits_move = 128 * ulp, few_bits_share = 0.6;

/// p |dw/du| may fall below the probability of its branch by this much: chosen, ten times what central differences with
/// an error estimate below `jacobian_error` leave.
inline constexpr double jacobian_tolerance = 2e-3, jacobian_error = 2e-4;
/// How many of the points looked at must break it, of those whose error estimate is small enough.
inline constexpr double jacobian_breaks = 3;

// ---- f

/// Albedo above 1 by this much is reported: chosen, 10 times what float BRDFs sum to above 1.
inline constexpr double albedo_excess = 1e-3;
/// Relative difference of f(a, b) and f(b, a): as same_number, times 10 because both directions are rounded.
inline constexpr double reciprocity_tolerance = 1e-3;
/// Nodes in which the weights of a sampler without pdf are compared: down to this depth, with so many draws. Chosen:
/// 127 of them cost a factor of 1.2 in the size found; a mean of 1000 terms, none of which holds 1/20 of the sum of
/// squares, is near normal.
inline constexpr int mean_depth = 6;
inline constexpr double mean_draws = 1000;
/// Share of f cos where p = 0 that is reported: below what a float estimate of the mean can show.
inline constexpr double lost_light = 1e-6;

// ---- tail

/// The variance is infinite from this Pareto index on (Vehtari et al. 2024).
inline constexpr double heavy_index = 0.5;
/// A largest weight of no more means than this among thousands is no tail: one with index 1/2 has a largest of the
/// order of sqrt(n) means.
inline constexpr double bounded_weight = 4;
/// Weights that differ by this much relatively are one: as same_number, of the threshold of a tail; 10 times less of
/// values that are drawn again and again.
inline constexpr double alike_weights = 1e-3, alike_values = 1e-5;
/// A largest weight that was drawn this often is a bound: what lies beyond comes a fifth as often at most, with 98 %
/// (the rule of three for 1 in 5 of 20).
inline constexpr std::size_t bound_drawn = 20;
/// Weights of no more different values than this are no tail: a Pareto fit takes the steps between them for one.
inline constexpr std::size_t few_values = 8;
/// A lobe that is seldom chosen and weighs more than the rest is a step, not a tail: a heavy fit is repeated for this
/// share of the largest weights, if at least `deeper_least` are left (standard error of k: 0.25).
inline constexpr std::size_t deeper_part = 8, deeper_least = 40;
/// A part of the integral that lies where weights are larger than any drawn is reported if the mean of the draws is
/// short by this many of its standard errors. Derived: for a Pareto tail of index 1/2, where the variance is just not
/// finite, n draws leave out 1 / 1.3 sqrt(E) standard errors, E exponential: more than 3 has a probability below 1e-6.
inline constexpr double unseen_errors = 3;
/// None of n draws meets what is drawn with probability c with probability exp(-n c); below this probability it is no
/// chance, but p that is wrong, which is the matter of `density`.
inline constexpr double missed_by_chance = 1e-4;

// ---- targets of a quick check: a right verdict whose size exceeds ten times its target is inconclusive. Chosen by
// what matters in a render: less is not seen in an image of a few thousand samples a pixel.

inline constexpr double target_constant = 1e-3, target_leak = 5e-3, target_cap = 3e-3, target_rotation = 5e-3,
                        target_parameter = 2e-2;
inline constexpr double inconclusive_at = 10;  // times the target
/// The same where p is a random estimate. Chosen: an estimate that varies by its own size has to be averaged over 10^6
/// evaluations to be known to 0.1 %, which a quick check through a program does not have.
inline constexpr double inconclusive_of_estimates = 100;
inline constexpr double stated_power = 0.9;

}  // namespace crescent::check
