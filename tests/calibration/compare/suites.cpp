// crescent_suites [--suites 100] [--views 50] [--repeats 200] [--seed S]: how often whole suites of unchanged views
// report a change, and how often a change of the size that a view states is found. Prints
// tests/calibration/results/suites.md. Renders are synthetic, so the true values are known.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "base/errors.h"
#include "base/parallel.h"
#include "compare/suite/decide.h"
#include "compare/suite/measure.h"
#include "compare/suite/suite.h"
#include "math/simd/random.h"
#include "math/statistics.h"
#include "rate_cell.h"
#include "tests/support/synthetic_renders.h"

namespace {

using namespace crescent;
using Kind = SyntheticNoise::Kind;

constexpr int side = 32, renders = 8;
constexpr double alpha = 0.05;

/// One kind of view, with the same noise on both sides.
struct ViewKind {
    std::string name;
    SyntheticNoise noise;
    double own = 0;              // 0: grey; otherwise in colour, see SyntheticScene
    bool deterministic = false;  // all renders have the same pixels
    int baseline = renders, candidate = renders;
};

std::vector<ViewKind> view_kinds() {
    SyntheticNoise filtered{Kind::gamma, 0.3};
    filtered.filter = 3;
    SyntheticNoise failing{Kind::gamma, 0.2};
    failing.failing = 0.002;
    return {{"gamma, 20 %, grey", {Kind::gamma, 0.2}}, {"gamma, 50 %, colour", {Kind::gamma, 0.5}, 0.5},
        {"gamma, 20 %, 12 and 4 renders", {Kind::gamma, 0.2}, 0, false, 12, 4},
        {"gamma, 20 %, 20 and 3 renders", {Kind::gamma, 0.2}, 0, false, 20, 3},
        {"gamma, 50 %, colour, 20 and 1 renders", {Kind::gamma, 0.5}, 0.5, false, 20, 1},
        {"lognormal, sigma 1, 20 and 3 renders", {Kind::lognormal, 1}, 0, false, 20, 3},
        {"gamma filtered over 3 x 3 (correlated), grey", filtered},
        {"gamma filtered over 3 x 3 (correlated), colour", filtered, 0.5},
        {"lognormal, sigma 1 (heavy-tailed), grey", {Kind::lognormal, 1}},
        {"Pareto, index 1.5 (heavy-tailed), grey", {Kind::pareto, 1.5}},
        {"bright events in 1 of 1000 pixels, grey", {Kind::events, 1e-3}},
        {"hits of 16 samples, 5 %, colour", {Kind::hits, 0.05}, 0.5},
        {"1 of 500 values is NaN, gamma 20 %, grey", failing}, {"deterministic", {Kind::gamma, 0.2}, 0, true}};
}

std::uint32_t seed_for(std::uint32_t seed, std::uint32_t suite, std::uint32_t view, std::uint32_t render) {
    return seed_of(seed_of(seed_of(seed, suite), view), render);
}

/// The synthetic views of a suite; `bias` makes the candidate brighter.
class SyntheticViews {
public:
    SyntheticViews(std::uint32_t seed, std::uint32_t suite) : seed_(seed), suite_(suite) {}

