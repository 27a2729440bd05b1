// The first view of one sampler on a terminal: at most 12 lines.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "check/report/print.h"
#include "check/verdict.h"

namespace crescent {

/// A line with its mark. `head` is short and may be coloured; `text` may have several rows, the later ones indented.
struct ScreenLine {
    std::optional<State> state;  // of the mark; none: no mark
    std::string head, text;
};

/// One line for each verdict, wrong ones first; what does not fit in 12 rows is shortened, right verdicts first.
/// `columns`: where rows are broken; 0: nowhere.
std::vector<ScreenLine> screen_of(
    const CheckResult& result, std::size_t columns = 0, FrontEnd front_end = FrontEnd::command_line);
const char* mark_of(State state);
/// The lines of screen_of() without colours.
std::string verdict_screen(const CheckResult& result, FrontEnd front_end = FrontEnd::command_line);
/// Whether all verdicts are of one sampler, so that a screen can show them.
bool one_sampler(const CheckResult& result);

}  // namespace crescent
