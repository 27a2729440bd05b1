// The programs that make renders: a command with {view}, {seed} and {out}, several of them at a time, each with a limit
// of time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "compare/image_file.h"

namespace crescent {

/// A command as words. No shell reads them, so names of views cannot be code.
struct RenderCommand {
    std::string text;
    std::vector<std::string> words;  // {out} includes the ending
    std::string extension;           // "png" of {out}.png; "": not stated
    bool has_view() const;
    bool has_seed() const;
    /// Returns the words with {view}, {seed} and {out} replaced.
    std::vector<std::string> for_render(const std::string& view, std::uint64_t seed, const std::string& out) const;
};
/// Splits a command at blanks, which quotes and backslashes may group. Throws InputError with `flag` if a quote is
/// open, {out} is missing, or has two endings.
RenderCommand parse_render_command(const std::string& text, const std::string& flag);

/// One render to make.
struct RenderJob {
    const RenderCommand* command = nullptr;
    std::string view, out;  // out: the whole path
    std::uint64_t seed = 0;
};
struct RenderEnd {
    bool is_made = false;  // the file is there and was read
    std::string failure;   // what the program did instead; "" also if the time was over before it
    double seconds = 0;
    bool is_stopped = false;  // the time was over before the program ended
};

struct RenderLimits {
    int jobs = 1;
    double timeout = 3600;  // s, of one render
    std::chrono::steady_clock::time_point end = std::chrono::steady_clock::time_point::max();
    std::string layer;
    ReadingOptions reading;
};

/// Makes renders, each under a temporary name until it is read: a file that is cut off is never at `out`. Throws
/// Interrupted.
std::vector<RenderEnd> make_renders(
    const std::vector<RenderJob>& jobs, const RenderLimits& limits, const ProgressMonitor& monitor);

}  // namespace crescent
