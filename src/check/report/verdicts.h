// Results of a check as verdicts: the sentence of a finding (what was found, how large with its 95 % interval, and
// where), the evidence, and the pictures of the HTML page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/decide/check_at.h"
#include "check/decide/check_sampler.h"
#include "check/explain/causes.h"
#include "check/verdict.h"

namespace crescent::check {

Sentences sentences_of(const CheckAt& check, const Finding& finding);
Sentence sentence_of(const SmallFault& fault, const Traits& traits);
/// The random numbers of an example; none if it is no draw. `is_draw`: whether it is one even if all its numbers are 0.
std::vector<double> numbers_of(const Example& example, const Traits& traits, bool is_draw = false);
std::vector<double> numbers_of(const SmallFault& fault, const Traits& traits);
/// The measurement of a right verdict; none for a verdict without one.
Sentences sentences_of_right(const CheckAt& check, std::string_view verdict);

/// What a verdict lacks that was not decided: the size, and how small it has to be.
Sentences sentences_of_open(const CheckAt& check, std::string_view verdict);

// ---- Where draws and p differ (report/places.cpp).

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

// ---- Tests that were not possible for a sampler at one w_o, and the reason: no pdf(w), no weights, answers that are
// random estimates, a file of draws.

/// Completes a verdict that has no fault.
void note_limits(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v);

// ---- The density that the draws of a sampler without pdf(w) imply: their share in a cell over its solid angle, with
// its standard error.

/// Adds it to the verdict on the density: by cells of the tree, by rings about n, and at its maximum.
void note_implied_density(const CheckAt& c, Verdict& v);

// ---- Results of a check as verdicts: names and states, sentences, and the numbers of evidence. No code reads the
// texts of the sentences.

/// The verdicts of one sampler, for each of its w_o in the order of the verdict list.
std::vector<Verdict> verdicts_of(
    std::span<const CheckCase> check_cases, const CheckOutcome& outcome, const std::optional<Cause>& cause);

// ---- The pictures of the HTML page for one w_o: draws by bin with the expectation of p, the weights, and p and f L
// cos in the plane of incidence.

/// Draws of one technique by bins of theta and phi about n, from the leaves of its tree, finer where most draws are.
/// Both sides are sums of h = q / (p + q), in units of draws. Without a density: the density that the draws imply, in
/// 1/sr. None if there are no draws.
/// Draws and expectation over a line or a set; none for another domain.
std::optional<LineHistogram> line_picture(const CheckCase& check_case, const CheckAt& check);
std::optional<BinHistogram> bin_map(const CheckCase& check_case, const CheckAt& c);
/// Histogram of the weights with the fitted tail. x: weights of all techniques.
WeightHistogram weight_picture(const CheckCase& check_case, std::span<const double> x, const WeightTail& tail);
/// Adds p and f L cos along the plane of incidence, which costs evaluations of both at 179 directions.
void add_rose(const CheckCase& check_case, WeightHistogram& to);

}  // namespace crescent::check
