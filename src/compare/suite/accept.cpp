// The new folder of the baseline is written next to the old one and exchanged with it (base/files.h). Files of views
// that are not accepted are linked into it.
#include "compare/suite/suite.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <xxhash.h>

#include "base/files.h"
#include "base/text.h"
#include "compare/renders.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent::inline comparison {

namespace {

namespace fs = std::filesystem;

constexpr const char* manifest_name = "baseline.json";
constexpr const char* manifest_format = "crescent baseline 1";

std::string hash_of_file(const std::string& path) {
    const OpenFile file(path);
    XXH3_state_t* state = XXH3_createState();
    XXH3_128bits_reset(state);
    std::vector<char> bytes(std::size_t{1} << 20);
    for (std::uint64_t at = 0; at < file.size();) {
        const std::size_t n = file.read_some(at, bytes);
        if (n == 0) break;
        XXH3_128bits_update(state, bytes.data(), n);
        at += n;
    }
    const XXH128_hash_t hash = XXH3_128bits_digest(state);
    XXH3_freeState(state);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

/// A candidate's file and its name in the folder of the baseline.
struct Accepted {
    std::string from, name;
};

std::string relative_to(const std::string& path, const std::string& folder) {
    return fs::path(path).lexically_normal().lexically_relative(fs::path(folder).lexically_normal()).string();
}

std::vector<Accepted> renders_of(const Suite& suite, const SuiteView& view, const std::string& folder) {
    std::vector<Accepted> out;
    const SuiteOptions& o = suite.options;
    for (std::size_t p = 0; p < o.candidate.size(); ++p) {
        const std::string& target = o.baseline[o.baseline.size() == o.candidate.size() ? p : 0];
        for (const MatchedFile& file : match_views(o.candidate[p])) {
            if (file.view != view.name) continue;
            auto path = path_from(target, view.name, file.wildcards);
            if (!path) path = path_from(target, view.name, {fmt::format("{:03}", out.size() + 1)});
            if (!path)
                throw InputError({suite.file, 0, 0},
                    fmt::format("no name for {} follows from the pattern '{}': expected as many wildcards as in '{}'",
                        file.path, target, o.candidate[p]));
            out.push_back({file.path, relative_to(*path, folder)});
        }
    }
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (out[i].name == out[j].name)
                throw InputError({out[i].from, 0, 0},
                    fmt::format(
                        "expected a name of its own in the baseline, found that of {}: {}", out[j].from, out[i].name));
    return out;
}

/// Returns the name of the moments of a view: "moments" in place of the wildcards.
std::string moments_name(const Suite& suite, const SuiteView& view, const std::string& folder) {
    for (const std::string& pattern : suite.options.baseline)
        if (const auto path = path_from(pattern, view.name, {"moments"}); path && path->ends_with(".exr"))
            return relative_to(*path, folder);
    throw InputError({suite.file, 0, 0},
        fmt::format(
            "store = \"moments\": expected a pattern of the baseline with one * that ends with .exr, found '{}'",
            fmt::join(suite.options.baseline, "', '")));
}

/// Returns a plan with the candidate only.
ComparePlan plan_of_candidate(const Suite& suite, const SuiteView& view, const std::vector<std::string>& files) {
    ComparePlan plan;
    plan.file = suite.file.empty() ? "crescent compare" : suite.file;
    RenderArm& arm = plan.arms.emplace_back();
    arm.name = "candidate", arm.at = {plan.file, 0, 0}, arm.files = files, arm.layer = suite.options.layer;
    plan.regions = view.regions, plan.flip = false;
    return plan;
}

/// Returns one file for each different render, and whether there were several renders and all were equal.
std::pair<std::vector<std::string>, bool> different_files(const Suite& suite, const SuiteView& view) {
    std::vector<std::string> out;
    std::vector<std::uint64_t> hashes;
    for (const std::string& path : view.candidate) {
        const std::uint64_t hash = pixel_hash(read_render(path, suite.options.layer));
        if (std::find(hashes.begin(), hashes.end(), hash) != hashes.end()) continue;
        hashes.push_back(hash), out.push_back(path);
    }
    const bool constant = out.size() == 1 && view.candidate.size() > 1;
    return {std::move(out), constant};
}

Json statistics_of(const RenderStats& all) {
    const ArmStats& arm = all.arms[0];
    Json out = {{"width", all.width}, {"height", all.height}, {"regions", Json::object()}};
    const double k = static_cast<double>(arm.files.size());
    for (std::size_t r = 0; r < all.regions.size(); ++r) {
        std::vector<double> means, spreads;
        for (const auto& render : arm.regions)
            means.push_back(render[r].y), spreads.push_back(k > 1 ? render[r].spread * k / (k - 1) : std::nan(""));
        const MeanInterval m = mean_interval(means, confidence);
        Json& at = out["regions"][all.regions[r].name];
        at = {{"mean_y", output::number(m.mean)}};
        if (k < 2) continue;
        at["standard_deviation_of_render_mean"] = output::number(m.se * std::sqrt(k));
        at["variance_of_pixel"] = output::number(mean_interval(spreads, confidence).mean);
    }
    return out;
}

Json manifest_before(const std::string& folder) {
    const std::string text = contents_of(folder + "/" + manifest_name);
    Json out = Json::parse(text, nullptr, false);
    if (text.empty()) out = {{"format", manifest_format}, {"views", Json::object()}};
    if (!out.is_object() || out.value("format", "") != manifest_format || !out.value("views", Json()).is_object())
        throw InputError({folder + "/" + manifest_name, 1, 1},
            fmt::format("expected a manifest of '{}'; remove the file to begin a new one", manifest_format));
    return out;
}

std::vector<const SuiteView*> wanted_views(const Suite& suite, const std::vector<std::string>& names) {
    std::vector<const SuiteView*> out;
    std::vector<std::string> known;
    for (const SuiteView& view : suite.views) {
        if (!view.candidate.empty()) known.push_back(view.name);
        const bool named = names.empty() || std::find(names.begin(), names.end(), view.name) != names.end();
        if (named && !view.candidate.empty()) out.push_back(&view);
    }
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw InputError({"--accept " + name, 0, 0}, "no candidate of this view: " + expected_one_of(known, name));
    return out;
}

/// Makes a file of the old folder appear in the new one, by a hard link if the file system supports it.
void link_or_copy(const std::string& from, const std::string& to) {
    std::error_code error;
    fs::create_hard_link(from, to, error);
    if (error) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    if (error) throw OutputError(fmt::format("cannot write {}: {}", to, error.message()));
}

void copy(const std::string& from, const std::string& to) {
    std::error_code error;
    fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
    if (error) throw OutputError(fmt::format("cannot write {}: {}", to, error.message()));
}

}  // namespace

std::string baseline_folder(const Suite& suite) {
    const std::string& pattern = suite.options.baseline.front();
    const std::size_t first = pattern.find_first_of("*?[{%");
    const std::size_t slash = pattern.rfind('/', first == std::string::npos ? pattern.size() : first);
    const std::string folder = slash == std::string::npos ? "." : slash == 0 ? "/" : pattern.substr(0, slash);
    for (const std::string& other : suite.options.baseline)
        if (folder != "." && !other.starts_with(folder + "/"))
            throw InputError({suite.file, 0, 0},
                fmt::format(
                    "--accept: expected patterns of the baseline in one folder, found {} and '{}'", folder, other));
    return folder;
}

std::vector<std::string> accept_views(const Suite& suite, const Acceptance& acceptance, ProgressMonitor& monitor) {
    const std::string folder = baseline_folder(suite);
    const std::vector<const SuiteView*> views = wanted_views(suite, acceptance.views);
    Json manifest = manifest_before(folder);
    Staging staging(folder, "baseline");
    std::vector<std::string> lines, replaced;
    monitor.begin("accepting views", static_cast<double>(views.size()));
    for (const SuiteView* view : views) {
        monitor.check();
        const auto [files, constant] = different_files(suite, *view);
        ProgressMonitor quiet;
        const RenderStats all = read_all(plan_of_candidate(suite, *view, files), quiet);
        std::vector<std::string> names;
        if (suite.options.store == BaselineStorage::moments) {
            names.push_back(moments_name(suite, *view, folder));
            write_moments(staging.path(names.back()), all, 0, constant);
        } else {
            for (const Accepted& render : renders_of(suite, *view, folder))
                copy(render.from, staging.path(render.name)), names.push_back(render.name);
        }
        Json entry = {{"accepted", acceptance.date}, {"because", acceptance.because}, {"program", acceptance.program},
            {"storage", suite.options.store == BaselineStorage::moments ? "moments" : "renders"},
            {"renders", view->candidate.size()}, {"statistics", statistics_of(all)}, {"files", Json::array()}};
        for (const std::string& name : names)
            entry["files"].push_back({{"file", name}, {"xxh3_128", hash_of_file(staging.path(name))}});
        manifest["views"][view->name] = std::move(entry);
        for (const std::string& path : view->baseline) replaced.push_back(relative_to(path, folder));
        lines.push_back(fmt::format("{}: {} replaced by {} ({})", view->name, plural(view->baseline.size(), "file"),
            plural(names.size(), "file"), plural(view->candidate.size(), "render")));
        monitor.advance(1);
    }
    for (const SuiteView& view : suite.views)
        if (std::find(views.begin(), views.end(), &view) == views.end())
            for (const std::string& path : view.baseline) link_or_copy(path, staging.path(relative_to(path, folder)));
    replaced.push_back(manifest_name);
    staging.write(manifest_name, text(manifest));
    staging.adopt(replaced);
    staging.commit(monitor);
    return lines;
}

}  // namespace crescent::inline comparison
