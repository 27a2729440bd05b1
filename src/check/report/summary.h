// What a result comes to, one line a finding over all w_o, worst first; and its details, each sentence once with the
// cases it is true of.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "check/report/print.h"
#include "check/verdict.h"

namespace crescent::inline results {

/// One verdict of one arm in one state other than right or skipped, over all its cases.
struct Finding {
    std::string arm, name;
    State state = State::wrong;
    bool expected = false;  // it is expected, and why stands in `worst`
    std::size_t count = 0, of = 0;
    const char* cases = "w_o";       // what is counted
    const Verdict* worst = nullptr;  // by the evidence, the first where that does not tell
    std::vector<std::pair<std::string, std::vector<std::string>>>
        sentences;        // what the others say beyond the worst, each with its cases
    std::string cause{};  // of the worst, or of another wrong one of the arm
};

/// Wrong ones first, then errors, then what is inconclusive. What was left out for want of time is not among them, and
/// of the errors of one arm the first alone, which counts for all. Points into `result`.
std::vector<Finding> findings_of(const CheckResult& result);
/// "density: wrong at 8 of 8 w_o, worst at w_o 60 deg az 250. The draws do not follow p ..."
std::string describe(const Finding& finding, FrontEnd front_end = FrontEnd::command_line);
/// "Left out: all but valid at 3 of 8 cases (w_o 0 deg, ...). Not looked at: ..."; "" where nothing was.
std::string skipped_text(const CheckResult& result);
/// Sizes of faults that right verdicts would have found, over all cases: "... a constant factor of 0.03 %, ..."; ""
/// where nothing is stated.
std::string unseen_text(const CheckResult& result);
/// What share of the draws drew nothing where that is most, over 1 %; "" where it is nowhere.
std::string nothing_drawn_text(const CheckResult& result);
/// The sentences of a verdict: what was found, its cause, what to try next, what it says of times.
std::string describe(const Verdict& verdict, FrontEnd front_end = FrontEnd::command_line);
/// A text in sentences: each begins with a capital letter.
std::vector<std::string> sentences_of(const std::string& text);
/// All findings but the expected ones, a line each, then what was left out, then the details.
std::string summary_of(const CheckResult& result);
/// What is not right in at most `most_lines` (5 or more) for a failing test: of the first findings what, how large,
/// where and the cause, then the names of the others and what to try next in calls of C++; "" where there is nothing.
std::string what_is_wrong(const CheckResult& result, std::size_t most_lines = 8);

// ---- What stands at the end of a result's table: the density that draws without pdf(w) imply, and what was not
// looked at.

/// A line a w_o of the samplers without pdf(w): the implied density in the mean over rings about n, 1/sr, each with its
/// standard error, and where it is highest; "" where every sampler has one.
std::string implied_text(const CheckResult& result);
/// "Not looked at: reciprocity across the surface, since the index was not told (eta=)."; "" where nothing was left.
std::string not_tested_text(const CheckResult& result);

}  // namespace crescent::inline results
