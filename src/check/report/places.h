// Where draws and p differ, as shares of the draws and of p.
#pragma once

#include <optional>
#include <string>

#include "check/decide/check_at.h"
#include "check/verdict.h"
#include "samplers/domains/sphere_chart.h"

namespace crescent::check {

/// The share of the draws in a region and the share of p, with standard errors. Both are of the directions drawn and of
/// the integral of p, so that a constant factor of p changes neither.
struct ShareDifference {
    ChartRect rect{};
    double drawn_share = 0, drawn_error = 0, claimed_share = 0, claimed_error = 0;
    double difference() const { return drawn_share - claimed_share; }
    double errors() const;
};
/// The largest difference that is clear, in the smallest node that has most of it; none if no node differs clearly.
std::optional<ShareDifference> largest_difference(
    const Plan& plan, const Integrals& integrals, const Observations& observations);
/// "Of the draws 12.3 % +- 0.4 % are at polar angles 0 to 30 deg, where p has 6.1 % +- 0.1 %."
Sentence sentence_of(const ShareDifference& difference, const Traits& traits);
std::string region_text(const ChartRect& rect, const Traits& traits);
/// "12.3 % +- 0.4 %", or the end of the interval that is next to 0 or 1.
std::string share_text(double share, double error);

/// The solid angles over which draws and p are spread: exp(entropy) over the same cells, sr. A uniform density has the
/// solid angle of its support.
struct Concentration {
    enum class Comparison { unknown, more, less, same } comparison = Comparison::unknown;
    double drawn_solid_angle = 0, claimed_solid_angle = 0;
    double error = 0;  // of ln(drawn_solid_angle / claimed_solid_angle)
};
/// None over an infinite line.
std::optional<Concentration> concentration_of(const CheckAt& check);
/// None if unknown.
std::optional<Sentence> sentence_of(const Concentration& concentration, const Traits& traits);

}  // namespace crescent::check
