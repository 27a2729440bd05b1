// Runs are found one by one; RunIndex finds them by a table if there are many.
#include "metrics/metrics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <unordered_set>

#include "base/errors.h"
#include "experiment/published.h"
#include "math/functions.h"
#include "math/statistics.h"

namespace crescent {

const RegionMetrics* RunMetrics::region(const std::string& name) const {
    const auto match =
        std::find_if(regions.begin(), regions.end(), [&](const RegionMetrics& r) { return r.region == name; });
    return match == regions.end() ? nullptr : &*match;
}

const RunMetrics* Metrics::find(const std::string& arm, std::uint64_t n, double s, std::uint32_t seed) const {
    const RunKey key{.arm = arm, .n = n, .s = s, .seed = seed};
    const auto match = std::find_if(runs.begin(), runs.end(), [&](const RunMetrics& r) { return r.key == key; });
    return match == runs.end() ? nullptr : &*match;
}

bool Metrics::all_hold() const { return std::ranges::none_of(assertions, &AssertionResult::failed); }

// ---- A hash table from arm, n, s and seed to the run; 0 and -0 are the same s.

std::size_t RunIndex::Hash::operator()(const RunKey& key) const {
    std::size_t h = std::hash<std::string>()(key.arm);
    for (const std::size_t part :
        {std::hash<std::uint64_t>()(key.n), std::hash<double>()(key.s), std::hash<std::uint32_t>()(key.seed)})
        h = h * 1099511628211u + part;  // the prime of FNV-1a
    return h;
}

RunIndex::RunIndex(const std::vector<RunMetrics>& runs) {
    runs_.reserve(runs.size());
    std::unordered_set<std::uint32_t> distinct_seeds;
    for (const RunMetrics& run : runs) {
        runs_.emplace(run.key, &run);
        if (distinct_seeds.insert(run.key.seed).second) seeds_.push_back(run.key.seed);
    }
}

const RunMetrics* RunIndex::find(const RunKey& key) const {
    const auto entry = runs_.find(key);
    return entry == runs_.end() ? nullptr : entry->second;
}

// ---- A metric reads pixels one by one and then returns a value; the two lists of metrics are expanded to readers
// here. Sums in double. Bands are quantiles over seeds, 5, 50 and 95 %; slopes are least squares of log RMSE on log N.

namespace {

double square(double x) { return x * x; }

}  // namespace

namespace {

#define CRESCENT_READER(name, Type) Type name;
struct RegionReaders {
    CRESCENT_REGION_METRICS(CRESCENT_READER)
};
struct FrameReaders {
    CRESCENT_FRAME_METRICS(CRESCENT_READER)
};
#undef CRESCENT_READER

FilmPixel pixel_at(
    const Film& film, const ReferenceFilm& reference, const ShapeMap& shapes, bool paired, std::size_t index) {
    return {.y = static_cast<double>(film.y[index]),
        .reference = static_cast<double>(reference.y[index]),
        .var = static_cast<double>(film.var[index]),
        .largest = static_cast<double>(film.largest[index]),
        .horizon = static_cast<double>(film.horizon[index]),
        .geometry = shapes.shape[index] >= 0,
        .pair_error = paired ? static_cast<double>(reference.error[index]) : 0};
}

/// The squared error of a region against a paired reference. With d = Y - R and e = (R1 - R2)/2, whose square estimates
/// the variance of R, the variance of d^2 - e^2 over references is 4 d^2 e^2 in the mean, for errors of R1 and R2 that
/// are independent and symmetric.
struct PairedError {
    double squares = 0, variance = 0, reference_squares = 0;
    void add(const FilmPixel& p) {
        const double e2 = p.pair_error * p.pair_error;
        squares += p.squared_error();
        variance += 4 * p.difference() * p.difference() * e2;
        reference_squares += e2;
    }
    void write(RegionMetrics& m) const {
        const double pixels = static_cast<double>(m.pixels);
        m.mse = squares / pixels;
        m.mse_error = std::sqrt(variance) / pixels;
        m.reference_error = std::sqrt(reference_squares / pixels);
    }
};

}  // namespace

RunMetrics measure(const Experiment& experiment, const RunKey& key, const Film& film, const ReferenceFilm& reference,
    const ShapeMap& shapes) {
    RunMetrics run;
    run.key = key;
    const bool paired = experiment.reference.kind == ReferenceKind::paired;
    FilmFacts facts{.pixels = 0,
        .n = film.n,
        .directions = film.directions,
        .evaluations = film.evaluations,
        .bad = film.invalid,
        .firefly_k = experiment.firefly_k};
    for (const Region& region : experiment.regions) {
        RegionMetrics m;
        m.region = region.name;
        const AreaPixels pixels(region.area(), shapes);
        m.pixels = pixels.count();
        facts.pixels = static_cast<double>(m.pixels);
        RegionReaders readers;
        PairedError error;
        pixels.for_each([&](std::size_t index) {
            const FilmPixel p = pixel_at(film, reference, shapes, paired, index);
            error.add(p);
#define CRESCENT_ADD(name, Type) readers.name.add(p, facts);
            CRESCENT_REGION_METRICS(CRESCENT_ADD)
        });
#define CRESCENT_VALUE(name, Type) m.name = readers.name.value(facts);
        CRESCENT_REGION_METRICS(CRESCENT_VALUE)
#undef CRESCENT_VALUE
        if (paired) error.write(m);
        run.regions.push_back(m);
    }
    facts.pixels = static_cast<double>(film.size());
    FrameReaders readers;
    for (std::size_t index = 0; index < film.size(); ++index) {
        const FilmPixel p = pixel_at(film, reference, shapes, paired, index);
        CRESCENT_FRAME_METRICS(CRESCENT_ADD)
#undef CRESCENT_ADD
    }
#define CRESCENT_VALUE(name, Type) run.name = readers.name.value(facts);
    CRESCENT_FRAME_METRICS(CRESCENT_VALUE)
#undef CRESCENT_VALUE
    return run;
}

double rms_difference(const std::vector<float>& a, const std::vector<float>& b, const AreaPixels& pixels) {
    return std::sqrt(pixels.mean(
        [&](std::size_t index) { return square(static_cast<double>(a[index]) - static_cast<double>(b[index])); }));
}

double rms(const std::vector<float>& a, const AreaPixels& pixels) {
    return std::sqrt(pixels.mean([&](std::size_t index) { return square(static_cast<double>(a[index])); }));
}

ReferenceQuality compare(const ReferenceFilm& q, const ReferenceFilm* note, const Region& region,
    const std::vector<std::pair<RunKey, Film>>& films, ReferenceKind kind, const ShapeMap& shapes) {
    const AreaPixels pixels(region.area(), shapes);
    ReferenceQuality m;
    m.s = q.s;
    m.region = region.name;
    m.quadrature_error = rms(q.error, pixels);
    if (note) {
        m.rms_difference = rms_difference(q.y, note->y, pixels);
        m.rms_standard_error = rms(note->error, pixels);
        m.max_relative_rmse_change = 0;
    }
    ensure(kind != ReferenceKind::paired, "a paired reference is compared with no other");
    const bool is_quadrature = kind == ReferenceKind::quadrature;
    ensure(is_quadrature || note, "the reference that the metrics use was computed");
    for (const auto& [key, film] : films) {
        if (key.s != q.s) continue;
        const double a = rms_difference(film.y, q.y, pixels);
        const double b = note ? rms_difference(film.y, note->y, pixels) : a;
        if (note && a > 0) m.max_relative_rmse_change = std::max(*m.max_relative_rmse_change, std::fabs(b - a) / a);
        const double error = is_quadrature ? *m.quadrature_error : *m.rms_standard_error, rmse = is_quadrature ? a : b;
        if (error > 0) m.error_share = std::max(m.error_share, error / rmse);
    }
    return m;
}

std::vector<ReferenceQuality> paired_quality(const std::vector<ReferenceFilm>& references, const Experiment& experiment,
    const std::vector<RunMetrics>& runs, const ShapeMap& shapes) {
    std::vector<ReferenceQuality> out;
    for (const ReferenceFilm& film : references)
        for (const Region& region : experiment.regions) {
            ReferenceQuality& m = out.emplace_back();
            m.s = film.s;
            m.region = region.name;
            m.paired_error = rms(film.error, AreaPixels(region.area(), shapes));
            for (const RunMetrics& run : runs)
                if (const RegionMetrics* metrics = run.region(region.name); metrics && run.key.s == film.s)
                    m.error_share = std::max(m.error_share, share_of_reference(*metrics));
        }
    return out;
}

double share_of_reference(const RegionMetrics& region) {
    if (region.mse > 0) return std::sqrt(1.96 * region.mse_error / region.mse);
    return region.reference_error > 0 ? std::numeric_limits<double>::infinity() : 0;
}

std::vector<MetricName> metric_names(const Experiment& experiment) {
    std::vector<MetricName> names;
#define CRESCENT_NAME(metric, Type) \
    for (const Region& region : experiment.regions) names.push_back({#metric "." + region.name, &Type::info});
    CRESCENT_REGION_METRICS(CRESCENT_NAME)
#undef CRESCENT_NAME
    const RunMetrics none;
    for_each_metric(none, [&](std::string_view name, const MetricInfo& info, auto) {
        if (!info.of_single_samples) names.push_back({std::string(name), &info});
    });
    return names;
}

double metric_value(const RunMetrics& run, const std::string& metric) {
    const std::size_t dot = metric.find('.');
    std::optional<double> result;
    const auto take_value = [&](std::string_view name, const MetricInfo&, auto value) {
        if (name == std::string_view(metric).substr(0, dot)) result = static_cast<double>(value);
    };
    if (dot == std::string::npos) for_each_metric(run, take_value);
    else if (const RegionMetrics* region = run.region(metric.substr(dot + 1))) for_each_metric(*region, take_value);
    if (const RegionMetrics* region = metric.starts_with("flip.") ? run.region(metric.substr(5)) : nullptr)
        result = region->flip;
    ensure(result.has_value(), "a metric of the list, of a region that was measured");
    return *result;
}

namespace {

std::vector<double> over_seeds(const std::vector<RunMetrics>& runs, const RunKey& key, const std::string& metric) {
    std::vector<double> values;
    for (const RunMetrics& run : runs)
        if (run.key.arm == key.arm && run.key.n == key.n && run.key.s == key.s)
            values.push_back(metric_value(run, metric));
    return values;
}

/// RMSE and var depend on the second moment, which has no expectation if the tail of the samples is heavy.
bool heavy(const RunMetrics& run, const std::string& metric) {
    const std::size_t dot = metric.find('.');
    if (dot == std::string::npos) return false;
    const RegionMetrics* region = run.region(metric.substr(dot + 1));
    return region && region->tail && region->tail->heavy();
}

/// Adds FLIP in each region that has it at two seeds at least.
void add_flips(const std::vector<RunMetrics>& runs, const RunMetrics& run, std::vector<SeedSpread>& out) {
    for (const RegionMetrics& region : run.regions) {
        const std::string metric = "flip." + region.region;
        std::vector<double> values = over_seeds(runs, run.key, metric);
        std::erase_if(values, [](double v) { return std::isnan(v); });
        if (values.size() < 2) continue;
        const Band band{.q05 = quantile(values, 0.05),
            .median = quantile(values, 0.5),
            .q95 = quantile(values, 0.95),
            .seeds = static_cast<int>(values.size()),
            .heavy = false};
        out.push_back({run.key, metric, region.flip, band, {}, {}});
    }
}

}  // namespace

std::vector<SeedSpread> bands(
    const Experiment& experiment, const std::vector<RunMetrics>& runs, const Published* published) {
    std::vector<SeedSpread> out;
    const bool paired = experiment.reference.kind == ReferenceKind::paired;
    for (const RunMetrics& run : runs) {
        if (run.key.seed != experiment.seed) continue;
        for (const auto& [metric, info] : metric_names(experiment)) {
            if (run.key.n < 2 && info->from_two_samples) continue;
            std::vector<double> values = over_seeds(runs, run.key, metric);
            // An RMSE below the error of a paired reference is the smallest of all; a quantile among such is not known.
            const bool is_paired_rmse = paired && metric.starts_with("rmse");
            for (double& v : values)
                if (is_paired_rmse && std::isnan(v)) v = -1;
            const auto quantile = [&](const std::vector<double>& of_seeds, double q) {
                const double value = crescent::quantile(of_seeds, q);
                return is_paired_rmse && value < 0 ? not_paired : value;
            };
            SeedSpread b;
            b.key = run.key;
            b.metric = metric;
            b.measured = metric_value(run, metric);
            b.band = {.q05 = quantile(values, 0.05),
                .median = quantile(values, 0.5),
                .q95 = quantile(values, 0.95),
                .seeds = static_cast<int>(values.size()),
                .heavy = heavy(run, metric)};
            if (published) b.published = published->find(run.key.arm, run.key.n, run.key.s, metric);
            if (b.published) {
                const auto lower_count =
                    std::count_if(values.begin(), values.end(), [&](double v) { return v < *b.published; });
                b.published_rank = static_cast<double>(lower_count) / static_cast<double>(values.size());
            }
            out.push_back(std::move(b));
        }
        add_flips(runs, run, out);
    }
    return out;
}

namespace {

struct Line {
    double slope = 0, half_width = 0;  // of the 90 % interval from the residuals, NaN if there are none
};

/// The variance of a fitted slope for errors of unit variance, the mean of its residuals' squares, and Satterthwaite's
/// degrees of freedom of that mean. The samples of N1 are a part of those of N2 > N1: the correlation of the two mean
/// squared errors, and so nearly of their logarithms, is N1 / N2. With M = 1 - H the residuals and R the correlations,
/// their squares have the mean tr MR and tr(MR)^2 / tr(MRMR) degrees of freedom.
struct FitErrors {
    double slope_variance = 0, residual_mean = 0, degrees = 0;
};

FitErrors fit_errors(const std::vector<std::uint64_t>& n, const std::vector<double>& x, double mean, double spread) {
    const std::size_t k = n.size();
    const auto correlation = [&](std::size_t i, std::size_t j) {
        return static_cast<double>(std::min(n[i], n[j])) / static_cast<double>(std::max(n[i], n[j]));
    };
    FitErrors out;
    std::vector<double> product(k * k);  // M R
    for (std::size_t i = 0; i < k; ++i)
        for (std::size_t j = 0; j < k; ++j) {
            for (std::size_t m = 0; m < k; ++m) {
                const double hat = 1 / static_cast<double>(k) + (x[i] - mean) * (x[m] - mean) / spread;
                product[i * k + j] += ((i == m) - hat) * correlation(m, j);
            }
            out.slope_variance += (x[i] - mean) * (x[j] - mean) / square(spread) * correlation(i, j);
        }
    double squares = 0;
    for (std::size_t i = 0; i < k; ++i) {
        out.residual_mean += product[i * k + i];
        for (std::size_t j = 0; j < k; ++j) squares += product[i * k + j] * product[j * k + i];
    }
    out.degrees = square(out.residual_mean) / squares;
    return out;
}

/// Fits log y against log n by least squares.
Line fit_power(const std::vector<std::uint64_t>& n, const std::vector<double>& y) {
    const double count = static_cast<double>(n.size());
    std::vector<double> x;
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < n.size(); ++i) {
        const double a = math::log(static_cast<double>(n[i])), b = math::log(y[i]);
        x.push_back(a);
        sx += a;
        sy += b;
        sxx += a * a;
        sxy += a * b;
    }
    const double spread = sxx - sx * sx / count;
    Line line{(sxy - sx * sy / count) / spread, std::nan("")};
    if (n.size() < 3) return line;
    double residual = 0;
    for (std::size_t i = 0; i < n.size(); ++i)
        residual += square(math::log(y[i]) - sy / count - line.slope * (x[i] - sx / count));
    const FitErrors errors = fit_errors(n, x, sx / count, spread);
    line.half_width = student_two_sided_quantile(errors.degrees, 0.1) *
        std::sqrt(residual / errors.residual_mean * errors.slope_variance);
    return line;
}

/// The same without the sample counts whose RMSE is below the error of a paired reference.
Line fit_known(const std::vector<std::uint64_t>& n, const std::vector<double>& rmse, bool paired) {
    if (!paired) return fit_power(n, rmse);
    std::vector<std::uint64_t> known_n;
    std::vector<double> known_rmse;
    for (std::size_t i = 0; i < n.size(); ++i)
        if (!std::isnan(rmse[i])) {
            known_n.push_back(n[i]);
            known_rmse.push_back(rmse[i]);
        }
    return known_rmse.size() < 2 ? Line{std::nan(""), std::nan("")} : fit_power(known_n, known_rmse);
}

/// Empty if the first seed lacks a sample count, as in a part of a run.
std::optional<Ladder> ladder(
    const std::vector<RunMetrics>& runs, const ArmPlan& arm, const std::string& region, double s, std::uint32_t seed) {
    Ladder out{.arm = arm.name,
        .region = region,
        .s = s,
        .n = arm.n,
        .rmse = {},
        .slope = 0,
        .low = 0,
        .high = 0,
        .heavy = false};
    std::map<std::uint32_t, std::vector<double>> by_seed;
    bool paired = false;
    for (const RunMetrics& run : runs) {
        if (run.key.arm != arm.name || run.key.s != s ||
            std::find(arm.n.begin(), arm.n.end(), run.key.n) == arm.n.end())
            continue;
        by_seed[run.key.seed].push_back(run.region(region)->rmse);
        paired = run.region(region)->is_paired();
        if (run.key.seed == seed) out.heavy = out.heavy || heavy(run, "rmse." + region);
    }
    std::erase_if(by_seed, [&](const auto& entry) { return entry.second.size() < arm.n.size(); });
    if (!by_seed.contains(seed)) return {};
    out.rmse = by_seed.at(seed);
    const Line line = fit_known(out.n, out.rmse, paired);
    std::vector<double> slopes;
    for (const auto& [_, values] : by_seed) slopes.push_back(fit_known(out.n, values, paired).slope);
    const bool has_several_seeds = slopes.size() > 1;
    out.slope = line.slope;
    out.low = has_several_seeds ? quantile(slopes, 0.05) : line.slope - line.half_width;
    out.high = has_several_seeds ? quantile(slopes, 0.95) : line.slope + line.half_width;
    return out;
}

}  // namespace

std::vector<Ladder> ladders(const Experiment& experiment, const std::vector<RunMetrics>& runs) {
    std::vector<Ladder> out;
    for (const ArmPlan& arm : experiment.arms) {
        if (arm.n.size() < 2) continue;
        for (const Region& region : experiment.regions)
            if (auto fit = ladder(runs, arm, region.name, experiment.s(), experiment.seed))
                out.push_back(std::move(*fit));
    }
    return out;
}

}  // namespace crescent