    SuiteView add(const ViewKind& kind, double bias = 0) {
        const auto index = static_cast<std::uint32_t>(kinds_.size());
        kinds_.push_back(&kind);
        biases_.push_back(bias);
        SuiteView view;
        view.name = std::to_string(index);
        for (int k = 0; k < kind.baseline; ++k) view.baseline.push_back(fmt::format("{} b {}", index, k));
        for (int k = 0; k < kind.candidate; ++k) view.candidate.push_back(fmt::format("{} c {}", index, k));
        return view;
    }
    RenderSource source() const {
        RenderSource out;
        out.read = [this](const std::string& path, const std::string&) {
            const std::size_t gap = path.find(' ');
            const auto view = static_cast<std::uint32_t>(std::stoul(path.substr(0, gap)));
            const bool candidate = path[gap + 1] == 'c';
            const ViewKind& kind = *kinds_[view];
            const auto k = static_cast<std::uint32_t>(std::stoul(path.substr(gap + 3)));
            SyntheticNoise noise = kind.noise;
            if (candidate) noise.bias = biases_[view];
            SyntheticScene scene;
            scene.width = side;
            scene.own = kind.own;
            const std::uint32_t render = kind.deterministic ? 0 : 2 * k + (candidate ? 1 : 0);
            return synthetic_render(path, noise, seed_for(seed_, suite_, view, render), scene);
        };
        return out;
    }

private:
    std::uint32_t seed_, suite_;
    std::vector<const ViewKind*> kinds_;
    std::vector<double> biases_;
};

Suite empty_suite() {
    Suite out;
    out.options.alpha = alpha;
    out.options.smallest = 0.05;
    return out;
}

/// States of one kind over all suites.
struct Counts {
    std::array<std::uint64_t, view_state_names.size()> states{};
    std::uint64_t of(ViewState state) const { return states[static_cast<std::size_t>(state)]; }
    std::uint64_t total() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t n : states) sum += n;
        return sum;
    }
};

void print_false_alarms(
    const std::vector<ViewKind>& kinds, std::uint32_t suites, std::uint32_t views, std::uint32_t seed) {
    std::vector<SuiteResult> results(suites);
    parallel_for(std::uint32_t{0}, suites, [&](std::uint32_t s) {
        SyntheticViews made(seed, s);
        Suite suite = empty_suite();
        for (std::uint32_t v = 0; v < views; ++v) suite.views.push_back(made.add(kinds[v % kinds.size()]));
        ProgressMonitor monitor;
        results[s] = compare_suite(suite, monitor, made.source());
    });
    std::vector<Counts> counts(kinds.size());
    std::uint64_t alarms = 0, failing = 0, improved = 0;
    for (const SuiteResult& result : results) {
        for (const ViewResult& view : result.views)
            ++counts[std::stoul(view.name) % kinds.size()].states[static_cast<std::size_t>(view.state)];
        const bool fails = exit_code(result, false) == 1, better = result.count(ViewState::improved) > 0;
        alarms += fails || better;
        failing += fails;
        improved += better;
    }
    fmt::print(
        "### False alarms of suites\n\n{} suites of {} unchanged views, {} x {} pixels, {} renders of each side unless "
        "stated; alpha = {}.\n\n| of the suites | |\n|---|---|\n| some view is changed, noisier or improved | {} |\n| "
        "exit "
        "code 1: changed or noisier | {} |\n| some view is improved | {} |\n\n",
        suites, views, side, side, renders, alpha, rate_cell(alarms, suites), rate_cell(failing, suites),
        rate_cell(improved, suites));
    fmt::print(
        "| kind of view | views | changed | noisier | improved | too few renders | same "
        "|\n|---|---|---|---|---|---|---|\n");
    for (std::size_t k = 0; k < kinds.size(); ++k)
        fmt::print("| {} | {} | {} | {} | {} | {} | {} |\n", kinds[k].name, counts[k].total(),
            counts[k].of(ViewState::changed), counts[k].of(ViewState::noisier), counts[k].of(ViewState::improved),
            counts[k].of(ViewState::too_few), counts[k].of(ViewState::same));
}

