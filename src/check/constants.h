// The levels, tolerances and targets by which the engine decides a verdict, with their derivation, or with their cost
// if they are a choice. Those of causes are in explain/constants.h, amounts of work in estimate/budget.h, and the steps
// of one measurement, such as those of finite differences, in its file.
#pragma once

namespace crescent::check {

// ---- decision

/// The p-value of a family of tests, corrected for the number of its members, is compared with `alpha1`. A family below
/// it is reported if the same member, with fresh draws and fresh points, is below `alpha2` with the same sign. Chosen:
/// alpha1 alpha2 = 1e-8. With `questions_covered` families in one call, a right suite is reported with probability at
/// most 1e-3; a call with more families divides alpha2 by the excess. Cost: a fault is found if it exceeds about 4.4 +
/// 1.3 standard errors; ten times smaller levels would raise that by 5 %.
inline constexpr double alpha1 = 1e-5, alpha2 = 1e-3;
inline constexpr double questions_covered = 1e5;  // 1e-3 / (alpha1 alpha2)

/// The two levels of a call.
struct Levels {
    double first = alpha1, second = alpha2;
};
/// Levels at which a right call is reported with probability at most `alpha` if it has so many families. The level of
/// the second stage is scaled by alpha / 1e-3 and by the ratio of `questions_covered` to the number of families. It
/// stays between alpha1 and 1/10, and the first stage takes the rest: below alpha1, confirmation would be harder than
/// suspicion; above 1/10 it would confirm nothing.
constexpr Levels levels_of(double alpha, double questions) {
    const double joint_level = alpha / (questions > questions_covered ? questions : questions_covered);
    const double ratio = joint_level / alpha1;
    const double second = ratio < alpha1 ? alpha1 : ratio > 0.1 ? 0.1 : ratio;
    return {joint_level / second, second};
}

/// Share of alpha1 for each look of a staged budget before the last; the last look has the remainder. Chosen: an early
/// look stops only for a clear fault, and 1/8 of alpha1 raises the size that it finds by 3 %.
inline constexpr double early_look = 1.0 / 8;
/// The level of one look.
constexpr double level_at(const Levels& levels, int look_index, int looks) {
    return levels.first * (look_index == looks - 1 ? 1 - (looks - 1) * early_look : early_look);
}

/// Looks after those of the budget, while a size is too large. Each has the level of an early look, which counts as
/// that share of a further family. Two: the first at the number of draws that the sizes require, the second at the
/// most.
inline constexpr int further_looks = 2;
/// A check does not go on if this many times more draws than there may be would be needed. Chosen: sizes fall faster
/// than the root of the number of draws where integrals dominate.
inline constexpr double out_of_reach = 4;

/// A deviation below this share of the quantity is not reported. Chosen: below every fault of the public reports (the
/// smallest, sin(theta) evaluated at the centre of a texel, is 4e-4), and four times the error for which the integrals
/// are designed.
inline constexpr double detection_floor = 2e-4;

/// Nodes with fewer expected draws are not tested: 1 / sqrt(20) = 22 %, and fewer draws cannot reach alpha1.
inline constexpr double least_count = 20;

/// Least standard deviation of the sum of a replicate, in draws. Derived: if a share f of 32 replicates has one draw
/// more than the others, none of them shows it with probability (1 - f)^32, and their mean is then off by f draws. With
/// 0.3 that reaches alpha1 from f = 0.28 on, where both stages together have a probability below 1e-9.
inline constexpr double least_jumps = 0.3;

/// Standard deviation, as a share of the mass, that is added if only the integral is uncertain. Its variance may depend
/// on a few cells at an edge, and with so few degrees of freedom the critical value would be a large multiple of a
/// number far below the floor. Cost: a tenth of the floor.
inline constexpr double least_spread = detection_floor / 20;

/// Share of the answers that are not numbers, above which the verdicts built on these answers are not given: such
/// answers count as 0, and fewer cannot change a result by more than the detection floor.
inline constexpr double most_invalid = detection_floor;

// ---- arithmetic of the sampler

inline constexpr double ulp = 0x1p-24;  // of single precision, relative to 1
/// Least width of a leaf in radians, for any arithmetic that the sampler declares. Derived: float inside a double
/// interface moves a direction by up to 8 ulp (an azimuth near 2 pi), which is then at most 1/8 of a leaf.
inline constexpr double least_width = 64 * ulp;
/// A coarser lattice is a fault (u of few bits, texel centres), not arithmetic. Derived: single precision gives
/// coordinates in [-1, 1] a step of at most 2^-23, and the azimuths from which they are computed 8 ulp; 16 covers their
/// sum.
inline constexpr double coarsest_step = 16 * ulp;
/// Step of an angle over step of a coordinate: an azimuth in (4, 2 pi) in float has a step of 2^-21 = 8 ulp.
inline constexpr double angle_per_step = 8;

// ---- counted checks: tolerances of single precision

/// Relative difference between two values of the same number: pdf with a draw and pdf(w), weight and f cos / p.
/// Derived: a float expression of ten operations has an error of 10 ulp = 6e-7 times its condition number, which covers
/// condition numbers up to 100. For larger ones the range of values over small moves of w is used.
inline constexpr double same_number = 1e-4;
/// Share of the draws that may fail `pointwise` or `weight`, and share of the draws at which p may be 0 (`zero`):
/// chosen. A draw on the edge of the support is rounded to the other side once in 1e5 draws.
inline constexpr double tolerated_share = 1e-4, tolerated_zeros = 1e-5;
/// Failures that are tolerated for any number of draws: 3, so that a single unusual draw is not reported.
inline constexpr double tolerated_breaks = 3;
/// Tolerance of |w| - 1: 84 ulp of float, more than any normalisation leaves.
inline constexpr double unit_length = 1e-5;
/// Tolerance of a weight below 0: 1 - F in single precision.
inline constexpr double negative_weight = 1e-6;

/// Pairs of equal directions are reported above the number that the lattice of the sampler's arithmetic explains, times
/// `repeats_factor`, plus `repeats_floor`: chosen. A lattice is not uniform (float steps halve towards 0), which the
/// factor 4 covers; 8 pairs are not a fault for any sampler.
inline constexpr double repeats_factor = 4, repeats_floor = 8;
/// Solid angle that single precision may map to one direction. Derived: a cosine computed with an error of 4 ulp rounds
/// to 1 up to an angle of sqrt(8 ulp) from the axis, and reflection at the half vector doubles that angle, so the disk
/// has solid angle pi (2 sqrt(8 ulp))^2. A ring of one cosine has as much: 2 pi times a step of 16 ulp.
inline constexpr double one_direction = 3.14159265358979 * 32 * ulp;

/// Largest number of directions of delta parts, and of probabilities stated with each: chosen. A boundary has two;
/// three indices have four.
inline constexpr std::size_t most_delta_parts = 16;

/// Tolerance, in radians, of the direction of a delta part against the stated index: an index given with four digits.
inline constexpr double delta_direction = 1e-3;
/// Relative difference between the power of a delta part and of its reverse path: Fresnel near the critical angle, in
/// single precision.
inline constexpr double delta_power_tolerance = 1e-2;
/// The reverse path is not tested below this cosine to the surface, because samplers clamp there.
inline constexpr double grazing_cosine = 0.02;

/// Random numbers have few bits if a step of this size leaves most draws unchanged where it should move them by
/// `few_bits_move`: up to 16 bits are found. Derived: a cosine in single precision near 1, drawn as u^(1 / (s + 1)),
/// hides steps of the direction up to 2^-18 / sqrt(2 (s + 1)), at most half of that.
inline constexpr double few_bits_step = 0x1p-18, few_bits_move = 128 * ulp, few_bits_share = 0.6;

/// Tolerance of p |dw/du| below the probability of its branch: chosen, ten times the error of central differences whose
/// error estimate is below `jacobian_error`.
inline constexpr double jacobian_tolerance = 2e-3, jacobian_error = 2e-4;
/// Number of tested points that must fail, among those with a small enough error estimate.
inline constexpr double jacobian_breaks = 3;

// ---- f

/// Albedo above 1 by this much is reported: chosen, 10 times the excess of float BRDFs.
inline constexpr double albedo_excess = 1e-3;
/// Relative difference of f(a, b) and f(b, a): `same_number` times 10, because both directions are rounded.
inline constexpr double reciprocity_tolerance = 1e-3;
/// Depth of the nodes in which the weights of a sampler without pdf are compared. Chosen: 127 nodes cost a factor of
/// 1.2 in the size found; a mean of 1000 terms, each with less than 1/20 of the sum of squares, is nearly normal.
inline constexpr int mean_depth = 6;
inline constexpr double mean_draws = 1000;
/// Share of f cos where p = 0 that is reported: smaller than a float estimate of the mean can show.
inline constexpr double lost_light = 1e-6;

// ---- tail

/// The variance is infinite from this Pareto index on (Vehtari et al. 2024).
inline constexpr double heavy_index = 0.5;
/// If the largest of thousands of weights is at most this many means, there is no heavy tail: with index 1/2 the
/// largest is of the order of sqrt(n) means.
inline constexpr double bounded_weight = 4;
/// Weights with a smaller relative difference count as equal: as same_number, for the threshold of a tail; 10 times
/// less for repeated values.
inline constexpr double alike_weights = 1e-3, alike_values = 1e-5;
/// A largest weight that was drawn this often is an upper bound: larger weights have at most a fifth of its
/// probability, with 98 % confidence (the rule of three for 1 in 5 of 20).
inline constexpr std::size_t bound_drawn = 20;
/// Weights with at most this many different values have no tail: a Pareto fit would interpret the steps between them as
/// one.
inline constexpr std::size_t few_values = 8;
/// A lobe that is rarely chosen and has larger weights than the rest is a step, not a tail. A heavy fit is therefore
/// repeated for this share of the largest weights if at least `deeper_least` are left (standard error of k: 0.25).
inline constexpr std::size_t deeper_part = 8, deeper_least = 40;
/// The part of the integral where weights exceed the largest drawn is reported if the mean of the draws is too small by
/// this many of its standard errors. Derived: for a Pareto tail of index 1/2, where the variance is just infinite, n
/// draws leave out 1 / 1.3 sqrt(E) standard errors, E exponential: more than 3 has a probability below 1e-6.
inline constexpr double unseen_errors = 3;
/// Such a tail is inconclusive for lack of draws if this many times more would meet it, otherwise for a pdf that is too
/// small there. Chosen: a thorough check has twelve times as many draws as a quick one.
inline constexpr double within_reach = 64;
/// None of n draws falls into a set of probability c with probability exp(-n c). If that is below this level, p is
/// wrong, which `density` tests.
inline constexpr double missed_by_chance = 1e-4;

// ---- Targets of a quick check: a right verdict whose size exceeds ten times its target is inconclusive. Chosen by
// visibility: smaller errors are not visible in an image of a few thousand samples per pixel.

inline constexpr double target_constant = 1e-3, target_leak = 5e-3, target_cap = 3e-3, target_rotation = 5e-3,
                        target_parameter = 2e-2;
/// Ten times as much, 0.7 %, is a dead neighbour that one reservoir in twenty counts.
inline constexpr double target_bias_of_weights = 7e-4;
inline constexpr double inconclusive_at = 10;  // times the target
/// The same if p is a random estimate. Chosen: an estimate with a relative standard deviation of 1 needs 10^6
/// evaluations for a mean with an error of 0.1 %, more than a quick check through a program has.
inline constexpr double inconclusive_of_estimates = 100;
inline constexpr double stated_power = 0.9, power_quantile = 1.2816;  // P(Z < 1.2816) = stated_power
/// Standard errors beyond the critical value: P(Z < 2.05) = 0.98. The least size of several tests is stated, and each
/// has an uncertainty of 13 %, that of a standard deviation from 32 replicates. Measured by planting faults of these
/// sizes: the least of them is found with `stated_power` only if each by itself is found with 0.98.
inline constexpr double power_of_each = 2.05;

// Evidence in sentences.

inline constexpr double half_width_95 = 1.96;  // standard errors: an interval of 95 %
inline constexpr double draws_of_cell = 100;   // a relative standard error of a tenth

}  // namespace crescent::check
