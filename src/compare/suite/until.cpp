// Rounds: measure the views that have new renders, decide all, make more renders of those that are not decided.
#include "compare/suite/until.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <optional>

#include "base/errors.h"
#include "base/text.h"
#include "compare/suite/decide.h"
#include "compare/suite/measure.h"
#include "output/format.h"

namespace crescent {

namespace {

namespace fs = std::filesystem;

/// Returns the largest number in the names of files, without their folders.
std::uint64_t largest_number(const std::vector<std::string>& paths) {
    std::uint64_t out = 0;
    constexpr std::size_t most_digits = 9;  // longer ones are dates or hashes, and no seeds
    for (const std::string& path : paths) {
        const std::string name = fs::path(path).stem().string();
        for (std::size_t i = 0; i < name.size();) {
            std::size_t end = i;
            while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end]))) ++end;
            if (end > i && end - i <= most_digits)
                out = std::max<std::uint64_t>(out, std::stoull(name.substr(i, end - i)));
            i = std::max(end, i + 1);
        }
    }
    return out;
}

/// Returns the path of a render of a side: that of the first pattern with one wildcard, which takes the seed.
std::string path_of_render(const std::vector<FilePattern>& patterns, const std::string& view, std::uint64_t seed,
    const std::string& extension) {
    for (const FilePattern& pattern : patterns) {
        if (const auto path = pattern.path(view, {std::to_string(seed)})) return *path;
        if (const auto path = pattern.path(view, {std::to_string(seed), extension})) return *path;
    }
    if (patterns.empty()) throw InputError({"--render", 0, 0}, "expected suite.candidate, the pattern of new renders");
    throw InputError(patterns.front().location(),
        fmt::format("--render: expected a pattern with {{view}} and one wildcard, for the seed, found '{}'",
            patterns.front().text()));
}

/// One view on its way to a decision.
struct Undecided {
    std::size_t index = 0;  // in the suite
    std::uint64_t next_seed = 1;
    std::uint64_t next_baseline_seed = 0;  // of a baseline that is made too
    unsigned looks = 0;
    bool is_decided = false;
    std::size_t render_count = 0;
    double seconds[2] = {0, 0};  // of the renders of each side that were made
    std::size_t count[2] = {0, 0};
    double longest_stop = 0;  // the longest time of a program that did not end within the budget
    std::string failure;
    std::optional<ViewResult> outcome;
};

class Rounds {
public:
    Rounds(Suite& suite, const RenderSides& sides, const Renderer& render, const RenderSource& source,
        const UntilOptions& options, ProgressMonitor& monitor)
        : suite_(suite), sides_(sides), render_(render), source_(source), options_(options), monitor_(monitor) {
        for (std::size_t k = 0; k < suite.views.size(); ++k) {
            Undecided& view = views_.emplace_back();
            view.index = k;
            const SuiteView& files = suite.views[k];
            const std::uint64_t last = std::max(largest_number(files.baseline), largest_number(files.candidate));
            view.next_seed = last + 1;
            // Seeds of two sides that are made differ by this, unless they are to be the same.
            constexpr std::uint64_t seed_distance = 500'000'000;
            view.next_seed = sides.baseline && !sides.same_seeds ? std::max(last + 1, seed_distance + 1) : last + 1;
            view.next_baseline_seed = largest_number(files.baseline) + 1;
            if (sides.same_seeds) view.next_seed = largest_number(files.candidate) + 1;
        }
    }

    SuiteResult result() {
        monitor_.begin("views that are decided", static_cast<double>(views_.size()));
        std::size_t reported_count = 0;
        for (;;) {
            SuiteResult out = decision();
            const std::size_t decided_count = static_cast<std::size_t>(
                std::count_if(views_.begin(), views_.end(), [](const Undecided& v) { return v.is_decided; }));
            monitor_.advance(static_cast<double>(decided_count - reported_count));
            reported_count = decided_count;
            monitor_.check();
            if (decided_count < views_.size() && std::chrono::steady_clock::now() < options_.end && add_renders())
                continue;
            for (std::size_t k = 0; k < views_.size(); ++k) add_stop(views_[k], out.views[k]);
            return out;
        }
    }

private:
    /// Measures the views with new renders, and decides all of them together.
    SuiteResult decision() {
        SuiteResult out;
        std::size_t compared = 0;  // all that will be: the level may not depend on what is there yet
        for (const SuiteView& view : suite_.views) compared += sides_.baseline || !view.baseline.empty();
        for (Undecided& view : views_) {
            const SuiteView& files = suite_.views[view.index];
            if (!view.is_decided && view.failure.empty()) measure(view, files, std::max<std::size_t>(1, compared));
            out.views.push_back(view.outcome.value_or(ViewResult{}));
            ViewResult& to = out.views.back();
            to.name = files.name;
            if (view.failure.empty()) continue;
            to.state = ViewState::unreadable;
            to.sentence = view.failure;
        }
        decide(suite_, out);
        for (std::size_t k = 0; k < views_.size(); ++k) finish(views_[k], out.views[k]);
        return out;
    }

