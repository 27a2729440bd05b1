// The new folder of the baseline is written next to the old one and exchanged with it (base/files.h). Files of views
// that are not accepted are linked into it. Candidates are copied first, and the copies are measured.
#include "compare/suite/accept.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/files.h"
#include "base/text.h"
#include "compare/moments.h"
#include "compare/renders.h"
#include "compare/suite/manifest.h"
#include "compare/suite/measure.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_file.h"
#include "experiment/parser.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent {

namespace {

namespace fs = std::filesystem;

/// A candidate's file, its name in the folder of the baseline, and its copy.
struct Accepted {
    std::string from, name, copy;
};

/// Returns the path in the baseline of a candidate's file, or of the `number`-th file if the wildcards differ.
std::string path_in_baseline(
    const FilePattern& target, const FilePattern& candidate, const MatchedFile& file, std::size_t number) {
    auto path = target.path(file.view, file.wildcards);
    if (!path) path = target.path(file.view, {fmt::format("{:03}", number)});
    if (!path)
        throw InputError(target.location(),
            fmt::format("no name for {} follows from the pattern '{}': expected as many wildcards as in '{}'",
                file.path, target.text(), candidate.text()));
    const auto match = target.match(*path);
    if (!match || match->view != file.view)
        throw InputError(target.location(),
            fmt::format("{} would be stored as {}, which the pattern '{}' does not match: expected a pattern that does",
                file.path, *path, target.text()));
    return *path;
}

std::vector<Accepted> files_to_accept(const Suite& suite, const SuiteView& view, const std::string& folder) {
    std::vector<Accepted> out;
    const std::vector<std::vector<MatchedFile>> files = files_of_patterns(suite.candidate);
    for (std::size_t p = 0; p < suite.candidate.size(); ++p) {
        const FilePattern& target = suite.baseline[suite.baseline.size() == suite.candidate.size() ? p : 0];
        for (const MatchedFile& file : files[p]) {
            if (file.view != view.name) continue;
            const std::string path = path_in_baseline(target, suite.candidate[p], file, out.size() + 1);
            out.push_back({file.path, name_in(folder, path), {}});
        }
    }
    std::map<std::string, std::string> names;
    for (const Accepted& file : out) {
        const auto [entry, is_new] = names.emplace(file.name, file.from);
        if (!is_new)
            throw InputError({file.from, 0, 0},
                fmt::format(
                    "expected a name of its own in the baseline, found that of {}: {}", entry->second, file.name));
    }
    return out;
}

/// Returns the name of the moments of a view: "moments" in place of the wildcards.
std::string moments_name(const Suite& suite, const SuiteView& view, const std::string& folder) {
    for (const FilePattern& pattern : suite.baseline) {
        const auto path = pattern.path(view.name, {"moments"});
        const auto match = path ? pattern.match(*path) : std::nullopt;
        if (match && match->view == view.name && path->ends_with(".exr")) return name_in(folder, *path);
    }
    throw InputError(suite.baseline.front().location(),
        fmt::format(
            "store = \"moments\": expected a pattern of the baseline that ends with .exr and matches 'moments' in "
            "the place of one *, found '{}'",
            fmt::join(suite.options.baseline, "', '")));
}

/// Returns a plan with the candidate only.
ComparePlan plan_of_candidate(const Suite& suite, const SuiteView& view, const std::vector<std::string>& files) {
    ComparePlan plan;
    plan.file = suite.file.empty() ? "crescent compare" : suite.file;
    RenderArm& arm = plan.arms.emplace_back();
    arm.name = "candidate";
    arm.location = {plan.file, 0, 0};
    arm.files = files;
    arm.layer = suite.options.layer;
    plan.regions = view.regions;
    plan.flip = false;
    return plan;
}

Json statistics_of(const RenderStats& stats) {
    const ArmStats& arm = stats.arms[0];
    Json out = {{"width", stats.width}, {"height", stats.height}, {"regions", Json::object()}};
    const double k = static_cast<double>(arm.files.size());
    for (std::size_t r = 0; r < stats.regions.size(); ++r) {
        std::vector<double> means, spreads;
        for (const auto& render : arm.regions) {
            means.push_back(render[r].y);
            spreads.push_back(k > 1 ? render[r].spread * k / (k - 1) : std::nan(""));
        }
        const MeanInterval m = mean_interval(means, confidence);
        Json& entry = out["regions"][stats.regions[r].name];
        entry = {{"mean_y", crescent::number(m.mean)}};
        if (k < 2) continue;
        entry["standard_deviation_of_render_mean"] = crescent::number(m.se * std::sqrt(k));
        entry["variance_of_pixel"] = crescent::number(mean_interval(spreads, confidence).mean);
    }
    return out;
}

std::string extension_of(const std::string& path) { return fs::path(path).extension().string(); }

/// Returns a source that reads the copies of candidates, under their own names.
RenderSource source_of(const std::vector<Accepted>& files, const ReadingOptions& options) {
    std::map<std::string, std::string> copies;
    for (const Accepted& file : files) copies.emplace(file.from, file.copy);
    RenderSource out;
    out.expand = [](const std::vector<std::string>& paths, const SourceLocation&) { return paths; };
    out.read = [copies, options](const std::string& path, const std::string& layer) {
        const std::string& copy = copies.at(path);
        try {
            Render render = read_render(copy, layer, options);
            render.file = path;
            return render;
        } catch (const InputError& e) {
            std::vector<Diagnostic> mistakes = e.diagnostics();
            for (Diagnostic& mistake : mistakes)
                if (mistake.location.file == copy) mistake.location.file = path;
            throw InputError(std::move(mistakes));
        }
    };
    return out;
}

/// Returns one file for each different render, and whether there were several renders and all were equal.
std::pair<std::vector<std::string>, bool> different_files(
    const Suite& suite, const std::vector<Accepted>& files, const RenderSource& source) {
    std::vector<std::string> out;
    std::vector<std::uint64_t> hashes;
    for (const Accepted& file : files) {
        const std::uint64_t hash = pixel_hash(source.read(file.from, suite.options.layer));
        if (std::find(hashes.begin(), hashes.end(), hash) != hashes.end()) continue;
        hashes.push_back(hash);
        out.push_back(file.from);
    }
    const bool constant = out.size() == 1 && files.size() > 1;
    return {std::move(out), constant};
}

/// Returns the named views, or those that have a candidate if none is named. Throws InputError for a view that is
/// unknown, or would be removed without a reason.
std::vector<const SuiteView*> wanted_views(const Suite& suite, const Acceptance& acceptance) {
    std::vector<const SuiteView*> out;
    std::vector<std::string> available;
    for (const SuiteView& view : suite.views) {
        available.push_back(view.name);
        const auto& names = acceptance.views;
        const bool is_named = std::find(names.begin(), names.end(), view.name) != names.end();
        if (is_named || (names.empty() && !view.candidate.empty())) out.push_back(&view);
        if (is_named && view.candidate.empty() && acceptance.because.empty())
            throw InputError({"--accept " + view.name, 0, 0},
                "the candidate has no render of this view: expected --because TEXT with it, which removes the view "
                "from the "
                "baseline");
    }
    for (const std::string& name : acceptance.views)
        if (std::find(available.begin(), available.end(), name) == available.end())
            throw InputError(
                {"--accept " + name, 0, 0}, "no candidate of this view: " + expected_one_of(available, name));
    return out;
}

/// Makes a file of the old folder appear in the new one, by a hard link if the file system supports it. A link stays a
/// link.
void link_or_copy(const std::string& from, const std::string& to) {
    std::error_code error;
    if (fs::is_symlink(fs::symlink_status(from, error))) {
        fs::copy_symlink(from, to, error);
    } else {
        fs::create_hard_link(from, to, error);
        if (error) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    }
    if (error) throw OutputError(fmt::format("cannot write {}: {}", to, error.message()));
}

void copy(const std::string& from, const std::string& to) {
    std::error_code error;
    fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    if (error) throw OutputError(fmt::format("cannot copy {} to {}: {}", from, to, error.message()));
}

/// The renders of the baseline of a view, as the manifest or its moments state it.
std::size_t former_renders(const Suite& suite, const SuiteView& view) {
    if (suite.manifest)
        if (const auto entry = suite.manifest->views.find(view.name); entry != suite.manifest->views.end())
            return entry->second.renders;
    return view.baseline.size();
}

/// Returns what a reader must know about a new baseline: fewer renders than before, pixels that are not finite; "" if
/// there is nothing. Throws InputError if no reason is given for it.
std::string check_reason(
    const Suite& suite, const SuiteView& view, const RenderStats& stats, const Acceptance& acceptance) {
    std::vector<std::string> remarks;
    if (const std::size_t former_count = former_renders(suite, view); view.candidate.size() < former_count)
        remarks.push_back(fmt::format("fewer renders than the {} of the former baseline", former_count));
    if (stats.bad_pixels > 0)
        remarks.push_back(fmt::format("{} not finite in some render{}", plural(stats.bad_pixels, "pixel"),
            stats.bad_files.empty() ? "" : " (" + stats.bad_files + ")"));
    const std::string text = fmt::format("{}", fmt::join(remarks, "; "));
    if (!text.empty() && acceptance.because.empty())
        throw InputError({"--accept " + view.name, 0, 0}, text + ": expected --because TEXT with it");
    return text;
}

/// One --accept, under the lock of its staging folder.
class Accepting {
public:
    Accepting(const Suite& suite, const Acceptance& acceptance, const std::string& folder, Staging& staging)
        : suite_(suite), acceptance_(acceptance), folder_(folder), staging_(staging) {
        if (suite.manifest) manifest_ = *suite.manifest;
    }

