// Width, colours and marks of the lines that `crescent check` prints.
#include "terminal.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "commands.h"

namespace crescent::cli {

namespace {

constexpr std::size_t least_columns = 40, most_columns = 120;  // longer rows are hard to read

/// SGR codes of ECMA-48.
const char* colour_of(State state) {
    switch (state) {
        case State::right: return "32";         // green
        case State::wrong: return "1;31";       // bold red
        case State::inconclusive: return "33";  // yellow
        case State::skipped: return "2";        // faint
        case State::error: return "1;35";       // bold magenta
    }
    return "0";
}

std::size_t columns_of_environment() {
    const char* variable = std::getenv("COLUMNS");
    const std::string_view text = variable ? variable : "";
    std::size_t columns = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), columns);
    return error == std::errc{} && end == text.data() + text.size() && columns >= least_columns ? columns : 0;
}

}  // namespace

Terminal terminal_of_stdout() {
    if (!::isatty(STDOUT_FILENO)) return {columns_of_environment(), false};
    winsize size{};
    const bool has_size = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    const char* term = std::getenv("TERM");
    const char* no_colour = std::getenv("NO_COLOR");
    return {std::clamp<std::size_t>(has_size ? size.ws_col : 80, least_columns, most_columns),
        term && std::string_view(term) != "dumb" && !(no_colour && *no_colour)};
}

std::size_t columns_of_summary() {
    constexpr std::size_t widest = 80;
    return std::min(terminal_of_stdout().columns, widest);
}

void print_marked(std::span<const ScreenLine> lines, const Terminal& terminal) {
    std::string out;
    for (const ScreenLine& line : lines) {
        const std::string head = (line.state ? std::string(mark_of(*line.state)) + " " : "") + printable(line.head);
        const bool has_colour = line.state && terminal.colours;
        out += has_colour ? fmt::format("\x1b[{}m{}\x1b[0m", colour_of(*line.state), head) : head;
        out += printable_lines(line.text) + "\n";
    }
    print_as_it_is(out);
}

}  // namespace crescent::cli
