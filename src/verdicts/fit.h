// Draws held against a density, by Pearson's chi-square over bins whose expected counts come from adaptive cubature in
// double; bins are pooled along their ring, then outwards, until 5 are expected in each.
#pragma once

#include <optional>
#include <vector>

#include "trials/trial_context.h"
#include "verdicts/clumps.h"

namespace crescent::inline verdicts {

struct Pearson {
    double statistic = 0, degrees = -1;  // one degree goes to the total
    double p = 1;
    std::size_t pools = 0, empty = 0;  // pools tested; bins with an expectation below 1e-6
    double empty_observed = 0, empty_expected = 0;
};

struct FitToDensity {
    Pearson joint, rings, sectors;
    double outside_p = 1;  // of as many draws where p integrates to next to nothing
    double outside_seen = 0, outside_due = 0;
    Clump clump;
    std::optional<double> heights_p;  // of the mean of ln p over draws of a sky's table,
    double heights_off = 0;           // which is off by so many standard errors
    std::vector<double> observed, expected;
};

/// The same density in wider bins: its rings are at least `least` radians wide, and its sectors as many as are four
/// times as wide on the ring that holds `ring`: none about an axis, whose own direction has no azimuth.
Density joined(const Density& d, double least, std::size_t ring);

FitToDensity fit_to_density(const TrialContext& work, int technique, const Density& d, const SampleBatch& b);

}  // namespace crescent::inline verdicts