/// One of `views` views, brighter by the difference that it states as found with 90 %; level alpha / views, as in
/// Holm's method for the first test.
void print_power(const std::vector<ViewKind>& kinds, std::uint32_t repeats, std::uint32_t views, std::uint32_t seed) {
    fmt::print(
        "\n### Power of suites\n\nOne view of {}, brighter by a multiple of the difference that the unchanged view "
        "states (found with a probability of 90 %); {} repeats.\n\n| kind of view | difference stated, mean | found "
        "at that size | at half of it |\n|---|---|---|---|\n",
        views, repeats);
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const ViewKind& kind = kinds[k];
        if (kind.deterministic) continue;
        std::vector<double> stated(repeats);
        std::array<std::vector<char>, 2> found{std::vector<char>(repeats), std::vector<char>(repeats)};
        parallel_for(std::uint32_t{0}, repeats, [&](std::uint32_t r) {
            const auto measured = [&](std::uint32_t stream, double bias) {
                SyntheticViews made(seed_of(seed, 1000 + static_cast<std::uint32_t>(k)), 3 * r + stream);
                const Suite suite = empty_suite();
                ProgressMonitor monitor;
                return measure_view(suite, made.add(kind, bias), views, monitor, made.source());
            };
            const MeanTest& frame = measured(0, 0).means->regions.back();
            stated[r] = frame.why.empty() ? frame.smallest : std::nan("");
            if (std::isnan(stated[r])) return;
            for (std::uint32_t half = 0; half < 2; ++half)
                found[half][r] =
                    measured(half + 1, half ? stated[r] / 2 : stated[r]).mean_p / share_of_means <= alpha / views;
        });
        std::uint64_t of = 0, whole = 0, halved = 0;
        double sum = 0;
        for (std::uint32_t r = 0; r < repeats; ++r) {
            if (std::isnan(stated[r])) continue;
            ++of;
            sum += stated[r];
            whole += found[0][r] != 0;
            halved += found[1][r] != 0;
        }
        if (of == 0) fmt::print("| {} | heavy tail: none is stated | – | – |\n", kind.name);
        else
            fmt::print("| {} | {:.2g} % | {} | {} |\n", kind.name, 100 * sum / static_cast<double>(of),
                rate_cell(whole, of), rate_cell(halved, of));
        std::fflush(stdout);
    }
}

// ---- Nights: suites of a few views whose renders have rare bright pixels.

/// What is planted in the candidate of the first view of a suite.
struct Planted {
    std::string name;
    int white_pixels = 0;     // of one render
    int white_in_each = 0;    // of each render
    double one_exposure = 1;  // factor of one render
    double bias = 0;          // of all renders
};

/// The views of one night: heavy-tailed noise of different strength, 3 to 8 renders a side.
class Night {
public:
    static constexpr int width = 48, views = 5;
    static constexpr double fireflies = 0.02;  // expected number in a render

    Night(std::uint32_t seed, const Planted& planted) : seed_(seed), planted_(planted) {}

    Suite suite() const {
        Suite out;
        out.options.alpha = 0.01;
        out.options.smallest = 1;
        for (std::uint32_t v = 0; v < views; ++v) {
            SuiteView& view = out.views.emplace_back();
            view.name = std::to_string(v);
            for (int k = 0; k < renders_of(v); ++k) {
                view.baseline.push_back(fmt::format("{} b {}", v, k));
                view.candidate.push_back(fmt::format("{} c {}", v, k));
            }
        }
        return out;
    }
    RenderSource source() const {
        RenderSource out;
        out.read = [this](const std::string& path, const std::string&) { return render(path); };
        return out;
    }

private:
    int renders_of(std::uint32_t view) const { return 3 + static_cast<int>(seed_of(seed_, 77 + view) % 6); }
    Render render(const std::string& path) const {
        constexpr SyntheticNoise noises[] = {
            {Kind::gamma, 0.3}, {Kind::lognormal, 0.5}, {Kind::gamma, 0.5}, {Kind::lognormal, 0.3}, {Kind::hits, 0.3}};
        const std::size_t gap = path.find(' ');
        const auto view = static_cast<std::uint32_t>(std::stoul(path.substr(0, gap)));
        const auto k = static_cast<std::uint32_t>(std::stoul(path.substr(gap + 3)));
        const bool candidate = path[gap + 1] == 'c', planted = candidate && view == 0;
        const std::uint32_t seed = seed_for(seed_, 0, view, 2 * k + (candidate ? 1 : 0));
        SyntheticNoise noise = noises[view];
        if (planted) noise.bias = planted_.bias;
        SyntheticScene scene;
        scene.width = width;
        Render out = synthetic_render(path, noise, seed, scene);
        const auto uniform = [&](std::uint32_t stream) { return seed_of(seed_of(seed, 12345), stream) / 4294967296.0; };
        const auto add = [&](std::uint32_t stream, float size) {
            const auto i = static_cast<std::size_t>(uniform(stream) * static_cast<double>(out.size()));
            out.r[i] += size;
            out.g[i] += size;
            out.b[i] += size;
        };
        if (uniform(0) < fireflies) add(1, static_cast<float>(30 * std::pow(100.0, uniform(2))));
        if (!planted) return out;
        const int white = planted_.white_in_each + (k == 1 ? planted_.white_pixels : 0);
        for (int w = 0; w < white; ++w) add(100 + static_cast<std::uint32_t>(w), 1000);
        for (std::vector<float>* plane : {&out.r, &out.g, &out.b})
            for (float& x : *plane) x *= k == 1 ? static_cast<float>(planted_.one_exposure) : 1.0f;
        return out;
    }
    std::uint32_t seed_;
    Planted planted_;
};

