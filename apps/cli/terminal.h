// The terminal behind stdout: its width, and whether it shows colours.
#pragma once

#include <cstddef>
#include <span>

#include "crescent/crescent.h"

namespace crescent::cli {

/// `columns`: 0 in a pipe or file, unless the variable COLUMNS has a number of at least 40. `colours`: on a terminal
/// that is not dumb, without the variable NO_COLOR (https://no-color.org).
struct Terminal {
    std::size_t columns = 0;
    bool colours = false;
};

Terminal terminal_of_stdout();
/// Of the summary of a run: as many as the terminal has, 80 at most; 0 in a pipe or file, where no line is cut.
std::size_t columns_of_summary();
/// Prints the lines with marks in the colour of their state. No control character in a text reaches the terminal.
void print_marked(std::span<const ScreenLine> lines, const Terminal& terminal);

}  // namespace crescent::cli
