// The progress of a run on stderr: one line that is redrawn on a terminal, a line per stage in a log.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "crescent/crescent.h"

namespace crescent::cli {

class Progress : public ProgressMonitor {
public:
    enum class Style { bar, lines, silent };

    explicit Progress(Style style) : style_(style) {}
    ~Progress() override { clear(); }

    void begin(std::string_view what, double total) override;
    void advance(double units) override;
    void skip(double units) override;
    void log(std::string_view line) override;
    /// Shown by a silent one too.
    void warn(std::string_view line) override;
    /// Removes the bar from the terminal.
    void clear();

    /// Returns a bar if stderr is a terminal that can redraw a line, else lines.
    static Style fitting();

private:
    using Clock = std::chrono::steady_clock;

    void draw();
    void print_line(std::string_view line);
    double seconds() const;

    Style style_;
    std::atomic<double> units_{0}, total_{0};
    std::atomic<std::int64_t> next_draw_{0};  // ns of Clock
    std::mutex drawing_;                      // guards what follows
    std::string what_;
    Clock::time_point start_ = Clock::now();
    bool is_drawn_ = false;
};

/// "[#####-----]  50 %  412 M/s  0:07 left  seed 3 of 16", at most 79 columns.
std::string progress_line(std::string_view what, double units, double total, double seconds);

}  // namespace crescent::cli
