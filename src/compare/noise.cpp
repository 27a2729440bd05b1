// Finds where the noise differs: log2 of the ratio of two arms' variances per tile, tested against 0 by Welch's test of
// the spreads of renders, with the false discovery rate controlled.
#include "compare/noise.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <span>

#include "compare/compare.h"
#include "compare/passes.h"
#include "compare/shared_seeds.h"
#include "math/functions.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent {

namespace {

MeanInterval spread_of(const ArmStats& arm, std::size_t tile) {
    const double k = static_cast<double>(arm.files.size());
    std::vector<double> spreads;
    for (const auto& render : arm.quantities[0].tiles) spreads.push_back(render[tile].spread * k / (k - 1));
    return mean_interval(spreads, confidence);
}

/// Returns the tiles of a region: those with at least half of their pixels in it.
std::vector<std::size_t> tiles_in(const RenderStats& stats, const PixelSet& set) {
    std::vector<std::size_t> pixel_counts(stats.tiles.count());
    for (const std::uint32_t i : set.pixels)
        ++pixel_counts[stats.tiles.of(static_cast<int>(i) % stats.width, static_cast<int>(i) / stats.width)];
    std::vector<std::size_t> out;
    for (std::size_t t = 0; t < pixel_counts.size(); ++t) {
        const Box box = stats.tiles.box(t, stats.width, stats.height);
        if (2 * pixel_counts[t] >= static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()))
            out.push_back(t);
    }
    return out;
}

NoiseResult::Histogram histogram(const RenderStats& stats, const PixelSet& set, const NoiseResult& noise) {
    NoiseResult::Histogram out{
        set.name, std::vector<std::uint64_t>(noise_bins), std::vector<std::uint64_t>(noise_bins)};
    for (const std::size_t t : tiles_in(stats, set)) {
        if (std::isnan(noise.log2_ratio[t])) continue;
        const double position = (noise.log2_ratio[t] + noise_range) / (2 * noise_range) * noise_bins;
        const auto bin = static_cast<std::size_t>(std::clamp(std::floor(position), 0.0, noise_bins - 1.0));
        ++(noise.distinguished[t] ? out.different : out.undistinguished)[bin];
    }
    return out;
}

std::string sentence(const NoiseResult& n, std::size_t tile_count) {
    if (!tile_count)
        return fmt::format("The noise of {} and {} was not compared: three renders of each are needed.", n.a, n.b);
    std::size_t quieter = 0, noisier = 0;
    for (std::size_t t = 0; t < n.log2_ratio.size(); ++t)
        if (n.distinguished[t]) ++(n.log2_ratio[t] < 0 ? quieter : noisier);
    if (quieter + noisier == 0)
        return fmt::format("No difference of the variances of {} and {} was found in {} tiles.", n.a, n.b, tile_count);
    return fmt::format(
        "Of {} tiles, {} has less variance than {} in {} and more in {}; no difference was found in the others.",
        tile_count, n.a, n.b, quieter, noisier);
}

}  // namespace

NoiseResult compare_noise(
    const ComparePlan& plan, const RenderStats& stats, std::size_t a, std::size_t b, double alpha) {
    NoiseResult out;
    out.a = plan.arms[a].name;
    out.b = plan.arms[b].name;
    std::vector<double> p;
    for (std::size_t t = 0; t < stats.tiles.count(); ++t) {
        const MeanInterval va = spread_of(stats.arms[a], t), vb = spread_of(stats.arms[b], t);
        const bool have_noise = va.mean > 0 && vb.mean > 0;
        out.log2_ratio.push_back(have_noise ? math::log(va.mean / vb.mean) / std::numbers::ln2 : std::nan(""));
        p.push_back(have_noise && va.n > 2 && vb.n > 2 ? welch_test(va, vb).p : std::nan(""));
    }
    out.distinguished = discoveries(p, alpha, false);
    for (const PixelSet& set : stats.regions) out.regions.push_back(histogram(stats, set, out));
    out.sentence = sentence(
        out, static_cast<std::size_t>(std::count_if(p.begin(), p.end(), [](double x) { return !std::isnan(x); })));
    return out;
}

// ---- Finds renders of two arms with the same random numbers: those with the same number in their names, or with
// correlated residuals (shared_seeds.h); and computes the images of their differences.

