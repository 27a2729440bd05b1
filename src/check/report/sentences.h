// The sentence of a finding: what was found, how large with its 95 % interval, and where; and what a verdict lacks that
// is right or not decided.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "check/decide/check_at.h"
#include "check/decide/small_tests.h"
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

/// Faults of these sizes in words, in the order of fault_kinds(): "a constant factor of 0.03 %". Sizes by name of the
/// kind.
std::vector<std::string> found_faults(std::map<std::string, double> sizes);

/// Completes a verdict that has no fault: tests that were not possible for a sampler at one w_o, and the reason, which
/// is that it has no pdf(w) or no weights, that answers are random estimates, or that it is a file of draws.
void note_limits(const SamplerAdapter& sampler, const CheckAt& c, Verdict& v);

}  // namespace crescent::check
