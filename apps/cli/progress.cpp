// Rate and time left follow from the units done over the seconds since the stage began. Any thread may count; one that
// gets the lock without waiting redraws the line, at most ten times a second.
#include "progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <unistd.h>

#include "commands.h"

namespace crescent::cli {

namespace {

constexpr std::size_t columns = 79;  // one short of 80: a full line wraps on some terminals
constexpr int bar_cells = 24;
constexpr std::chrono::milliseconds interval{100};

std::string rate(double per_second) {
    for (const auto& [scale, letter] : {std::pair{1e9, "G"}, {1e6, "M"}, {1e3, "k"}})
        if (per_second >= scale) return fmt::format("{:.3g} {}/s", per_second / scale, letter);
    return fmt::format("{:.3g} /s", per_second);
}

std::string minutes(double seconds) {
    const long whole_seconds = std::lround(std::min(seconds, 359999.0));
    if (whole_seconds >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole_seconds / 3600, whole_seconds / 60 % 60, whole_seconds % 60);
    return fmt::format("{}:{:02}", whole_seconds / 60, whole_seconds % 60);
}

void to_stderr(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

std::string progress_line(std::string_view what, double units, double total, double seconds) {
    const double part = total > 0 ? std::clamp(units / total, 0.0, 1.0) : 0;
    const auto cells = static_cast<std::size_t>(std::lround(part * bar_cells));
    std::string line = fmt::format(
        "[{}{}] {:3.0f} %", std::string(cells, '#'), std::string(bar_cells - cells, '-'), std::floor(100 * part));
    if (seconds > 0.2 && units > 0) {
        line += fmt::format("  {:>9}", rate(units / seconds));
        if (total > units) line += fmt::format("  {} left", minutes(seconds * (total - units) / units));
    }
    line += "  ";
    line += what;
    return line.substr(0, columns);
}

Progress::Style Progress::fitting() {
    const char* term = std::getenv("TERM");
    const bool is_dumb = !term || std::string_view(term) == "dumb";
    return ::isatty(STDERR_FILENO) && !is_dumb ? Style::bar : Style::lines;
}

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::begin(std::string_view what, double total) {
    const std::lock_guard lock(drawing_);
    what_ = printable(what);
    units_ = 0;
    total_ = total;
    start_ = Clock::now();
    if (style_ == Style::lines) print_to_stderr(what_ + "\n");
    if (style_ == Style::bar) draw();
}

void Progress::advance(double units) {
    units_.fetch_add(units, std::memory_order_relaxed);
    if (style_ != Style::bar) return;
    const std::int64_t now = Clock::now().time_since_epoch().count();
    if (now < next_draw_.load(std::memory_order_relaxed)) return;
    const std::unique_lock lock(drawing_, std::try_to_lock);
    if (lock.owns_lock() && now >= next_draw_) draw();
}

void Progress::skip(double units) { total_.fetch_sub(units, std::memory_order_relaxed); }

void Progress::draw() {
    next_draw_ = (Clock::now() + interval).time_since_epoch().count();
    to_stderr("\r" + progress_line(what_, units_, total_, seconds()) + "\x1b[K");
    is_drawn_ = true;
}

void Progress::log(std::string_view line) {
    if (style_ != Style::silent) print_line(line);
}

void Progress::warn(std::string_view line) { print_line("warning: " + std::string(line)); }

void Progress::print_line(std::string_view line) {
    clear();
    const std::lock_guard lock(drawing_);
    print_to_stderr(std::string(line) + "\n");
}

void Progress::clear() {
    const std::lock_guard lock(drawing_);
    if (is_drawn_) to_stderr("\r\x1b[K");
    is_drawn_ = false;
}

}  // namespace crescent::cli