    /// States that a program was stopped at the end of the budget, if it ran for longer than others of the view.
    static void add_stop(const Undecided& view, ViewResult& to) {
        constexpr double usual = 2;  // times the mean of the others
        const double mean =
            view.render_count == 0 ? 0 : (view.seconds[0] + view.seconds[1]) / static_cast<double>(view.render_count);
        if (view.longest_stop <= usual * mean || to.state != ViewState::too_few) return;
        const std::string sentence = fmt::format(
            " The program was stopped after {} s, at the end of the budget.", figures(view.longest_stop, 3));
        to.sentence += sentence;
        if (to.headline.size() + sentence.size() <= longest_headline) to.headline += sentence;
    }

    /// Whether renders of a side are still to be made for the first time.
    bool awaits_renders(const SuiteView& files) const {
        return sides_.baseline ? files.baseline.empty() || files.candidate.empty()
                               : files.candidate.empty() && !files.baseline.empty();
    }

    void measure(Undecided& view, const SuiteView& files, std::size_t compared) {
        if (awaits_renders(files)) {
            ViewResult& none = view.outcome.emplace();
            none.state = ViewState::too_few;
            none.too_few = "no render was made yet";
            none.baseline_renders = files.baseline.size();
            none.candidate_renders = files.candidate.size();
            none.renders_needed = first_renders;
            return;
        }
        try {
            suite_.look_number = ++view.looks;
            view.outcome = measure_view(suite_, files, compared, monitor_, source_);
            check_seeds(view, files);
        } catch (const InputError& error) { view.failure = error.what(); }
        suite_.look_number = 0;
    }

    /// Names programs whose renders do not depend on their seeds. If those of one side alone are equal, the view is
    /// unreadable; if those of each side are, or both sides have the same, no number of renders shows anything.
    void check_seeds(Undecided& view, const SuiteView& files) {
        ViewResult& outcome = *view.outcome;
        const bool a = is_constant(outcome.baseline_hashes), b = is_constant(outcome.candidate_hashes);
        if (a != b) {
            if (outcome.uniform) return;  // such as black: a change, whatever the seeds are
            const RenderCommand* command = b ? &sides_.candidate : sides_.baseline ? &*sides_.baseline : nullptr;
            const std::vector<std::string>& other = b ? files.baseline : files.candidate;
            if (!command || other.size() < 2) return;
            view.failure =
                fmt::format("The program {}: its renders of {} are equal, those of the other side are not: {}",
                    command->has_seed() ? "ignores the seed" : "gets no seed, because {seed} is not in its command",
                    files.name, printable(command->text, 200));
        } else if (sides_.baseline && a && !suite_.tolerance(files)) {
            outcome.untestable = "the renders of each side are equal, " + why_equal();
            outcome.remedy =
                "Write {seed} where the program takes the seed of its random numbers, such as '--seed {seed}'. Renders "
                "without noise are compared with a tolerance: --tolerance '0 ulp'.";
        } else if (sides_.baseline && !a && !sides_.same_seeds) {
            const std::optional<std::array<std::uint64_t, 2>> seeds = seeds_of_equal_renders(files, outcome);
            if (!seeds) return;
            outcome.untestable = fmt::format(
                "both sides have the same noise: the renders of a with seed {} and of b with seed {} are equal",
                (*seeds)[0], (*seeds)[1]);
            outcome.remedy = sides_.baseline->has_seed() && sides_.candidate.has_seed()
                ? "Make the program use all digits of its seed, or give --pair if both sides are to have the same "
                  "noise."
                : "Write {seed} in both commands, where the program takes the seed of its random numbers.";
        }
    }

    /// Whether all of several renders of a side have the same pixels.
    static bool is_constant(const std::vector<std::uint64_t>& hashes) {
        return hashes.size() > 1 && std::ranges::count(hashes, hashes.front()) == std::ssize(hashes);
    }

    /// Why the renders of each side are equal.
    std::string why_equal() const {
        const bool a = sides_.baseline->has_seed(), b = sides_.candidate.has_seed();
        if (a && b) return "although their seeds differ: the programs ignore {seed}";
        if (!a && !b) return "and neither command has {seed}";
        return fmt::format("and --{} has no {{seed}}", a ? "b" : "a");
    }