    void accept(const SuiteView& view) {
        for (const std::string& path : view.baseline) replaced_.push_back(name_in(folder_, path));
        if (const auto former = manifest_.views.find(view.name); former != manifest_.views.end())
            for (const ManifestFile& file : former->second.files) replaced_.push_back(file.name);
        manifest_.views.erase(view.name);
        manifest_.removed.erase(view.name);
        if (view.candidate.empty()) {
            manifest_.removed[view.name] = {
                {"accepted", acceptance_.date}, {"because", acceptance_.because}, {"program", acceptance_.program}};
            lines_.push_back(fmt::format("{}: removed, {}", view.name, plural(view.baseline.size(), "file")));
            return;
        }
        const bool moments = suite_.options.store == BaselineStorage::moments;
        if (moments && suite_.options.reading().is_partial())
            throw InputError({suite_.file, 0, 0},
                "channels, channel: expected store = \"renders\", found moments, which have R, G and B");
        std::vector<Accepted> files = files_to_accept(suite_, view, folder_);
        for (std::size_t k = 0; k < files.size(); ++k) {
            files[k].copy = moments
                ? fmt::format("{}/candidate-{}{}", staging_.scratch(), k, extension_of(files[k].from))
                : staging_.path(files[k].name);
            copy(files[k].from, files[k].copy);
        }
        const RenderSource source = source_of(files, suite_.options.reading());
        const auto [different, constant] = different_files(suite_, files, source);
        ProgressMonitor quiet;
        const RenderStats stats = read_all(plan_of_candidate(suite_, view, different), quiet, source);
        const std::string note = check_reason(suite_, view, stats, acceptance_);
        std::vector<std::string> names;
        if (moments) {
            names.push_back(moments_name(suite_, view, folder_));
            write_moments(staging_.path(names.back()), stats, 0, constant);
            for (const Accepted& file : files) fs::remove(file.copy);
        } else
            for (const Accepted& file : files) names.push_back(file.name);
        put_entry(view.name, names, files.size(), note, statistics_of(stats));
        lines_.push_back(fmt::format("{}: {} replaced by {} ({}){}", view.name, plural(view.baseline.size(), "file"),
            plural(names.size(), "file"), plural(files.size(), "render"), note.empty() ? "" : "; " + note));
    }

