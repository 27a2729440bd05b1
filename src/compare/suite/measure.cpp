// One view: its renders are read once into memory if they fit, copies are left out, and the tests of `crescent compare`
// compare the candidate with the baseline; then the variances of both sides are compared.
#include "compare/suite/measure.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <xxhash.h>

#include "base/parallel.h"
#include "compare/anytime.h"
#include "compare/bias.h"
#include "compare/compare.h"
#include "compare/moments.h"
#include "compare/moments_reading.h"
#include "compare/other_channels.h"
#include "compare/renders.h"
#include "compare/suite/decide.h"
#include "compare/suite/pictures.h"
#include "compare/suite/render_plan.h"
#include "compare/suite/suite.h"
#include "compare/wording.h"
#include "experiment/parser.h"
#include "output/format.h"

namespace crescent {

namespace {

/// Renders of one view that are kept for the second reading: at most 768 MiB, 30 renders of 1920 x 1080. The other
/// renders are read from their files again.
constexpr std::size_t most_kept = std::size_t{768} << 20;

/// The renders of a view by path, with their hashes.
class ViewFiles {
public:
    ViewFiles(const SuiteView& view, const std::string& layer, const RenderSource& source, ProgressMonitor& monitor)
        : source_(source) {
        std::vector<std::string> paths = view.baseline;
        paths.insert(paths.end(), view.candidate.begin(), view.candidate.end());
        std::vector<File> files(paths.size());
        parallel_for(std::size_t{0}, paths.size(), [&](std::size_t k) {
            monitor.check();
            Render render = source.read(paths[k], layer);
            files[k].hash = pixel_hash(render);
            files[k].is_uniform = render.is_uniform();
            const std::size_t bytes = 4 * sizeof(float) * render.size();
            const Guard guard(lock_);
            if (stored_bytes_ + bytes <= most_kept) {
                stored_bytes_ += bytes;
                files[k].render = std::move(render);
            }
        });
        for (std::size_t k = 0; k < paths.size(); ++k) files_.emplace(paths[k], std::move(files[k]));
    }

