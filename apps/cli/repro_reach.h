// Lines of Python by which a script without crescent reaches a user's sampler.
#pragma once

#include <cstddef>
#include <string>

#include "crescent/crescent.h"

namespace crescent::cli {

/// How a script reaches the sampler.
struct Reach {
    bool hemisphere = false;
    bool is_reservoir = false;  // the weight of a draw estimates 1/p
    std::string lines;          // of Python: define sample, pdf and f, weigh, and target of a reservoir
};

/// The first line that the program answers.
Handshake handshake_with(const std::string& program);
/// They define ask(verb, *columns), by lines or by blocks. columns: of an answer at most, if answers are lines.
std::string ask_lines(const Handshake& hello, const std::string& program, std::size_t columns);
/// They import `sampler`, as crescent does. word: FILE.py, FILE.py:NAME or module:NAME.
std::string import_lines(const std::string& word);
/// The lines without the functions that the script does not call.
std::string without_unused(const std::string& lines, const std::string& script);

}  // namespace crescent::cli
