// crescent makes the renders of a suite: more of each view that is not decided, until it is or the time is over. The
// decision may be taken after any render, because its tests hold at any time (anytime.h).
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/suite/render_command.h"
#include "compare/suite/suite.h"

namespace crescent {

/// Makes some renders; the results are in the order of the jobs.
using Renderer = std::function<std::vector<RenderEnd>(const std::vector<RenderJob>&)>;

/// What makes the renders of each side.
struct RenderSides {
    std::optional<RenderCommand> baseline;  // none: its renders are there
    RenderCommand candidate;
    bool same_seeds = false;        // both sides have the same
    std::string extension = "exr";  // of files whose pattern and command leave it open
    const std::string& extension_of(const RenderCommand& command) const {
        return command.extension.empty() ? extension : command.extension;
    }
};

/// When to stop, and how many renderers run at a time.
struct UntilOptions {
    std::chrono::steady_clock::time_point end = std::chrono::steady_clock::time_point::max();
    std::size_t most_renders = 1000;  // of a side of a view
    unsigned jobs = 1;                // rounds have at least as many renders
};

/// The first number of renders of a side: with fewer, the variance is hardly known.
inline constexpr std::size_t first_renders = 4;

/// Makes renders and decides. `suite` receives the new files. Views whose program fails are unreadable, with what it
/// did. Throws Interrupted.
SuiteResult decide_by_renders(Suite& suite, const RenderSides& sides, const Renderer& render,
    const RenderSource& source, const UntilOptions& options, ProgressMonitor& monitor);

/// Returns the views that two commands render: `views`, or one called "render". Throws InputError.
std::vector<std::string> views_of_commands(const RenderSides& sides, const std::vector<std::string>& views);
/// Returns the suite of two commands, as `stated` besides its views: renders of `views` below `folder`, those of the
/// first command as the baseline. What `stated` says about a view holds for it.
Suite suite_of_commands(
    const RenderSides& sides, const std::vector<std::string>& views, const std::string& folder, const Suite& stated);

}  // namespace crescent
