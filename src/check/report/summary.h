// The summary of a result: one line for each finding over all w_o, worst first.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "check/report/print.h"
#include "check/verdict.h"

namespace crescent {

/// A verdict of one arm in one state other than right or skipped, over all its cases.
struct Finding {
    std::string arm, name;
    State state = State::wrong;
    bool expected = false;  // expected, with the reason in `worst`
    std::size_t count = 0, total = 0;
    const char* cases = "w_o";       // unit of the counts
    const Verdict* worst = nullptr;  // largest deviation in the evidence, else the first
    std::vector<std::pair<std::string, std::vector<std::string>>>
        sentences;              // that state something else than those of the worst, each with its cases
    std::string range{};        // " (75 to 89 deg)": of the w_o, if it is not found at all of them
    std::string cause{};        // of the worst, or of another wrong verdict of the arm
    std::string named_cause{};  // of one of its verdicts: the summary has each cause once
};

/// Wrong findings first, then errors, then inconclusive ones. Verdicts that were left out for lack of time are not
/// included, and all errors of one arm count as its first. The result contains pointers into `result`.
std::vector<Finding> findings_of(const CheckResult& result);
/// "density: wrong at 8 of 8 w_o, worst at w_o 60 deg az 250. The draws do not follow p ..."
std::string describe(const Finding& finding, FrontEnd front_end = FrontEnd::command_line);
/// Of an error, what follows its state: ": 72 of 72 verdicts could not be evaluated, the first at w_o 0 deg. ..."
std::string failure_text(const Finding& finding, FrontEnd front_end = FrontEnd::command_line);
/// "at 3 of 8 w_o (75 to 89 deg), worst at w_o 89 deg az 180"; "" for a sampler that is checked once, without w_o.
std::string where_found(const Finding& finding);
/// "Left out: all but valid at 3 of 8 w_o (w_o 0 deg; ...). ..."; "" if nothing was left out.
std::string skipped_text(const CheckResult& result);
/// Sizes of faults that right verdicts would have found, over all cases: "... a constant factor of 0.03 %, ..."; "" if
/// there are none.
std::string unseen_text(const CheckResult& result);
/// The largest share of draws without a sample, if it exceeds 1 %; otherwise "".
std::string nothing_drawn_text(const CheckResult& result);
/// Those of the three texts that are not empty, in the order skipped, nothing drawn, unseen.
std::vector<std::string> closing_texts(const CheckResult& result);
/// The sentences of a verdict: message, cause, next step and time.
std::string describe(const Verdict& verdict, FrontEnd front_end = FrontEnd::command_line);
/// The text with a space for each line break.
std::string in_one_line(std::string text);
/// All findings except expected ones, one line each, then what was left out.
std::string summary_of(const CheckResult& result);
/// What the findings of the summary state at other w_o than the worst, each sentence once, with its cases.
std::string details_of(const CheckResult& result);
/// The findings in at most `most_lines` (5 or more), for a failing test: message, size, place and cause of the first
/// ones, then the names of the others and the next step in calls of C++; "" if there are none.
std::string what_is_wrong(const CheckResult& result, std::size_t most_lines = 8);
/// What a check without a fault skipped or left out, and the sizes of the faults it would have found: a line each.
std::string what_was_tested(const CheckResult& result);

/// One line for each w_o of a sampler without pdf(w): the mean of the implied density over rings about n, 1/sr, each
/// with its standard error, and its maximum; "" if every sampler has a pdf(w).
std::string implied_text(const CheckResult& result);

}  // namespace crescent