void print_nights(std::uint32_t most_nights, std::uint32_t seed) {
    const std::vector<Planted> kinds = {{"nothing"}, {"10 white pixels in one render", 10},
        {"10 white pixels in each render", 0, 10}, {"one render is black", 0, 0, 0},
        {"one render 1.5 times as bright", 0, 0, 1.5}, {"all renders 10 % brighter", 0, 0, 1, 0.1}};
    fmt::print(
        "\n### Nights with rare bright pixels\n\n{} suites of {} views, {} x {} pixels, 3 to 8 renders of each side, "
        "gamma, lognormal and binary noise of 30 % to 55 %; {:.0f} % of the renders have a pixel that is 30 to 3000 "
        "times "
        "as bright as the mean. alpha = 0.01, smallest = 100 %. The change is in one view.\n\n| planted | exit 0 | "
        "exit 1 "
        "| exit 4 | of the planted view: changed |\n|---|---|---|---|---|\n",
        most_nights, Night::views, Night::width, Night::width, 100 * Night::fireflies);
    for (const Planted& planted : kinds) {
        const std::uint32_t nights = &planted == &kinds[0] ? most_nights : (most_nights + 2) / 3;
        std::vector<int> codes(nights), changed(nights);
        parallel_for(std::uint32_t{0}, nights, [&](std::uint32_t n) {
            const Night night(seed_of(seed, 5000 + n), planted);
            ProgressMonitor monitor;
            const SuiteResult result = compare_suite(night.suite(), monitor, night.source());
            codes[n] = exit_code(result, false);
            changed[n] = result.views[0].state == ViewState::changed;
        });
        const auto of = [&](int code) {
            return rate_cell(static_cast<std::uint64_t>(std::count(codes.begin(), codes.end(), code)), nights);
        };
        fmt::print("| {} | {} | {} | {} | {} |\n", planted.name, of(0), of(1), of(4),
            rate_cell(static_cast<std::uint64_t>(std::count(changed.begin(), changed.end(), 1)), nights));
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Measures the error rates of suites of golden images."};
    std::uint32_t suites = 100, views = 50, repeats = 200, nights = 300, seed = 1;
    app.add_option("--suites", suites, "suites of unchanged views")->capture_default_str();
    app.add_option("--views", views, "views of each")->capture_default_str();
    app.add_option("--repeats", repeats, "of each measurement of power")->capture_default_str();
    app.add_option("--nights", nights, "suites with rare bright pixels")->capture_default_str();
    app.add_option("--seed", seed, "of all renders")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        const std::vector<ViewKind> kinds = view_kinds();
        if (suites > 0) print_false_alarms(kinds, suites, views, seed);
        if (repeats > 0) print_power(kinds, repeats, views, seed);
        if (nights > 0) print_nights(nights, seed);
    } catch (const std::exception& e) {
        fmt::print(stderr, "crescent_suites: {}\n", e.what());
        return 3;
    }
    return 0;
}
