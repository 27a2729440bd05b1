// crescent compare --render CMD, and --a CMD --b CMD: the renders are made here.
#include <charconv>
#include <chrono>
#include <fmt/format.h>

#include "commands.h"
#include "crescent/crescent.h"
#include "progress.h"

namespace crescent::cli {

namespace {

/// "90", "90s", "10min", "2h" in seconds; InputError with the flag.
double seconds_of(const char* flag, const std::string& text) {
    const std::size_t end = text.find_first_not_of("0123456789.");
    const std::string number = text.substr(0, end), unit = end == std::string::npos ? "s" : text.substr(end);
    const double factor = unit == "s" ? 1 : unit == "min" || unit == "m" ? 60 : unit == "h" ? 3600 : 0;
    double value = 0;
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (factor == 0 || error != std::errc{} || stop != number.data() + number.size() || !(value > 0))
        throw InputError({fmt::format("{} {}", flag, text), 0, 0}, "expected a time above 0, such as 90s, 10min or 2h");
    return value * factor;
}

/// The extension that both patterns of the candidate leave open: that of an existing render, else OpenEXR.
std::string extension_for(const Suite& suite) {
    for (const SuiteView& view : suite.views)
        for (const auto* side : {&view.candidate, &view.baseline})
            for (const std::string& path : *side)
                if (const std::size_t dot = path.rfind('.'); dot != std::string::npos) return path.substr(dot + 1);
    return "exr";
}

RenderSides sides_of(const CompareFlags& flags) {
    RenderSides out;
    if (flags.render.empty()) {
        out.baseline = parse_render_command(flags.a, "--a");
        out.candidate = parse_render_command(flags.b, "--b");
    } else out.candidate = parse_render_command(flags.render, "--render");
    out.same_seeds = flags.pair;
    return out;
}

}  // namespace

Suite suite_of_two(const CompareFlags& flags, std::vector<CompareFlag> keys) {
    if (flags.a.empty() || flags.b.empty() || !flags.render.empty() || !flags.file.empty())
        throw InputError({flags.a.empty() ? "--a" : "--b", 0, 0}, "expected both --a and --b, and no suite file");
    const std::string out = flags.out.empty() ? "out/compare" : flags.out;
    const RenderSides sides = sides_of(flags);
    const std::vector<std::string> views = views_of_commands(sides, flags.made_views);
    for (const std::string& view : views)
        for (const std::string& region : flags.regions) {
            const auto [name, box] = name_and_value("--region", region, "NAME=x0,y0,x1,y1");
            keys.push_back({{"view", view, "regions", name, "box"}, "[" + box + "]", true, "--region " + region});
        }
    Suite suite = read_suite_flags(keys);
    suite.options.noise = NoiseDemand::ignore;  // two algorithms have one mean, and each its own noise
    suite.options.title = "two programs: a is the baseline, b the candidate";
    return suite_of_commands(sides, views, out + "-renders", suite);
}

SuiteResult make_renders_of(const CompareFlags& flags, Suite& suite, Progress& progress) {
    if (!flags.until.empty() && flags.until != "decided")
        throw InputError({"--until " + flags.until, 0, 0}, "expected --until decided");
    RenderSides sides = sides_of(flags);
    if (!flags.render.empty()) sides.extension = extension_for(suite);
    RenderLimits limits;
    limits.jobs = flags.jobs;
    limits.layer = suite.options.layer;
    limits.reading = suite.options.reading();
    if (!flags.timeout.empty()) limits.timeout = seconds_of("--timeout", flags.timeout);
    UntilOptions options;
    const double budget = seconds_of("--budget", flags.budget.empty() ? "10min" : flags.budget);
    options.end = limits.end = std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(budget));
    const auto render = [&](const std::vector<RenderJob>& jobs) { return make_renders(jobs, limits, progress); };
    return decide_by_renders(suite, sides, render, files_read_with(suite.options.reading()), options, progress);
}

}  // namespace crescent::cli