    /// Returns the seed of a render of two commands, whose name ends with it.
    static std::uint64_t seed_in_name(const std::string& path) {
        const std::string name = fs::path(path).stem().string();
        return largest_number({name.substr(name.rfind('-') + 1)});
    }

    /// Returns the seeds of two renders of different seeds and sides with the same pixels; nothing if there are none.
    static std::optional<std::array<std::uint64_t, 2>> seeds_of_equal_renders(
        const SuiteView& files, const ViewResult& outcome) {
        for (std::size_t i = 0; i < files.baseline.size(); ++i)
            for (std::size_t j = 0; j < files.candidate.size(); ++j) {
                if (outcome.baseline_hashes[i] != outcome.candidate_hashes[j]) continue;
                const std::uint64_t a = seed_in_name(files.baseline[i]), b = seed_in_name(files.candidate[j]);
                if (a != b) return std::array{a, b};
            }
        return {};
    }

    /// Notes whether a view needs more renders, and completes its sentences.
    void finish(Undecided& view, ViewResult& to) {
        const bool has_few_renders = to.candidate_renders < first_renders && !to.exact;
        const bool is_open = to.state == ViewState::too_few || (has_few_renders && to.state != ViewState::changed);
        view.is_decided = !is_open || to.state == ViewState::unreadable || !to.untestable.empty();
        if (view.render_count > 0)
            to.notes.push_back(fmt::format("{} made in {} s of the programs.", plural(view.render_count, "render"),
                figures(view.seconds[0] + view.seconds[1], 3)));
        if (to.state == ViewState::too_few && to.renders_needed) {
            const std::size_t missing_count = *to.renders_needed - std::min(*to.renders_needed, to.candidate_renders);
            to.headline = fmt::format("Undecided: {}{}.",
                plural(std::max<std::size_t>(1, missing_count), "more render"), sides_.baseline ? " of each side" : "");
            if (!sides_.baseline && *to.renders_needed > to.baseline_renders)
                to.headline +=
                    fmt::format(" The baseline has {} of {} that it needs.", to.baseline_renders, *to.renders_needed);
        }
        if (sides_.baseline) compare_speed(view, to);
    }

    /// States which side has less noise at equal time: the variance of a pixel times the seconds of a render.
    void compare_speed(const Undecided& view, ViewResult& to) const {
        if (view.count[0] == 0 || view.count[1] == 0 || to.variances.empty()) return;
        const VarianceTest& frame = to.variances.back();
        const double a = frame.baseline * view.seconds[0] / static_cast<double>(view.count[0]),
                     b = frame.candidate * view.seconds[1] / static_cast<double>(view.count[1]);
        if (!(a > 0) || !(b > 0)) return;
        to.notes.push_back(fmt::format("At equal time b has {} times the variance of a ({} and {} s a render).",
            figures(b / a, 3), figures(view.seconds[0] / static_cast<double>(view.count[0]), 3),
            figures(view.seconds[1] / static_cast<double>(view.count[1]), 3)));
    }

    /// Returns how many renders a side that has `count` gets next: a quarter more, at most to what is needed.
    std::size_t next_count(const Undecided& view, std::size_t count) const {
        if (count < first_renders) return first_renders;
        const std::size_t step = std::max<std::size_t>(1, count / 4);
        std::size_t next = count + step;
        if (view.outcome && view.outcome->renders_needed)
            next = std::clamp(*view.outcome->renders_needed, count + 1, count + 2 * step);
        return std::min(next, options_.most_renders);
    }

    void add_jobs(Undecided& view, bool baseline, std::vector<RenderJob>& jobs,
        std::vector<std::pair<Undecided*, bool>>& owners) {
        const SuiteView& files = suite_.views[view.index];
        const std::vector<std::string>& side = baseline ? files.baseline : files.candidate;
        const RenderCommand& command = baseline ? *sides_.baseline : sides_.candidate;
        const auto& patterns = baseline ? suite_.baseline : suite_.candidate;
        // A baseline that is fixed limits what more renders of the candidate can show.
        constexpr std::size_t most_over_baseline = 4;
        if (!sides_.baseline && side.size() >= most_over_baseline * std::max(first_renders, files.baseline.size()))
            return;
        const std::size_t count = next_count(view, side.size());
        std::uint64_t& seed = baseline ? view.next_baseline_seed : view.next_seed;
        for (std::size_t k = side.size(); k < count; ++k, ++seed) {
            const std::string& extension = sides_.extension_of(command);
            const std::string path = path_of_render(patterns, files.name, seed, extension);
            if (!command.extension.empty() && !path.ends_with("." + extension))
                throw InputError({"--render", 0, 0},
                    fmt::format("expected {{out}} with the ending of the pattern, as in {}, found {{out}}.{}", path,
                        extension));
            jobs.push_back({&command, files.name, path, seed});
            owners.emplace_back(&view, baseline);
        }
    }