namespace {

/// Returns the numbers in a file's name that vary within its arm and so identify the render.
std::vector<std::uint64_t> own_numbers(const ArmStats& arm, std::size_t file) {
    std::vector<std::uint64_t> out;
    const auto& numbers = arm.files[file].numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const bool varies = std::any_of(arm.files.begin(), arm.files.end(),
            [&](const RenderFile& f) { return f.numbers.size() != numbers.size() || f.numbers[i] != numbers[i]; });
        if (varies) out.push_back(numbers[i]);
    }
    return out.empty() ? numbers : out;
}

/// Returns a - b, channel by channel.
Render difference(const RenderStats& stats, Render a, const Render& b) {
    for (const Render* r : {&std::as_const(a), &b})
        if (r->width != stats.width || r->height != stats.height)
            throw InputError({r->file, 0, 0},
                fmt::format("expected {} x {} pixels as before, found {} x {}: the file has changed", stats.width,
                    stats.height, r->width, r->height));
    for (std::size_t i = 0; i < a.size(); ++i) {
        a.r[i] -= b.r[i];
        a.g[i] -= b.g[i];
        a.b[i] -= b.b[i];
    }
    for (std::size_t i = 0; i < a.alpha.size(); ++i) a.alpha[i] -= b.alpha[i];
    a.variance.clear();
    a.rounding = std::max(a.rounding, b.rounding);
    return a;
}

}  // namespace

std::vector<RenderPair> pairs_of(const ArmStats& a, const ArmStats& b) {
    std::vector<std::vector<std::uint64_t>> theirs;
    for (std::size_t j = 0; j < b.files.size(); ++j) theirs.push_back(own_numbers(b, j));
    std::vector<RenderPair> out;
    for (std::size_t i = 0; i < a.files.size(); ++i) {
        const std::vector<std::uint64_t> numbers = own_numbers(a, i);
        const auto count = std::count(theirs.begin(), theirs.end(), numbers);
        if (count != 1 || numbers.empty())
            throw InputError({a.files[i].path, 0, 0},
                numbers.empty()
                    ? "--pair: expected a number in its name"
                    : fmt::format(
                          "--pair: expected one render of the other arm with the number {} in its name, found {}",
                          fmt::join(numbers, ", "), count));
        out.emplace_back(
            i, static_cast<std::size_t>(std::find(theirs.begin(), theirs.end(), numbers) - theirs.begin()));
    }
    if (out.size() != b.files.size())
        throw InputError({b.files[0].path, 0, 0}, "--pair: expected as many renders of one arm as of the other");
    return out;
}

bool all_paired(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b) {
    return !shared.empty() && shared.size() == a.files.size() && shared.size() == b.files.size();
}

bool sharper_in_pairs(const std::vector<SeedPair>& shared, const ArmStats& a, const ArmStats& b, double level) {
    if (shared.size() < 3) return false;
    const double k = static_cast<double>(shared.size()), na = static_cast<double>(a.files.size()),
                 nb = static_cast<double>(b.files.size());
    double remaining = 0;  // share of the variance of a difference that remains
    for (const SeedPair& p : shared) remaining += (1 - p.correlation) / k;
    const double paired_quantile = student_quantile(1 - level / 2, k - 1),
                 independent_quantile = student_quantile(1 - level / 2, na + nb - 2);
    return 2 * remaining / k * paired_quantile * paired_quantile <
        (1 / na + 1 / nb) * independent_quantile * independent_quantile;
}

PairedRenders paired_renders(const ComparePlan& plan, const RenderStats& stats, std::size_t a, std::size_t b,
    std::vector<RenderPair> pairs, ProgressMonitor& monitor) {
    const bool referred = b >= stats.arms.size();
    const ArmStats &first = stats.arms[a], &second = referred ? *stats.reference : stats.arms[b];
    const std::string &layer = plan.arms[a].layer, &other_layer = referred ? plan.reference_layer : plan.arms[b].layer;
    PairedRenders out{std::move(pairs), {}};
    RenderSource source;
    source.read = [&](const std::string& path, const std::string&) {
        std::size_t k = 0;
        std::from_chars(path.data(), path.data() + path.size(), k);
        return difference(stats, stats.source.read(first.files[out.pairs[k].first].path, layer),
            stats.source.read(second.files[out.pairs[k].second].path, other_layer));
    };
    std::vector<std::string> paths;
    for (std::size_t k = 0; k < out.pairs.size(); ++k) {
        paths.push_back(std::to_string(k));
        out.differences.files.push_back({paths.back(), {}, {}, {}, {}, {}, {}, {}});
    }
    monitor.begin("differences of pairs", 2 * static_cast<double>(out.pairs.size()));
    each_render(source, paths, {}, monitor, [&](const Render& render) { out.differences.film.add(render); });
    second_pass(plan, stats, source, out.differences, {}, nullptr, monitor);
    return out;
}