    /// Keeps the files of a view that is not accepted. Without a former manifest they are listed in the new one.
    void keep(const SuiteView& view) {
        std::vector<std::string> names;
        for (const std::string& path : view.baseline) {
            names.push_back(name_in(folder_, path));
            link_or_copy(path, staging_.path(names.back()));
            replaced_.push_back(names.back());
        }
        if (suite_.manifest || names.empty()) return;
        ManifestView& to = manifest_.views[view.name];
        to.entry = {
            {"because", "in the folder before the manifest"}, {"renders", names.size()}, {"files", Json::array()}};
        for (std::size_t k = 0; k < names.size(); ++k)
            to.entry["files"].push_back({{"file", names[k]}, {"xxh3_128", hash_of_file(view.baseline[k])}});
    }

    std::vector<std::string> publish(ProgressMonitor& monitor) {
        replaced_.emplace_back(manifest_name);
        staging_.write(manifest_name, manifest_text(manifest_));
        staging_.adopt(replaced_);
        staging_.commit(monitor);
        return std::move(lines_);
    }

private:
    void put_entry(const std::string& view, const std::vector<std::string>& names, std::size_t renders,
        const std::string& note, Json statistics) {
        Json entry = {{"accepted", acceptance_.date}, {"because", acceptance_.because},
            {"program", acceptance_.program},
            {"storage", suite_.options.store == BaselineStorage::moments ? "moments" : "renders"}, {"renders", renders},
            {"statistics", std::move(statistics)}, {"files", Json::array()}};
        if (!note.empty()) entry["note"] = note;
        for (const std::string& name : names)
            entry["files"].push_back({{"file", name}, {"xxh3_128", hash_of_file(staging_.path(name))}});
        manifest_.views[view].entry = std::move(entry);
    }