    /// Makes the next renders; returns whether there were any to make, and some were made or failed.
    bool add_renders() {
        std::vector<RenderJob> jobs;
        std::vector<std::pair<Undecided*, bool>> owners;
        for (Undecided& view : views_) {
            if (view.is_decided || !view.failure.empty()) continue;
            if (sides_.baseline) add_jobs(view, true, jobs, owners);
            if (!suite_.views[view.index].baseline.empty() || sides_.baseline) add_jobs(view, false, jobs, owners);
        }
        if (jobs.empty()) return false;
        monitor_.log(fmt::format("{} of {} decided; making {}",
            std::ranges::count_if(views_, [](const Undecided& v) { return v.is_decided; }),
            plural(views_.size(), "view"), plural(jobs.size(), "render")));
        const std::vector<RenderEnd> ends = render_(jobs);
        bool has_progress = false;
        for (std::size_t k = 0; k < jobs.size(); ++k) {
            const auto [view, baseline] = owners[k];
            const RenderEnd& end = ends[k];
            has_progress |= end.is_made || !end.failure.empty();
            if (end.is_stopped) view->longest_stop = std::max(view->longest_stop, end.seconds);
            if (!end.failure.empty() && view->failure.empty())
                view->failure = fmt::format(
                    "The program {} for seed {}: {}", end.failure, jobs[k].seed, printable(jobs[k].command->text, 200));
            if (!end.is_made) continue;
            SuiteView& files = suite_.views[view->index];
            std::vector<std::string>& side = baseline ? files.baseline : files.candidate;
            side.insert(std::lower_bound(side.begin(), side.end(), jobs[k].out), jobs[k].out);
            ++view->render_count;
            ++view->count[baseline ? 0 : 1];
            view->seconds[baseline ? 0 : 1] += end.seconds;
        }
        return has_progress;
    }

    Suite& suite_;
    const RenderSides& sides_;
    const Renderer& render_;
    const RenderSource& source_;
    const UntilOptions& options_;
    ProgressMonitor& monitor_;
    std::vector<Undecided> views_;
};

}  // namespace

SuiteResult decide_by_renders(Suite& suite, const RenderSides& sides, const Renderer& render,
    const RenderSource& source, const UntilOptions& options, ProgressMonitor& monitor) {
    return Rounds(suite, sides, render, source, options, monitor).result();
}

std::vector<std::string> views_of_commands(const RenderSides& sides, const std::vector<std::string>& views) {
    ensure(sides.baseline.has_value(), "two commands");
    const bool has_view = sides.baseline->has_view() || sides.candidate.has_view();
    if (has_view == views.empty())
        throw InputError({"--views", 0, 0},
            has_view ? "expected the views, such as --views a,b: the command has {view}"
                     : "expected {view} in --a or --b");
    for (const std::string& name : views)
        if (name.empty() || name.find('/') != std::string::npos || name.front() == '.')
            throw InputError({"--views", 0, 0},
                fmt::format("expected names of views without '/', that do not begin with '.', found '{}'", name));
    return views.empty() ? std::vector<std::string>{"render"} : views;
}

Suite suite_of_commands(
    const RenderSides& sides, const std::vector<std::string>& views, const std::string& folder, const Suite& stated) {
    Suite out;
    out.options = stated.options;
    for (const char* side : {"a", "b"}) {
        const RenderCommand& command = *side == 'a' ? *sides.baseline : sides.candidate;
        const std::string pattern = escape_pattern(folder) + "/" + side + "/{view}-*." + sides.extension_of(command);
        const SourceLocation place{fmt::format("--{}", side), 0, 0};
        (*side == 'a' ? out.options.baseline : out.options.candidate) = {pattern};
        (*side == 'a' ? out.baseline : out.candidate).emplace_back(pattern, place, true);
    }
    for (const std::string& name : views) {
        const auto entry = std::ranges::find(stated.views, name, &SuiteView::name);
        SuiteView& view = out.views.emplace_back(entry == stated.views.end() ? SuiteView{} : *entry);
        view.name = name;
    }
    for (const bool baseline : {true, false})
        for (const FilePattern& pattern : baseline ? out.baseline : out.candidate)
            for (const MatchedFile& file : pattern.find())
                for (SuiteView& view : out.views)
                    if (view.name == file.view) (baseline ? view.baseline : view.candidate).push_back(file.path);
    return out;
}

}  // namespace crescent