// ---- Rankings: arms in the order of a metric, and which neighbours in that order have disjoint intervals. Ladders:
// one sampler at several samples per pixel.

namespace {

struct Measure {
    const char* metric;
    const char* words;
};
/// Arms are ranked by the first of these that all arms of a region have.
constexpr Measure at_equal_time[] = {{"unit_time", "at equal time"}};
constexpr Measure at_equal_samples[] = {{"sample_var", "at equal samples"}, {"var", "render by render"}};

struct Ranked {
    std::string arm;
    MetricValue value;
};

bool are_disjoint(const MetricValue& better, const MetricValue& worse) {
    return better.interval && worse.interval && better.interval->second < worse.interval->first;
}

std::string order_text(const std::vector<Ranked>& order) {
    std::vector<std::string> out;
    for (std::size_t k = 0; k + 1 < order.size(); ++k) {
        const MetricValue &better = order[k].value, &worse = order[k + 1].value;
        if (are_disjoint(better, worse))
            out.push_back(fmt::format("{} before {} ({} times the variance)", order[k].arm, order[k + 1].arm,
                figures(*worse.value / *better.value, 3)));
        else
            out.push_back(
                fmt::format("no difference between {} and {} in noise was found", order[k].arm, order[k + 1].arm));
    }
    return fmt::format("{}", fmt::join(out, "; "));
}

std::optional<Ranking> ranking(const CompareResult& result, std::size_t region, const Measure& measure) {
    std::vector<Ranked> order;
    for (const ArmResult& arm : result.arms) {
        const MetricValue& value = arm.regions[region].metric(measure.metric);
        if (!value.value) return {};
        order.push_back({arm.name, value});
    }
    std::sort(order.begin(), order.end(), [](const Ranked& a, const Ranked& b) {
        return *a.value.value != *b.value.value ? *a.value.value < *b.value.value : a.arm < b.arm;
    });
    Ranking out;
    out.region = result.arms[0].regions[region].region;
    out.measure = measure.words;
    for (const Ranked& r : order) out.order.push_back(r.arm);
    out.sentence = fmt::format("Noise in {}, {}: {}.", out.region, measure.words, order_text(order));
    return out;
}

}  // namespace

std::vector<Ranking> rank(const CompareResult& result) {
    std::vector<Ranking> out;
    if (result.arms.size() < 2) return out;
    for (std::size_t r = 0; r < result.arms[0].regions.size(); ++r) {
        for (const auto measures :
            {std::span<const Measure>(at_equal_time), std::span<const Measure>(at_equal_samples)}) {
            for (const Measure& measure : measures) {
                std::optional<Ranking> entry = ranking(result, r, measure);
                if (!entry) continue;
                out.push_back(std::move(*entry));
                break;
            }
        }
    }
    return out;
}

