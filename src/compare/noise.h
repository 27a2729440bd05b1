// Pairs of renders of two arms that share their random numbers, and what the pictures of their differences say.
#pragma once

#include "base/progress.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/shared_seeds.h"

namespace crescent::inline comparison {

/// Pairs of renders of two arms with the same number in their names: indices into their files. Throws InputError where
/// a render has no partner.
std::vector<RenderPair> pairs_of(const ArmStats& a, const ArmStats& b);

/// Whether each render of either arm is in one of the pairs.
bool all_paired(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b);

/// Whether a test of pairs, three or more, at this level sees a smaller difference than one of all renders as if they
/// were independent: pairs have less variance, and half the degrees of freedom or fewer.
bool sharper_in_pairs(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b, double level);

/// Reads both renders of each pair twice; b = arms.size() is the reference.
PairedRenders paired_renders(const ComparePlan& plan, const RenderStats& all, std::size_t a, std::size_t b,
    std::vector<RenderPair> pairs, ProgressMonitor& monitor);

}  // namespace crescent::inline comparison