    const Suite& suite_;
    const Acceptance& acceptance_;
    const std::string& folder_;
    Staging& staging_;
    Manifest manifest_;
    std::vector<std::string> lines_, replaced_;
};

/// Throws InputError if a view that is not accepted differs from the manifest.
void check_others(const Suite& suite, const std::vector<const SuiteView*>& accepted) {
    if (!suite.manifest) return;
    std::vector<Diagnostic> mistakes;
    for (const SuiteView& view : suite.views) {
        if (std::find(accepted.begin(), accepted.end(), &view) != accepted.end()) continue;
        const std::vector<Diagnostic> differences = manifest_differences(*suite.manifest, view.name, view.baseline);
        mistakes.insert(mistakes.end(), differences.begin(), differences.end());
    }
    throw_if_any(std::move(mistakes));
}

/// Waits for another call that accepts views of the same baseline.
std::unique_ptr<Staging> stage_baseline(const std::string& folder, ProgressMonitor& monitor) {
    constexpr std::chrono::milliseconds step(50), longest = std::chrono::minutes(10);
    for (std::chrono::milliseconds waiting_time(0);; waiting_time += step) {
        try {
            return std::make_unique<Staging>(folder, "baseline");
        } catch (const FolderInUse&) {
            if (waiting_time >= longest) throw;
        }
        if (waiting_time.count() == 0) monitor.log(folder + " is in use by another run: waiting for it");
        monitor.check();
        std::this_thread::sleep_for(step);
    }
}

}  // namespace

std::vector<std::string> accept_views(
    const std::function<Suite()>& read, const Acceptance& acceptance, ProgressMonitor& monitor) {
    const Suite unlocked_suite = read();
    const std::string folder = baseline_folder(unlocked_suite);
    wanted_views(unlocked_suite, acceptance);
    const std::unique_ptr<Staging> staging = stage_baseline(folder, monitor);
    const Suite suite = read();  // another call may have accepted views before this one had the lock
    if (baseline_folder(suite) != folder)
        throw InputError({suite.file, 0, 0}, "the suite file was changed while it was read");
    const std::vector<const SuiteView*> views = wanted_views(suite, acceptance);
    check_others(suite, views);
    Accepting accepting(suite, acceptance, folder, *staging);
    monitor.begin("accepting views", static_cast<double>(views.size()));
    for (const SuiteView* view : views) {
        monitor.check();
        accepting.accept(*view);
        monitor.advance(1);
    }
    for (const SuiteView& view : suite.views)
        if (std::find(views.begin(), views.end(), &view) == views.end()) accepting.keep(view);
    return accepting.publish(monitor);
}

}  // namespace crescent