namespace {

/// Returns "path" for an arm "path-64" with 64 samples per pixel; "" if a name does not end with its spp.
std::string ladder_name(const ArmResult& arm) {
    const std::string spp = arm.spp ? fmt::format("{:.0f}", *arm.spp) : "";
    if (spp.empty() || !arm.name.ends_with(spp)) return {};
    const std::string stem = arm.name.substr(0, arm.name.size() - spp.size());
    const std::size_t end = stem.find_last_not_of("-_.");
    const bool is_separated =
        end != std::string::npos && (end + 1 < stem.size() || !(stem[end] >= '0' && stem[end] <= '9'));
    return is_separated ? stem.substr(0, end + 1) : "";
}

/// Fits a line to the logarithms by least squares. Its slope is a weighted sum of the logarithms, so the half-widths of
/// their intervals add in squares.
MetricValue slope_of(const CompareResult& result, const SppLadder& ladder, std::size_t region) {
    std::vector<double> x, y, half;
    for (const std::size_t a : ladder.arms) {
        const RegionResult& r = result.arms[a].regions[region];
        const MetricValue &rmse = r.metric("rmse"), &var = r.metric("var"), &metric = rmse.value ? rmse : var;
        if (!metric.value || !(*metric.value > 0)) return {{}, {}, "a sample count has no value"};
        const double root = rmse.value ? 1 : 0.5;
        x.push_back(math::log(*result.arms[a].spp));
        y.push_back(root * math::log(*metric.value));
        const bool is_known = metric.interval && metric.interval->first > 0;
        half.push_back(
            is_known ? root * math::log(metric.interval->second / metric.interval->first) / 2 : std::nan(""));
    }
    const double n = static_cast<double>(x.size());
    const double middle = std::accumulate(x.begin(), x.end(), 0.0) / n;
    double squares = 0, slope = 0, half_squares = 0;
    for (const double v : x) squares += (v - middle) * (v - middle);
    if (!(squares > 0)) return {{}, {}, "all arms have the same samples per pixel"};
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double weight = (x[k] - middle) / squares;
        slope += weight * y[k];
        half_squares += weight * weight * half[k] * half[k];
    }
    MetricValue out{slope, {}, std::isnan(half_squares) ? "a sample count has no interval" : ""};
    if (out.why.empty()) out.interval = {slope - std::sqrt(half_squares), slope + std::sqrt(half_squares)};
    return out;
}

}  // namespace

MetricValue ladder_metric(const MetricValue& rmse, const MetricValue& var) {
    if (rmse.value) return rmse;
    MetricValue out = var;
    const auto root = [](double v) { return std::sqrt(std::max(0.0, v)); };
    if (out.value) out.value = root(*out.value);
    if (out.interval) out.interval = {root(out.interval->first), root(out.interval->second)};
    return out;
}

const char* ladder_metric_name(const MetricValue& rmse) { return rmse.value ? "RMSE" : "standard deviation"; }

std::vector<SppLadder> ladders_of(const CompareResult& result) {
    std::vector<SppLadder> out;
    for (std::size_t a = 0; a < result.arms.size(); ++a) {
        const ArmResult& arm = result.arms[a];
        const std::string name = ladder_name(arm);
        if (name.empty()) continue;
        auto ladder = std::find_if(out.begin(), out.end(), [&](const SppLadder& l) { return l.name == name; });
        if (ladder == out.end()) ladder = out.insert(ladder, {name, {}, {}});
        ladder->arms.push_back(a);
    }
    std::erase_if(out, [](const SppLadder& l) { return l.arms.size() < 2; });
    for (SppLadder& l : out)
        std::sort(l.arms.begin(), l.arms.end(), [&](std::size_t a, std::size_t b) {
            return *result.arms[a].spp != *result.arms[b].spp ? *result.arms[a].spp < *result.arms[b].spp : a < b;
        });
    for (SppLadder& l : out)
        for (std::size_t r = 0; r < result.arms[0].regions.size(); ++r)
            l.slopes.emplace_back(result.arms[0].regions[r].region, slope_of(result, l, r));
    return out;
}

// ---- The power spectrum of the error in disjoint blocks, spread over the box: a row-column transform, F ^2 over the
// pixels of a block, averaged over rings of equal frequency in cycles per block. The mean, frequency 0, is left out.

