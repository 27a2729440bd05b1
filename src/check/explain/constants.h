// Every threshold that decides whether a cause is named, and which, with its derivation, or with its cost if it is a
// choice. Constants of verdicts are in check/constants.h; numbers that change only the amount of work stand where they
// are used. Likelihoods are natural logarithms (nats).
#pragma once

#include <cstddef>

#include "check/constants.h"

namespace crescent::check {

// ---- candidates and their order

/// Lead of the likelihood over all draws at which one cause is preferred to another: a probability of e^-8 = 3e-4 by
/// chance. The same for each factor that a fit adds.
inline constexpr double least_lead = 8;
/// Shares of the divergence that are sufficient if no cause explains all of it: for a frame, because a table that is
/// read in another order may not be known exactly; for a fitted number, because replicates are more precise than the
/// fit.
inline constexpr double enough_for_frame = 0.4, enough_for_fit = 0.9;
/// Standard errors of the lead, below which two causes are not told apart.
inline constexpr double lead_errors = 3;
/// A cause that explains less of the divergence is said to explain a part.
inline constexpr double explains_all = 0.9;
/// A constant this near to 1 is not printed: figures of it are known to half a percent.
inline constexpr double near_one = 0.01;
/// Unusable draws explain a missing mass that they equal to this part.
inline constexpr double unusable_tolerance = 0.2;
/// Standard errors by which a number must differ from that of a right sampler for its cause to be named, and by which
/// the likelihood must exceed that of p for a partial cause. Chosen: of a thousand numbers none does by chance.
inline constexpr double clear_number = 8;
/// Standard errors of a fitted rotation or scale, of which a check fits a few. By chance 6e-7.
inline constexpr double clear_move = 5;
/// Standard errors by which two of many entries of a set differ: of 4096 one does with a probability of 4e-6.
inline constexpr double clear_entries = 6;

// ---- a supposed density, checked as the sampler's own

/// A cause explains the difference if nothing remains of it: it is not sufficient that no family is below alpha1, which
/// the fewer draws of this check might not reach; no family may be below this level. One right sampler in a hundred has
/// such a family.
inline constexpr double remaining_level = 1e-2;
/// ln p relative to its median for a draw where the supposed density is 0: below any that a draw can be expected at.
inline constexpr double no_density = 14;
/// Share of the points of the map at which a supposed density may be below that of the draws: one in ten has a
/// derivative across an edge.
inline constexpr double most_below_map = 0.1;
/// Two hypotheses are one if their densities agree to `same_density` at `same_share` of the draws: ten roundings of
/// single precision, and the draws at edges.
inline constexpr double same_density = 1e-3, same_share = 0.9;

// ---- factors: draws over p as a product of powers

/// A supposed cause explains a ratio of densities within this relative difference, besides the ratio's own error: ten
/// times the rounding of a sampler in single precision. It has to explain this share of the ratios.
inline constexpr double agreement = 2e-3, share_in_agreement = 0.9;
/// A ratio agrees with a factor if its error, besides its own uncertainty, is below `agreement` and below this part of
/// the typical distance of the ratios from 1: many factors fit ratios that are nearly constant.
inline constexpr double part_that_agrees = 0.1;
/// A fitted exponent is taken for the multiple of 1/2 within this distance: from ratios, which have errors of 1e-3,
/// and from counts, whose exponent has a standard error of about 0.01.
inline constexpr double half_tolerance = 0.05, simple_tolerance = 0.03;
/// A factor is better than another if it explains this much more of the ratios: a third of the error of their share.
inline constexpr double better_share = 0.02;
/// Ratios that decide an exponent by the share that agrees: a share of 0.9 of 40 has a standard error of 0.05.
inline constexpr std::size_t fewest_ratios = 40;
/// Ratios that decide a form without an exponent, such as a warp or another G.
inline constexpr std::size_t fewest_of_form = 24;
/// Bound of fitted exponents: beyond, a factor only hides all draws but those at its maximum.
inline constexpr double largest_exponent = 20;
/// In a wider leaf, in radians, a factor is averaged over four points: it changes by less than 1 % in a smaller one.
inline constexpr double wide_leaf = 0.02;
/// Powers of p: for a nearly uniform density any power is likely, and a smaller change of the exponent shows nothing.
inline constexpr double largest_power = 0.5, least_power = 1e-3;
/// A warp of a number that changes less than half of the ratios by this is not shown by them.
inline constexpr double least_warp = 0.1;
/// Two normals are one within 0.8 degrees (1 - cos): fitted normals are known to a tenth of that.
inline constexpr double same_normal = 1e-4;

// ---- rotations

/// An azimuth within this part of it is taken for a whole column of a table, if that is as likely.
inline constexpr double column_tolerance = 0.1;
/// Of two rotations by angles half a turn apart the smaller is named if their likelihoods differ by less than this:
/// two axes of one surface are the same after half a turn.
inline constexpr double equal_likelihoods = 1e-3;

// ---- lobes that one number chooses

/// Change of the direction that is a jump: in radians, a root or a logarithm changes less over 2^-22. A steep change
/// within this distance of 0 or 1 is none.
inline constexpr double jump_angle = 0.02, steep_rim = 0x1p-7;
/// Tolerance of the ends of a lobe, in units of the number: chosen, 100 times the step of the search.
inline constexpr double one_end = 1e-4;
/// Draws of a cell, so that its error of 5 % biases a share by 0.3 % at most.
inline constexpr double draws_of_lobe = 400;
/// p-value of the misfit that remains: below, the draws are no mixture of these lobes.
inline constexpr double lobes_fit = 1e-3;
/// How well a share (relative), a probability (half an interval), a lobe that p does not have, and a factor (half an
/// interval, relative) must be known to be named: so that the printed figures are right.
inline constexpr double known_share = 0.02, known_probability = 0.05, known_absence = 0.1, known_factor = 0.1;

// ---- draws outside of p, and parts of p without draws

/// The least share of even draws that is named, and its ratio to its standard error.
inline constexpr double least_leak = 1e-4, clear_leak = 8;
/// Expected draws of an empty leaf that counts as unreached: e^-10.
inline constexpr double expected_unreached = 10;
/// Largest difference from 1 of draws over p where there are draws, and least share of the mass of p that has none.
inline constexpr double elsewhere_tolerance = 0.1, least_unreached = 0.02;
/// Draws with one direction are a delta part if they are this share of all, and all of them from `every_draw` on;
/// directions within `one_point` are one.
inline constexpr double least_delta = 0.01, every_draw = 0.999, one_point = 1e-6;

// ---- reciprocal weights

/// Least mass of a region, relative to all: less has too few draws for a mean.
inline constexpr double least_region = 2e-3;
/// p-value of a factor that explains the weights; one of which is rejected more clearly than `rejection_level` is none.
inline constexpr double weights_fit = 0.01, rejection_level = 1e-6;
/// Standard errors by which a constant differs from 1. Few constants are fitted.
inline constexpr double clear_constant = 4;

}  // namespace crescent::check
