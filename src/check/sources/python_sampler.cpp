// crescent.serve of the Python package answers in the pipe protocol.
#include "check/sources/python_sampler.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace crescent::inline sources {

bool names_python_sampler(const std::string& word) {
    if (word.ends_with(".py")) return true;
    const auto in_name = [](char c) {
        return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    };
    const std::size_t colon = word.rfind(':');
    if (colon == std::string::npos || colon == 0) return false;
    const std::string where = word.substr(0, colon), name = word.substr(colon + 1);
    if (name.empty() || !std::ranges::all_of(name, in_name)) return false;
    return where.ends_with(".py") || std::ranges::all_of(where, [&](char c) { return in_name(c) || c == '.'; });
}

std::shared_ptr<const ProgramSampler> start_python_sampler(const std::string& word, const PipeLimits& limits) {
    const char* given = std::getenv("CRESCENT_PYTHON");
    const std::string python = given && *given ? given : "python3";
    // -P: a file in the current folder does not replace a module that the package imports. An interpreter that the
    // shell cannot start (126, 127) is reported in the same way as a missing package.
    const std::string command = fmt::format(
        "{} -P -m crescent.serve {}; code=$?; [ $code -lt 126 ] || [ $code -gt 127 ] "
        "|| code=1; exit $code",
        shell_word(python), shell_word(word));
    try {
        return start_pipe(command, limits, word);
    } catch (const SamplerTimeout&) { throw; } catch (const SamplerError& error) {
        if (std::string_view(error.what()).find("exit code 1") == std::string_view::npos) throw;
        throw OutputError(fmt::format(
            "{}: '{}' cannot run the module crescent.serve: install the package with `pip install crescent-bench`, or "
            "set CRESCENT_PYTHON to an interpreter that has it",
            word, python));
    }
}

}  // namespace crescent::inline sources