namespace {

constexpr auto size = static_cast<std::size_t>(spectrum_block);
using Complex = std::complex<double>;
using Row = std::array<Complex, size>;

/// Returns exp(-2 pi i k / block) as a table.
const Row& roots_of_unity() {
    static const Row table = [] {
        Row t;
        for (std::size_t k = 0; k < size; ++k) {
            const double angle = -2 * std::numbers::pi * static_cast<double>(k) / spectrum_block;
            t[k] = {math::cos(angle), math::sin(angle)};
        }
        return t;
    }();
    return table;
}

/// Returns z exp(-2 pi i k / block), without the library's handling of infinities.
Complex rotated(const Complex& z, std::size_t k) {
    const Complex& w = roots_of_unity()[k];
    return {z.real() * w.real() - z.imag() * w.imag(), z.real() * w.imag() + z.imag() * w.real()};
}

/// Radix-2 transform of a row (Cooley & Tukey 1965), decimation in time.
Row transformed(const Row& x) {
    Row out;
    for (std::size_t k = 0; k < size; ++k) {
        std::size_t reversed = 0;
        for (std::size_t bit = 1; bit < size; bit *= 2) reversed = 2 * reversed + ((k & bit) ? 1 : 0);
        out[reversed] = x[k];
    }
    for (std::size_t half = 1; half < size; half *= 2) {
        for (std::size_t start = 0; start < size; start += 2 * half) {
            for (std::size_t k = 0; k < half; ++k) {
                const Complex even_part = out[start + k],
                              odd_part = rotated(out[start + k + half], k * (size / (2 * half)));
                out[start + k] = even_part + odd_part;
                out[start + k + half] = even_part - odd_part;
            }
        }
    }
    return out;
}

/// Returns the absolute frequency of bin k, in cycles per block.
double frequency(std::size_t k) { return static_cast<double>(std::min(k, size - k)); }

struct Radial {
    std::array<double, size * size> bin{};  // ring of each coefficient; -1: outside
    std::array<double, spectrum_bins> count{};
};

const Radial& radial() {
    static const Radial table = [] {
        Radial r;
        for (std::size_t v = 0; v < size; ++v) {
            for (std::size_t u = 0; u < size; ++u) {
                const long bin = std::lround(math::hypot(frequency(u), frequency(v))) - 1;
                const bool has_ring = bin >= 0 && bin < spectrum_bins;
                r.bin[v * size + u] = has_ring ? static_cast<double>(bin) : -1;
                if (has_ring) r.count[static_cast<std::size_t>(bin)] += 1;
            }
        }
        return r;
    }();
    return table;
}

void add_block(std::vector<double>& power, int x0, int y0, const std::function<double(int, int)>& error) {
    std::array<Row, size> rows;
    for (std::size_t j = 0; j < size; ++j) {
        Row row;
        for (std::size_t i = 0; i < size; ++i) row[i] = error(x0 + static_cast<int>(i), y0 + static_cast<int>(j));
        rows[j] = transformed(row);
    }
    for (std::size_t u = 0; u < size; ++u) {
        Row column;
        for (std::size_t j = 0; j < size; ++j) column[j] = rows[j][u];
        column = transformed(column);
        for (std::size_t v = 0; v < size; ++v) {
            const double value = radial().bin[v * size + u];
            if (value < 0) continue;
            const auto bin = static_cast<std::size_t>(value);
            power[bin] += std::norm(column[v]) / static_cast<double>(size * size) / radial().count[bin];
        }
    }
}

}  // namespace

void add_spectrum(
    std::vector<double>& power, const Box& box, const std::function<double(int, int)>& error, int most_blocks) {
    const int across = box.width() / spectrum_block, count = across * (box.height() / spectrum_block);
    const int step = (count + most_blocks - 1) / most_blocks;
    for (int k = 0; k < count; k += step) {
        power.resize(spectrum_bins);
        add_block(power, box.x0 + k % across * spectrum_block, box.y0 + k / across * spectrum_block, error);
    }
}

NoiseColour noise_colour(const std::vector<double>& power) {
    if (power.size() != spectrum_bins) return NoiseColour::unknown;
    const auto half = power.begin() + spectrum_bins / 2;
    const double low = std::accumulate(power.begin(), half, 0.0), high = std::accumulate(half, power.end(), 0.0);
    if (!(low + high > 0)) return NoiseColour::unknown;
    constexpr double least_ratio =
        1.25;  // 25 % more power on one side; for white noise the two differ by at most 5 % in one block
    return low > least_ratio * high ? NoiseColour::correlated
        : high > least_ratio * low  ? NoiseColour::blue
                                    : NoiseColour::white;
}

const char* to_string(NoiseColour colour) {
    switch (colour) {
        case NoiseColour::white: return "white";
        case NoiseColour::blue: return "blue";
        case NoiseColour::correlated: return "correlated";
        case NoiseColour::unknown: break;
    }
    return "unknown";
}

}  // namespace crescent
