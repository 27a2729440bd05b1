// Metrics with confidence intervals from RenderStats. Intervals are t intervals over renders, 95 %, cut at 0 if the
// metric cannot be negative; for the squared bias by the jackknife, for counts by count_interval().
// tests/calibration/results/compare.md has their measured coverage.
#include "compare/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/parallel.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/wording.h"
#include "math/functions.h"
#include "math/statistics.h"
#include "metrics/flip.h"
#include "output/tone_map.h"

namespace crescent {

namespace {

using Values = std::vector<double>;

template <class Read> Values over_renders(const ArmStats& arm, std::size_t region, Read read) {
    Values out;
    for (const auto& render : arm.regions) out.push_back(read(render[region]));
    return out;
}

/// Returns the metric of a mean over renders; `transform` is increasing (sqrt for RMSE).
template <class Transform> MetricValue value_of(const MeanInterval& m, bool heavy, Transform transform) {
    MetricValue out{transform(m.mean), {}, ""};
    if (m.n < 2) out.why = "one render has no interval";
    else if (heavy) out.why = "heavy tail";
    else out.interval = {transform(m.low), transform(m.high)};
    return out;
}

template <class Transform> MetricValue mean_of(const Values& values, bool heavy, Transform transform) {
    return value_of(mean_interval(values, confidence), heavy, transform);
}

double identity(double v) { return v; }
double at_least_0(double v) { return std::max(0.0, v); }
double root_of(double v) { return std::sqrt(at_least_0(v)); }

MetricValue missing(std::string why) { return {{}, {}, std::move(why)}; }

double mean_variance(const MeanFilm& film, const PixelSet& set) {
    double sum = 0;
    for (const std::uint32_t i : set.pixels) sum += film.variance(i);
    return sum / static_cast<double>(set.pixels.size());
}

MetricValue variance(const ArmStats& arm, const PixelSet& set, std::size_t region, bool heavy) {
    const double k = static_cast<double>(arm.files.size());
    if (arm.files.size() >= 2) {
        Values spreads = over_renders(arm, region, [&](const RegionStats& r) { return r.spread * k / (k - 1); });
        MetricValue out = mean_of(spreads, heavy, at_least_0);
        if (arm.files.size() == 2) {
            out.interval.reset();
            out.why = "two renders have equal spreads: no interval";
        }
        return out;
    }
    const double stated_variance = mean_variance(arm.film, set);
    if (std::isnan(stated_variance)) return missing("one render without a variance channel has no variance");
    return {stated_variance, {}, "as the renderer wrote it; one render has no interval"};
}

/// Squared bias without the variance: the mean of e_k e_l over pairs of renders, minus the reference's own error. Pairs
/// of renders with a large error in the same pixel may be rare, and without them the estimated error is too small: the
/// standard error is at least that of independent pixels of equal variance, sqrt(2 / (K (K - 1) pixels)) variance.
MetricValue squared_bias(const ArmStats& arm, const PixelSet& set, std::size_t region, double reference, bool heavy) {
    const double k = static_cast<double>(arm.files.size());
    if (arm.files.size() < 2) return missing("two renders or more are needed to separate bias and variance");
    double sum = 0, squares = 0;
    for (const auto& render : arm.regions) {
        sum += render[region].with_sum;
        squares += render[region].mse;
    }
    const auto statistic = [&](double total, double diagonal, double n) {
        return (total - diagonal) / (n * (n - 1)) - reference;
    };
    MetricValue out{statistic(sum, squares, k), {}, ""};
    if (heavy) out.why = "heavy tail";
    else if (arm.files.size() < 3) out.why = "three renders or more have an interval";
    if (!out.why.empty()) return out;
    const double least_se =
        std::sqrt(2 / (k * (k - 1) * static_cast<double>(set.pixels.size()))) * mean_variance(arm.film, set);
    Values pseudo;
    for (const auto& render : arm.regions) {
        const RegionStats& r = render[region];
        const double estimate = statistic(sum - 2 * r.with_sum + r.mse, squares - r.mse, k - 1);
        pseudo.push_back(k * *out.value - (k - 1) * estimate);
    }
    const MeanInterval m = mean_interval(pseudo, confidence);
    const double half = std::max(m.high - m.mean, student_quantile(0.5 + confidence / 2, k - 1) * least_se);
    out.interval = {*out.value - half, *out.value + half};
    return out;
}

/// Returns a metric that is a monotonic function of another: increasing, or decreasing (1/x).
template <class Transform> MetricValue transformed_metric(const MetricValue& from, const Transform& transform) {
    if (!from.value) return missing(from.why);
    if (!(*from.value > 0)) return missing("the variance is 0");
    MetricValue out{transform(*from.value), {}, from.why};
    if (!from.interval || !(from.interval->first > 0)) return out;
    const double a = transform(from.interval->first), b = transform(from.interval->second);
    out.interval = {std::min(a, b), std::max(a, b)};
    return out;
}

void costs(const MetricValue& var, const Cost& cost, RegionResult& out) {
    const auto per_unit = [&](const std::optional<double>& unit, const char* why) {
        return unit ? transformed_metric(var, [&](double v) { return v * *unit; }) : missing(why);
    };
    const char* no_time = "no render time: give --seconds";
    out.metrics.emplace_back("efficiency",
        cost.seconds ? transformed_metric(var, [&](double v) { return 1 / (v * *cost.seconds); }) : missing(no_time));
    out.metrics.emplace_back("unit_time", per_unit(cost.seconds, no_time));
    out.metrics.emplace_back("sample_var", per_unit(cost.spp, "no samples a pixel: give --spp"));
}

/// Returns the number of renders for which the largest error would be a twentieth of the sum: the largest of n grows as
/// n^k, their sum as n.
std::optional<double> needed_renders(const RegionResult& r, double renders) {
    const double k = r.tail ? std::max(0.5, r.tail->k) : 0.5;
    if (!(k < 1)) return {};
    const double count = std::ceil(renders * math::pow(std::max(1.0, r.largest_share / 0.05), 1 / (1 - k)));
    return std::min(count, renders_beyond);
}

void tail_of(const ArmStats& arm, std::size_t region, RegionResult& out) {
    out.tail = fit_pooled_tail(std::span<const float>(arm.largest[region]));
    double sum = 0;
    for (const auto& render : arm.regions) sum += render[region].mse > 0 ? render[region].mse : render[region].spread;
    sum *= static_cast<double>(out.pixels);
    if (sum > 0 && !arm.largest[region].empty())
        out.largest_share = static_cast<double>(arm.largest[region].front()) / sum;
    if (out.heavy()) out.renders_needed = needed_renders(out, static_cast<double>(arm.files.size()));
}

/// Returns the variance that the renderer states over the variance of its renders.
std::optional<double> stated_over_measured(const ArmStats& arm, const PixelSet& set) {
    if (arm.film.stated_variance.empty() || arm.film.count < 2) return {};
    double stated_sum = 0, measured_sum = 0;
    for (const std::uint32_t i : set.pixels) {
        stated_sum += static_cast<double>(arm.film.stated_variance[i]);
        measured_sum += arm.film.variance(i);
    }
    return measured_sum > 0 ? std::optional(stated_sum / static_cast<double>(arm.film.count) / measured_sum)
                            : std::nullopt;
}

/// Removes values that are not finite, because comparisons with them have no meaning.
void keep_finite(MetricValue& m) {
    if (m.value && !std::isfinite(*m.value)) m = missing(fmt::format("it is {}, not a finite number", *m.value));
    if (m.interval && !(std::isfinite(m.interval->first) && std::isfinite(m.interval->second))) {
        m.interval.reset();
        m.why = "its interval is not finite";
    }
}

RegionResult without_pixels(const PixelSet& set, const std::vector<QuantityWord>& words) {
    RegionResult out;
    out.region = set.name;
    for (const QuantityWord& word : words)
        out.metrics.emplace_back(std::string(word.word), missing("no pixel is finite in every render"));
    return out;
}

}  // namespace

const MetricValue& RegionResult::metric(const std::string& name) const {
    static const MetricValue none;
    for (const auto& [key, value] : metrics)
        if (key == name) return value;
    return none;
}

bool RegionResult::mean_heavy() const { return (tail && tail->k >= 1) || largest_share > heavy_share; }

bool RegionResult::heavy() const { return (tail && tail->k >= 0.5) || largest_share > heavy_share; }

const RegionResult& ArmResult::region(const std::string& region_name) const {
    const auto it =
        std::find_if(regions.begin(), regions.end(), [&](const RegionResult& r) { return r.region == region_name; });
    ensure(it != regions.end(), "a region that was measured");
    return *it;
}

double reference_variance(const RenderStats& stats, std::size_t region) {
    const ArmStats& reference = *stats.reference;
    const double stated_variance =
        mean_variance(reference.film, stats.regions[region]) / static_cast<double>(reference.film.count);
    if (!std::isnan(stated_variance)) return stated_variance;
    double smallest =
        HUGE_VAL;  // a bias increases the roughness of an arm's difference, so the smallest estimate is the best
    for (const ArmStats& arm : stats.arms)
        if (arm.film.count > 1 || !arm.film.stated_variance.empty())
            smallest = std::min(smallest, roughness(stats, arm, stats.regions[region]));
    return std::isfinite(smallest) ? smallest : 0;
}

RegionResult measure_region(
    const RenderStats& stats, const ArmStats& arm, std::size_t region, const Cost& cost, const Flips& flips) {
    const PixelSet& set = stats.regions[region];
    if (set.pixels.empty()) return without_pixels(set, compare_words());
    RegionResult out;
    out.region = set.name;
    out.pixels = set.pixels.size();
    tail_of(arm, region, out);
    const bool heavy = out.heavy(), mean_heavy = out.mean_heavy(), has_reference = stats.reference.has_value();
    const auto add_metric = [&](const char* name, auto read, auto transform, bool no_interval) {
        out.metrics.emplace_back(name,
            has_reference ? mean_of(over_renders(arm, region, read), no_interval, transform) : missing("no reference"));
    };
    add_metric("rmse", [](const RegionStats& r) { return r.mse; }, root_of, heavy);
    const MetricValue var = variance(arm, set, region, heavy);
    out.metrics.emplace_back("var", var);
    out.metrics.emplace_back("bias2",
        has_reference ? squared_bias(arm, set, region, reference_variance(stats, region), heavy)
                      : missing("no reference"));
    add_metric("relmse", [](const RegionStats& r) { return r.relmse; }, at_least_0, heavy);
    add_metric("mape", [](const RegionStats& r) { return r.mape; }, at_least_0, mean_heavy);
    const Values fireflies = over_renders(arm, region, [](const RegionStats& r) { return r.fireflies; });
    out.metrics.emplace_back("fireflies",
        has_reference
            ? value_of(count_interval(fireflies, static_cast<double>(out.pixels), confidence), false, identity)
            : missing("no reference"));
    out.metrics.emplace_back(
        "y_mean", mean_of(over_renders(arm, region, [](const RegionStats& r) { return r.y; }), mean_heavy, identity));
    const auto add_flip = [&](const char* name, const std::optional<double>& flip) {
        out.metrics.emplace_back(name,
            flip ? MetricValue{*flip, {}, "of the first render"}
                 : missing(has_reference ? "not requested" : "no reference"));
    };
    add_flip("flip", flips.hdr);
    add_flip("flip_ldr", flips.ldr);
    costs(var, cost, out);
    out.power = arm.power[region];
    out.colour = noise_colour(out.power);
    out.stated_ratio = stated_over_measured(arm, set);
    for (auto& [name, value] : out.metrics) keep_finite(value);
    return out;
}

// ---- FLIP of each arm's first render against the reference: of radiance (HDR), and of the two photographs (LDR).

namespace {

double mean_over(const std::vector<float>& map, const PixelSet& set) {
    double sum = 0;
    for (const std::uint32_t i : set.pixels) sum += static_cast<double>(map[i]);
    return sum / static_cast<double>(set.pixels.size());
}

/// Returns the linear channels of a photograph for LDR-FLIP, tone-mapped as on the plates.
std::array<std::vector<float>, 3> photograph(
    std::span<const float> r, std::span<const float> g, std::span<const float> b, double exposure) {
    std::array<std::vector<float>, 3> out;
    for (auto& plane : out) plane.resize(r.size());
    for (std::size_t i = 0; i < r.size(); ++i) {
        const auto expose = [&](float x) { return std::max(0.0, exposure * static_cast<double>(x)); };
        const Rgb rgb = neutral({expose(r[i]), expose(g[i]), expose(b[i])});
        for (std::size_t c = 0; c < 3; ++c) out[c][i] = static_cast<float>(rgb[c]);
    }
    return out;
}

/// Sets pixels to black: FLIP filters images, so a value that is not finite would spread to its neighbours.
void blacken(Render& image, const std::vector<bool>& bad) {
    for (std::size_t i = 0; i < bad.size(); ++i)
        if (bad[i]) image.r[i] = image.g[i] = image.b[i] = 0;
}

}  // namespace

std::vector<Flips> measure_flip(
    const ComparePlan& plan, const RenderStats& stats, std::size_t a, ProgressMonitor& monitor) {
    std::vector<Flips> out(stats.regions.size());
    if (!stats.reference || !plan.flip) return out;
    monitor.begin("FLIP", 1);
    Render ref = in_rec709(stats, stats.reference->film);
    Render test = in_rec709(stats, stats.source.read(stats.arms[a].files[0].path, plan.arms[a].layer));
    for (Render* image : {&test, &ref}) blacken(*image, stats.bad);
    const std::vector<float> hdr = hdr_flip({stats.width, stats.height, ref.r, ref.g, ref.b},
        {stats.width, stats.height, test.r, test.g, test.b}, plan.pixels_per_degree);
    const auto test_photo = photograph(test.r, test.g, test.b, plan.exposure),
               reference_photo = photograph(ref.r, ref.g, ref.b, plan.exposure);
    const std::vector<float> ldr =
        ldr_flip({stats.width, stats.height, reference_photo[0], reference_photo[1], reference_photo[2]},
            {stats.width, stats.height, test_photo[0], test_photo[1], test_photo[2]}, plan.pixels_per_degree);
    for (std::size_t r = 0; r < stats.regions.size(); ++r)
        out[r] = {mean_over(hdr, stats.regions[r]), mean_over(ldr, stats.regions[r])};
    monitor.advance(1);
    return out;
}

// ---- Means and squared deviations of Y, R, G and B over renders that are added one at a time (Welford 1962).

namespace {

bool is_grey(const Render& render) {
    const auto are_equal = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    return std::equal(render.r.begin(), render.r.end(), render.g.begin(), are_equal) &&
        std::equal(render.r.begin(), render.r.end(), render.b.begin(), are_equal);
}

void add_value(MeanPlane& plane, std::size_t i, float x, double n) {
    const double value = static_cast<double>(x), deviation = value - plane.mean[i];
    plane.mean[i] += deviation / n;
    plane.m2[i] += deviation * (value - plane.mean[i]);
}

}  // namespace

void MeanFilm::add(const Render& render, double variance_scale) {
    if (count == 0) {
        const std::vector<double> zero(render.size());
        planes.assign(1, {zero, zero});
        stated_variance.assign(render.variance.size(), 0);
    }
    if (count == 0 && !render.alpha.empty()) planes.assign(most_quantities, planes[0]);
    if (planes.size() == 1 && !is_grey(render)) planes.resize(colour_quantities, MeanPlane(planes[0]));
    if (render.variance.size() != stated_variance.size() || variance_scale == 0)
        stated_variance.clear();  // some file has no variance
    ++count;
    rounding = std::max(rounding, render.rounding);
    if (render.steps.levels > 0 && (steps.levels == 0 || render.steps.levels < steps.levels)) steps = render.steps;
    const double n = static_cast<double>(count);
    const std::vector<float>* channels[] = {&render.r, &render.g, &render.b, &render.alpha};
    const auto width = static_cast<std::size_t>(render.width);
    parallel_for(std::size_t{0}, static_cast<std::size_t>(render.height), [&](std::size_t row) {
        for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
            add_value(planes[0], i, render.y(i), n);
            for (std::size_t q = 1; q < planes.size(); ++q) add_value(planes[q], i, (*channels[q - 1])[i], n);
            if (!stated_variance.empty()) stated_variance[i] += render.variance[i] * static_cast<float>(variance_scale);
        }
    });
}

std::vector<float> MeanFilm::radiance(std::size_t channel) const {
    const std::vector<double>& mean = of(channel + 1).mean;
    std::vector<float> out(mean.size());
    std::transform(mean.begin(), mean.end(), out.begin(), [](double x) { return static_cast<float>(x); });
    return out;
}

double MeanFilm::variance(std::size_t i, std::size_t quantity) const {
    if (count >= 2) return of(quantity).m2[i] / static_cast<double>(count - 1);
    const bool is_known = !stated_variance.empty() && (quantity == 0 || planes.size() == 1);
    return is_known ? static_cast<double>(stated_variance[i]) / static_cast<double>(count) : std::nan("");
}

}  // namespace crescent