    std::uint64_t hash(const std::string& path) const { return files_.at(path).hash; }
    bool is_uniform(const std::string& path) const { return files_.at(path).is_uniform; }
    /// Returns the paths of one side whose pixels differ from those of all paths before; the others are listed in
    /// `notes`.
    std::vector<std::string> different(
        const std::vector<std::string>& paths, const char* side, std::vector<std::string>& notes) const {
        std::vector<std::string> out;
        std::map<std::uint64_t, std::string> first;
        std::vector<std::pair<std::string, std::string>> copies;
        for (const std::string& path : paths) {
            const auto [entry, is_new] = first.emplace(hash(path), path);
            if (is_new) out.push_back(path);
            else copies.emplace_back(path, entry->second);
        }
        if (!copies.empty() && out.size() > 1)
            notes.push_back(
                fmt::format("{} of the {} renders of the {} {} the same pixels as another and {} left out: "
                            "{} is a copy of {}{}",
                    copies.size(), paths.size(), side, copies.size() == 1 ? "has" : "have",
                    copies.size() == 1 ? "is" : "are", copies[0].first, copies[0].second,
                    copies.size() > 1 ? ", and others" : ""));
        return out;
    }
    /// Returns a source that reads each kept render twice from memory, as often as the tests read it without pairs;
    /// later from its file.
    RenderSource reader() {
        RenderSource out = source_;
        out.expand = [](const std::vector<std::string>& paths, const SourceLocation&) { return paths; };
        out.read = [this](const std::string& path, const std::string& layer) {
            const auto entry = files_.find(path);
            {
                const Guard guard(lock_);
                if (entry != files_.end() && entry->second.render.size() > 0)
                    return entry->second.read_count++ == 0 ? entry->second.render : std::move(entry->second.render);
            }
            return source_.read(path, layer);
        };
        return out;
    }

private:
    struct File {
        std::uint64_t hash = 0;
        bool is_uniform = false;
        Render render;  // without pixels if it is not kept
        int read_count = 0;
    };
    const RenderSource& source_;
    std::map<std::string, File> files_;
    std::size_t stored_bytes_ = 0;
    Mutex lock_;
};

/// renders of tests in memory have no file
bool is_moments(const std::string& path) { return std::filesystem::is_regular_file(path) && has_moments(path); }

/// Returns the header of a baseline stored as moments; nothing if it is stored as renders. Throws InputError if both
/// exist.
std::optional<MomentsHeader> moments_of(const SuiteView& view) {
    for (const std::string& path : view.baseline) {
        if (!is_moments(path)) continue;
        if (view.baseline.size() > 1)
            throw InputError({path, 0, 0},
                fmt::format("expected the baseline of {} as moments or as renders, found both", view.name));
        return read_moments_header(path);
    }
    return {};
}

ComparePlan plan_for(const Suite& suite, const SuiteView& view, const std::vector<std::string>& baseline,
    const std::vector<std::string>& candidate) {
    ComparePlan plan;
    plan.file = suite.file.empty() ? "crescent compare" : suite.file;
    plan.title = view.name;
    for (const auto& [name, files] : {std::pair{"baseline", baseline}, std::pair{"candidate", candidate}}) {
        RenderArm& arm = plan.arms.emplace_back();
        arm.moments = files.size() == 1 && is_moments(files.front());
        arm.name = name;
        arm.location = {plan.file, 0, 0};
        arm.files = files;
        arm.layer = suite.options.layer;
    }
    plan.regions = view.regions;
    constexpr int blocks = 256;  // a quarter of the default: enough to find correlation over the renders of a side
    plan.flip = plan.count_pixel_p = false;
    plan.spectrum_blocks = blocks;
    plan.find_outliers = plan.shared_noise = true;
    plan.look_number = suite.look_number;
    plan.pair = suite.pair(view) == Pairing::always;
    plan.find_pairs = suite.pair(view) == Pairing::automatic;
    plan.brightest = suite.options.brightest;
    plan.exposure = suite.options.exposure;
    return plan;
}

std::vector<double> spreads_of(const ArmStats& arm, std::size_t region) {
    const double k = static_cast<double>(arm.files.size());
    std::vector<double> out;
    for (const auto& render : arm.regions) out.push_back(render[region].spread * k / (k - 1));
    return out;
}

VarianceTest test_variance(const RenderStats& stats, const CompareResult& result, std::size_t region) {
    VarianceTest out;
    out.region = stats.regions[region].name;
    if (stats.arms[0].files.size() < 3 || stats.arms[1].files.size() < 3) {
        out.why = "three renders or more of each side are needed";
        return out;
    }
    const MeanInterval b = mean_interval(spreads_of(stats.arms[0], region), confidence),
                       c = mean_interval(spreads_of(stats.arms[1], region), confidence);
    out.baseline = b.mean;
    out.candidate = c.mean;
    for (const ArmResult& arm : result.arms)
        if (arm.regions[region].heavy()) out.why = fmt::format("heavy tail: a few pixels decide that of {}", arm.name);
    if (!out.why.empty()) return out;
    out.welch = welch_test(c, b);
    return out;
}

/// `level`: of the view.
void test_variances(
    const RenderStats& stats, const CompareResult& result, double level, unsigned look_number, ViewResult& out) {
    double test_count = 0;
    for (std::size_t r = 0; r < stats.regions.size(); ++r) {
        VarianceTest& test = out.variances.emplace_back(test_variance(stats, result, r));
        if (!test.why.empty()) continue;
        if (look_number > 0 && test.welch.se > 0) {
            const double n = static_cast<double>(stats.arms[0].files.size()),
                         m = static_cast<double>(stats.arms[1].files.size());
            test.welch.p = anytime_p(test.welch.difference / test.welch.se, test.welch.df, n * m / (n + m));
        }
        ++test_count;
        out.variance_p = std::fmin(out.variance_p, test.welch.p);
    }
    if (test_count > 0) out.variance_p = std::min(1.0, out.variance_p * test_count);
    for (VarianceTest& test : out.variances)
        if (test.why.empty() && test.baseline > 0)
            test.smallest = 1 + detectable(test.welch, level * (1 - share_of_means) / test_count) / test.baseline;
}

/// Returns the samples a pixel that the files of a side state, if all state the same.
std::optional<double> stated_spp(const ArmStats& arm) {
    for (const RenderFile& file : arm.files)
        if (file.spp != arm.files[0].spp) return {};
    return arm.files.empty() ? std::nullopt : arm.files[0].spp;
}

/// Returns the tile in which the variance of the candidate is largest relative to that of the baseline, of those in
/// which they differ significantly; "" if there is none.
std::string noisiest_place(const RenderStats& stats, const NoiseResult& noise) {
    std::size_t tile = stats.tiles.count();
    for (std::size_t t = 0; t < stats.tiles.count(); ++t)
        if (noise.distinguished[t] && noise.log2_ratio[t] > 0 &&
            (tile == stats.tiles.count() || noise.log2_ratio[t] > noise.log2_ratio[tile]))
            tile = t;
    if (tile == stats.tiles.count()) return "";
    const Box box = stats.tiles.box(tile, stats.width, stats.height);
    return fmt::format(
        "x {}–{} y {}–{} ({} times)", box.x0, box.x1, box.y0, box.y1, figures(math::exp2(noise.log2_ratio[tile]), 3));
}

/// Describes the channels that are not tested and differ between renders with the same pixels.
std::string other_channels(const Suite& suite, const RenderStats& stats) {
    for (const RenderFile& candidate : stats.arms[1].files)
        for (const RenderFile& baseline : stats.arms[0].files) {
            const bool are_files =
                std::filesystem::is_regular_file(candidate.path) && std::filesystem::is_regular_file(baseline.path);
            if (candidate.hash != baseline.hash || !are_files) continue;
            const std::string channels = differing_channels(baseline.path, candidate.path, suite.options.reading());
            if (!channels.empty()) return channels;
        }
    return "";
}

/// Returns the degrees of freedom of the standard error of a test. Those of Welch's test are themselves estimated, and
/// too many if the noise of the side with fewer renders is underestimated: they are limited to those of two sides of
/// equal noise.
double known_df(const RenderStats& stats, const MeanTest& test) {
    if (test.paired || test.pooled) return test.welch.df;
    const double a = static_cast<double>(stats.arms[0].files.size()),
                 b = static_cast<double>(stats.arms[1].files.size());
    const double equal = (1 / a + 1 / b) * (1 / a + 1 / b) / (1 / (a * a * (a - 1)) + 1 / (b * b * (b - 1)));
    return std::min(test.welch.df, equal);
}

/// Returns the renders of each side that the region needs; nothing if the number is unknown.
std::optional<std::size_t> renders_for(const RenderStats& stats, const BiasResult& means, const MeanTest& test,
    const std::vector<ArmResult>& arms, std::size_t region, double smallest, double level) {
    if (!test.why.empty()) {
        std::optional<double> count;
        for (const ArmResult& arm : arms)
            if (const auto n = arm.regions[region].renders_needed; n && arm.regions[region].mean_heavy())
                count = std::max(count.value_or(0), *n);
        if (count) return static_cast<std::size_t>(*count);
        if (stats.arms[0].files.size() < 2 || stats.arms[1].files.size() < 2) return 3;
        return {};
    }
    RegionPower power;
    power.mean = std::fabs(test.b);
    power.paired = test.paired;
    power.estimate_df = known_df(stats, test);
    if (test.paired) power.variance_a = test.welch.se * test.welch.se * (test.welch.df + 1);
    else {
        const auto variance = [&](const ArmStats& arm) {
            std::vector<double> values;
            for (const auto& render : arm.quantities[0].regions) values.push_back(render[region]);
            const MeanInterval m = mean_interval(values, confidence);
            return m.se * m.se * static_cast<double>(m.n);
        };
        power.variance_a = variance(stats.arms[means.arm_a]);
        power.variance_b = variance(stats.arms[means.arm_b]);
        if (std::isnan(power.variance_a)) power.variance_a = power.variance_b;  // one render
        if (std::isnan(power.variance_b)) power.variance_b = power.variance_a;
    }
    Welch planned = test.welch;
    planned.df = power.estimate_df;
    power.anytime = test.information > 0;
    const double detected_difference = found_difference(planned, planned.df, level, test.information),
                 stated = test.smallest * power.mean;
    if (stated > detected_difference * (1 + 1e-9))
        power.hidden_difference =
            stated * static_cast<double>(std::min(stats.arms[0].files.size(), stats.arms[1].files.size()));
    return renders_needed(power, smallest, level);
}

/// Increases the stated differences that a test finds by the uncertainty of the noise; those that rare events could
/// explain are unchanged.
void restate_power(const RenderStats& stats, double level, BiasResult& means) {
    const double region_level = level / 2 / static_cast<double>(means.regions.size());
    const auto restate = [&](MeanTest& t, std::size_t quantity) {
        if (!t.why.empty()) return;
        Welch planned = t.welch;
        planned.df = known_df(stats, t);
        const double difference = found_difference(
            planned, planned.df, region_level * level_share(quantity, stats.quantities), t.information);
        t.smallest = std::max(t.smallest, difference / std::max(std::fabs(t.b), 1e-300));
    };
    for (MeanTest& t : means.regions) {
        restate(t, 0);
        for (std::size_t c = 0; c < t.channels.size(); ++c) restate(t.channels[c], c + 1);
    }
}

/// States why equality of the means cannot be stated, and how many renders would be needed.
void state_power(const RenderStats& stats, const CompareResult& result, double level, ViewResult& out) {
    const BiasResult& means = *out.means;
    bool is_known = true;
    std::size_t count = 0;
    for (std::size_t r = 0; r < means.regions.size(); ++r) {
        const MeanTest& t = means.regions[r];
        std::string why = !t.caveat.empty() ? t.caveat : t.why;
        for (const MeanTest& c : t.channels)
            if (why.empty() && !c.why.empty()) why = fmt::format("{}: {}", c.region, c.why);
        if (why.empty() && !(t.smallest <= out.smallest))
            why = std::isfinite(t.smallest) ? fmt::format("a difference of {} of mean Y would be found, {} is required",
                                                  percent(t.smallest, 2), percent(out.smallest, 2))
                                            : "no difference of mean Y would be found";
        if (why.empty()) continue;
        if (out.too_few.empty()) out.too_few = fmt::format("in {} {}", t.region, why);
        const double region_level =
            level / 2 / static_cast<double>(means.regions.size()) * level_share(0, stats.quantities);
        const auto n = renders_for(stats, means, t, result.arms, r, out.smallest, region_level);
        is_known &= n.has_value();
        count = std::max(count, n.value_or(0));
    }
    if (means.non_finite.undecided && out.too_few.empty()) {
        out.too_few = fmt::format(
            "{} pixels are not finite in half of the renders of one side or more and in none of "
            "the other",
            means.non_finite.undecided);
        is_known = false;
    }
    const std::size_t render_count = std::min(stats.arms[0].files.size(), stats.arms[1].files.size());
    if (!out.too_few.empty() && is_known && count > render_count) out.renders_needed = count;
}

/// Removes the results per pixel and tile, so that the memory of a suite does not grow with the pixels of its views.
void drop_places(BiasResult& means) {
    means.different_pixels = {};
    means.tiles.p = {};
    means.tiles.quantity = {};
    means.tiles.difference = {};
    means.tiles.differs = {};
    means.non_finite.a.pixels = {};
    means.non_finite.b.pixels = {};
}

/// Returns whether all of several renders of a side have the same pixels.
bool is_constant(const std::vector<std::string>& files, const std::vector<std::string>& different) {
    return files.size() > 1 && different.size() == 1;
}

std::uint64_t failing_pixels(const ArmStats& arm) {
    return static_cast<std::uint64_t>(
        std::count_if(arm.not_finite.begin(), arm.not_finite.end(), [](std::uint32_t n) { return n > 0; }));
}

/// Describes the pixels that are not finite on one side only; "" if there are none. A single one is a difference: a
/// sampler that gives NaN is wrong, however rarely.
std::string one_sided_failures(const RenderStats& stats) {
    const std::array<std::uint64_t, 2> pixels{failing_pixels(stats.arms[0]), failing_pixels(stats.arms[1])};
    if ((pixels[0] > 0) == (pixels[1] > 0)) return "";
    const std::size_t side = pixels[0] > 0 ? 0 : 1;
    const ArmStats& arm = stats.arms[side];
    std::vector<std::string> files;
    for (std::size_t k = 0; k < arm.failed_groups.size(); ++k)
        if (arm.failed_groups[k].back() > 0) files.push_back(arm.files[k].path);
    const auto first =
        std::find_if(arm.not_finite.begin(), arm.not_finite.end(), [](std::uint32_t n) { return n > 0; });
    const int index = static_cast<int>(first - arm.not_finite.begin());
    constexpr std::array<const char*, 2> names{"baseline", "candidate"};
    return fmt::format("{} not finite in {} of {} of the {} (first at ({}, {}) of {}), and none of the {}.",
        pixels[side] == 1 ? "1 pixel is" : fmt::format("{} pixels are", pixels[side]), files.size(),
        plural(arm.files.size(), "render"), names[side], index % stats.width, index / stats.width,
        files.empty() ? "unknown" : files.front(), names[1 - side]);
}

/// Returns the outlier pixels with the test of their numbers. A test that cannot find a change at `alpha` is not made,
/// so that it takes no share of the level; whether it can depends on the sum over both sides alone.
ViewOutliers view_outliers(const RenderStats& stats, double alpha) {
    constexpr std::size_t most_places = 3;
    ViewOutliers out;
    const OutlierPixels& outliers = stats.outliers;
    out.baseline = outliers.groups[0];
    out.candidate = outliers.groups[1];
    out.set_apart = outliers.set_apart;
    const double baseline = static_cast<double>(stats.arms[0].files.size()),
                 candidate = static_cast<double>(stats.arms[1].files.size());
    const std::size_t side =
        static_cast<double>(out.candidate) * baseline >= static_cast<double>(out.baseline) * candidate ? 1 : 0;
    for (const OutlierPixel& p : outliers.pixels) {
        if (p.side != side || out.first.size() == most_places) continue;
        const int i = static_cast<int>(p.pixel);
        out.first.push_back(
            {stats.arms[p.side].files[p.render].path, i % stats.width, i / stats.width, p.quantity, p.value, p.others});
    }
    const std::uint64_t total = outliers.total();
    const double share = candidate / (baseline + candidate);
    const double smallest_p = std::min(binomial_exact(total, total, share), binomial_exact(0, total, share));
    if (total > 0 && smallest_p <= alpha * share_of_outliers) out.p = binomial_exact(out.candidate, total, share);
    return out;
}

ViewOutlierRender view_outlier_render(const RenderStats& stats) {
    const auto outlier = outlier_render(stats);
    if (!outlier) return {};
    return {stats.arms[outlier->side].files[outlier->render].path, outlier->side == 1, outlier->ratio,
        outlier->deviation, outlier->p, outlier->pixels};
}

/// Returns a view whose files cannot be compared.
ViewResult unreadable_view(const Suite& suite, const SuiteView& view, const InputError& error) {
    ViewResult out;
    out.name = view.name;
    out.smallest = suite.smallest(view);
    out.baseline_renders = view.baseline.size();
    out.candidate_renders = view.candidate.size();
    out.state = ViewState::unreadable;
    out.sentence = error.what();
    return out;
}

}  // namespace

std::uint64_t pixel_hash(const Render& render) {
    const std::array<std::uint64_t, 6> parts{static_cast<std::uint64_t>(render.width),
        static_cast<std::uint64_t>(render.height), XXH3_64bits(render.r.data(), render.r.size() * sizeof(float)),
        XXH3_64bits(render.g.data(), render.g.size() * sizeof(float)),
        XXH3_64bits(render.b.data(), render.b.size() * sizeof(float)),
        XXH3_64bits(render.alpha.data(), render.alpha.size() * sizeof(float))};
    return XXH3_64bits(parts.data(), sizeof parts);
}

ViewResult measure_view(const Suite& suite, const SuiteView& view, std::size_t compared, ProgressMonitor& monitor,
    const RenderSource& source) {
    ViewResult out;
    out.name = view.name;
    out.smallest = suite.smallest(view);
    if (suite.manifest) throw_if_any(manifest_differences(*suite.manifest, view.name, view.baseline));
    ViewFiles files(view, suite.options.layer, source, monitor);
    const std::vector<std::string> baseline = files.different(view.baseline, "baseline", out.notes),
                                   candidate = files.different(view.candidate, "candidate", out.notes);
    for (const std::string& path : view.baseline) out.baseline_hashes.push_back(files.hash(path));
    for (const std::string& path : view.candidate) out.candidate_hashes.push_back(files.hash(path));
    const std::optional<MomentsHeader> moments = moments_of(view);
    out.baseline_renders = moments ? moments->renders : baseline.size();
    out.candidate_renders = candidate.size();
    out.moments = moments.has_value();
    if (baseline.empty() || candidate.empty()) {
        out.state = baseline.empty() ? ViewState::added : ViewState::missing;
        picture_one_side(suite, view, files.reader(), out);
        return out;
    }
    if (moments && suite.options.reading().is_partial())
        throw InputError({suite.file, 0, 0}, "channels, channel: expected renders as the baseline, found moments");
    if (moments && suite.pair(view) == Pairing::always)
        throw InputError({suite.file, 0, 0}, "pair = true: expected renders as the baseline, found moments");
    if (moments)
        out.notes.push_back(
            "The baseline is stored as moments: whether it shares random numbers or renders with the "
            "candidate is not tested, and outlier pixels are neither counted nor left out.");
    const bool constant_baseline = moments ? moments->constant : is_constant(view.baseline, baseline),
               constant_candidate = is_constant(view.candidate, candidate);
    out.uniform = (constant_baseline && files.is_uniform(baseline.front())) ||
        (constant_candidate && files.is_uniform(candidate.front()));
    const std::optional<Tolerance> tolerance = suite.tolerance(view);
    // One file on each side shows no noise, but a tolerance states that there is none.
    NoiseResult noise;
    out.exact = out.baseline_renders == 1 && candidate.size() == 1 &&
        (constant_baseline || constant_candidate || tolerance.has_value());
    const ComparePlan plan = plan_for(suite, view, baseline, candidate);
    ProgressMonitor quiet;
    const RenderStats stats = read_all(plan, quiet, files.reader());
    monitor.check();
    CompareResult result;
    for (std::size_t a = 0; a < stats.arms.size(); ++a) result.arms.push_back(measure_arm(plan, stats, a, quiet));
    const double alpha = suite.options.alpha * share_of_means;
    const BiasLevel level{alpha / static_cast<double>(compared), alpha};
    out.means = test_bias(plan, stats, result, 1, 0, level, quiet);
    out.mean_p = out.means->p;
    out.non_finite = one_sided_failures(stats);
    out.width = stats.width;
    out.height = stats.height;
    out.notes.insert(out.notes.end(), stats.warnings.begin(), stats.warnings.end());
    out.noise = suite.noise(view);
    out.spp_baseline = stated_spp(stats.arms[0]);
    out.spp_candidate = stated_spp(stats.arms[1]);
    if (out.means->identical) out.other_channels = other_channels(suite, stats);
    if (out.exact) {
        if (!out.means->identical) out.exact_difference = exact_difference(stats, tolerance);
        out.tolerated = tolerance && out.exact_difference && out.exact_difference->excess == 0 &&
            out.exact_difference->one_sided == 0;
        out.mean_p = out.means->identical || out.tolerated ? 1 : 0;
    } else {
        if (view.tolerance) out.notes.push_back("The tolerance is not used: it is for views without noise.");
        if (!out.means->identical && out.noise != NoiseDemand::ignore) {
            out.outliers = view_outliers(stats, suite.options.alpha);
            if (suite.outliers(view) == OutlierDemand::ignore) out.outliers.p = std::nan("");
            out.outlier_render = view_outlier_render(stats);
            if (suite.look_number > 0) {  // these tests do not hold at any time
                out.outliers.p = out.outliers.p * look_factor(suite.look_number);
                out.outlier_render.p = out.outlier_render.p * look_factor(suite.look_number);
            }
        }
        test_variances(stats, result, level.power_level / share_of_means, suite.look_number, out);
        if (out.noise == NoiseDemand::ignore) out.variance_p = std::nan("");
        else {
            noise = compare_noise(plan, stats, 1, 0, suite.options.alpha);
            out.noisiest = noisiest_place(stats, noise);
        }
        if (!out.means->identical) {
            restate_power(stats, level.power_level, *out.means);
            state_power(stats, result, level.power_level, out);
        }
        const auto side = constant_baseline ? "baseline" : "candidate";
        if (constant_baseline || constant_candidate) {
            out.too_few = fmt::format(
                "all {} renders of the {} have the same pixels, those of the other side do not: "
                "give each render its own seed",
                constant_baseline ? view.baseline.size() : view.candidate.size(), side);
            out.renders_needed = 3;
        }
    }
    picture_both_sides(suite, stats, *out.means, out);
    picture_noise(stats, noise, out);
    drop_places(*out.means);
    return out;
}

SuiteResult compare_suite(const Suite& suite, ProgressMonitor& monitor) {
    return compare_suite(suite, monitor, files_read_with(suite.options.reading()));
}

SuiteResult compare_suite(const Suite& suite, ProgressMonitor& monitor, const RenderSource& source) {
    SuiteResult out;
    const std::size_t compared = std::max<std::size_t>(1, suite.compared());
    monitor.begin("views", static_cast<double>(suite.views.size()));
    for (const SuiteView& view : suite.views) {
        monitor.check();
        try {
            out.views.push_back(measure_view(suite, view, compared, monitor, source));
        } catch (const InputError& e) { out.views.push_back(unreadable_view(suite, view, e)); }
        monitor.advance(1);
    }
    decide(suite, out);
    return out;
}

}  // namespace crescent
