// crescent_until --bounds FILE: reads lines "p df information" and prints |t| with this p, and p of this |t| again; for
// anytime.py, which compares them with other implementations.
// crescent_until [--suites 1000] [--pairs 200] [--seed S] [--rows FILE]: how often suites whose renders are made until
// they are decided report a change that is not there, how many renders they make, and whether an 8-bit version of a
// render is decided as its floating-point version. Prints tests/calibration/results/until.md. FILE gets a line for each
// suite when it is decided; suites that have one are not decided again.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "compare/anytime.h"
#include "compare/suite/decide.h"
#include "compare/suite/measure.h"
#include "compare/suite/until.h"
#include "math/simd/random.h"
#include "math/statistics.h"
#include "output/tone_map.h"
#include "rate_cell.h"
#include "tests/support/synthetic_renders.h"

namespace {

using namespace crescent;
using Kind = SyntheticNoise::Kind;

constexpr int side = 16, baseline_renders = 12;
constexpr double alpha = 0.05, smallest = 0.03;
constexpr std::size_t most_renders = 48;  // the budget, of a candidate

/// A view: noise of both sides, its own share in each channel (0: grey), and a change of the candidate.
struct ViewKind {
    const char* name;
    SyntheticNoise noise;
    double own = 0;
    bool heavy = false;
};
const std::array<ViewKind, 5> kinds = {{{"gamma, 20 %", {Kind::gamma, 0.2}},
    {"gamma, 50 %, colour", {Kind::gamma, 0.5}, 0.5}, {"lognormal, sigma 0.5", {Kind::lognormal, 0.5}},
    {"hits of 16 samples, 30 %", {Kind::hits, 0.3}}, {"Pareto, index 1.5", {Kind::pareto, 1.5}, 0, true}}};

/// A suite of one view of each kind, whose candidates are made in memory.
class MadeSuite {
public:
    MadeSuite(std::uint32_t seed, double bias) : seed_(seed), bias_(bias) {
        suite_.options.alpha = alpha;
        suite_.options.smallest = smallest;
        suite_.options.candidate = {"c/{view}-*.exr"};
        suite_.candidate.emplace_back("c/{view}-*.exr", SourceLocation{}, true);
        for (std::size_t v = 0; v < kinds.size(); ++v) {
            SuiteView& view = suite_.views.emplace_back();
            view.name = std::to_string(v);
            for (int k = 1; k <= baseline_renders; ++k) view.baseline.push_back(fmt::format("b/{}-{}.exr", v, k));
        }
    }
    SuiteResult decide() {
        RenderSides sides;
        sides.candidate = parse_render_command("program {view} {seed} {out}", "--render");
        std::array<std::size_t, kinds.size()> made{};
        const Renderer render = [&](const std::vector<RenderJob>& jobs) {
            std::vector<RenderEnd> out(jobs.size());
            for (std::size_t k = 0; k < jobs.size(); ++k)
                out[k].is_made = made[std::stoul(jobs[k].view)]++ < most_renders;
            return out;
        };
        ProgressMonitor monitor;
        const SuiteResult result = decide_by_renders(suite_, sides, render, source(), {}, monitor);
        for (std::size_t v = 0; v < kinds.size(); ++v) renders[v] = suite_.views[v].candidate.size();
        return result;
    }
    /// Decides once, by a number of renders of the candidate that was fixed before.
    SuiteResult decide_once(std::size_t count) {
        for (std::size_t v = 0; v < kinds.size(); ++v)
            for (std::size_t k = 1; k <= count; ++k)
                suite_.views[v].candidate.push_back(fmt::format("c/{}-{}.exr", v, baseline_renders + k));
        ProgressMonitor monitor;
        return compare_suite(suite_, monitor, source());
    }
    std::array<std::size_t, kinds.size()> renders{};

private:
    RenderSource source() const {
        RenderSource source;
        source.read = [this](const std::string& path, const std::string&) {
            const bool candidate = path[0] == 'c';
            const std::size_t dash = path.find('-');
            const auto view = static_cast<std::uint32_t>(std::stoul(path.substr(2, dash - 2)));
            const auto number = static_cast<std::uint32_t>(std::stoul(path.substr(dash + 1)));
            SyntheticNoise noise = kinds[view].noise;
            if (candidate) noise.bias = bias_;
            SyntheticScene scene;
            scene.width = side;
            scene.own = kinds[view].own;
            return synthetic_render(
                path, noise, seed_of(seed_of(seed_, view), 2 * number + (candidate ? 1 : 0)), scene);
        };
        return source;
    }

    std::uint32_t seed_;
    double bias_;
    Suite suite_;
};

struct Outcome {
    std::array<ViewState, kinds.size()> states{};
    std::array<std::size_t, kinds.size()> renders{};
    bool alarm = false;
};

/// The outcomes that are decided, by bias and seed of the suite. Each is a line of the file, if there is one.
class Rows {
public:
    explicit Rows(const std::string& path) {
        if (path.empty()) return;
        std::ifstream before(path);
        for (std::string line; std::getline(before, line) && !before.eof();) {  // the last line may be cut off
            std::istringstream in(line);
            Key key;
            Outcome row;
            in >> key.first >> key.second >> row.alarm;
            for (std::size_t v = 0; v < kinds.size(); ++v) {
                std::size_t state = 0;
                in >> state >> row.renders[v];
                row.states[v] = static_cast<ViewState>(state);
            }
            if (in) rows_[key] = row;
        }
        file_.open(path, std::ios::app);
        file_ << '\n';  // ends a line that was cut off
    }
    const Outcome* find(double bias, std::uint32_t seed) {
        const Guard guard(lock_);
        const auto found = rows_.find({bias, seed});
        return found == rows_.end() ? nullptr : &found->second;
    }
    void add(double bias, std::uint32_t seed, const Outcome& row) {
        const Guard guard(lock_);
        rows_[{bias, seed}] = row;
        if (!file_.is_open()) return;
        file_ << fmt::format("{} {} {:d}", bias, seed, row.alarm);
        for (std::size_t v = 0; v < kinds.size(); ++v)
            file_ << fmt::format(" {} {}", static_cast<std::size_t>(row.states[v]), row.renders[v]);
        file_ << std::endl;
    }

private:
    using Key = std::pair<double, std::uint32_t>;
    std::map<Key, Outcome> rows_;
    std::ofstream file_;
    Mutex lock_;
};

Outcome outcome(double bias, std::uint32_t seed) {
    MadeSuite made(seed, bias);
    const SuiteResult result = made.decide();
    Outcome out;
    out.renders = made.renders;
    for (std::size_t v = 0; v < kinds.size(); ++v) {
        const ViewState state = out.states[v] = result.views[v].state;
        out.alarm |= state == ViewState::changed || state == ViewState::noisier || state == ViewState::improved;
    }
    return out;
}

std::vector<Outcome> outcomes(std::uint32_t suites, double bias, std::uint32_t seed, Rows& rows) {
    std::vector<Outcome> out(suites);
    std::uint32_t count = 0;
    Mutex lock;
    parallel_for(std::uint32_t{0}, suites, [&](std::uint32_t s) {
        const std::uint32_t own = seed_of(seed, s);
        if (const Outcome* before = rows.find(bias, own)) out[s] = *before;
        else rows.add(bias, own, out[s] = outcome(bias, own));
        const Guard guard(lock);
        fmt::print(stderr, "\r{} of {} suites, {:g} % brighter", ++count, suites, 100 * bias);
    });
    fmt::print(stderr, "\n");
    return out;
}

/// Returns for each view the smallest number of renders, fixed before, with which at least as many views have the same
/// decision (same, or changed if there is a bias) as in `all`; most_renders if that is not reached.
std::array<std::size_t, kinds.size()> fixed_plan(const std::vector<Outcome>& all, double bias, std::uint32_t seed) {
    constexpr std::uint32_t suites = 40;
    const ViewState wanted = bias > 0 ? ViewState::changed : ViewState::same;
    std::array<std::size_t, kinds.size()> out{};
    out.fill(most_renders);
    for (std::size_t count = most_renders; count >= 4; count -= count > 12 ? 4 : count > 8 ? 2 : 1) {
        std::array<std::uint32_t, kinds.size()> decided{};
        Mutex lock;
        parallel_for(std::uint32_t{0}, suites, [&](std::uint32_t s) {
            const SuiteResult result = MadeSuite(seed_of(seed, s), bias).decide_once(count);
            const Guard guard(lock);
            for (std::size_t v = 0; v < kinds.size(); ++v) decided[v] += result.views[v].state == wanted;
        });
        for (std::size_t v = 0; v < kinds.size(); ++v) {
            const auto reached =
                std::count_if(all.begin(), all.end(), [&](const Outcome& o) { return o.states[v] == wanted; });
            if (decided[v] * all.size() >= static_cast<std::size_t>(reached) * suites && reached > 0) out[v] = count;
        }
    }
    return out;
}

void print_outcomes(const std::vector<Outcome>& all, double bias, std::uint32_t seed, const char* what) {
    const std::array<std::size_t, kinds.size()> fixed = fixed_plan(all, bias, seed);
    fmt::print(
        "\n| {} | changed | noisier or improved | same | undecided | renders, mean | fixed plan "
        "|\n|---|---|---|---|---|---|---|\n",
        what);
    for (std::size_t v = 0; v < kinds.size(); ++v) {
        std::array<std::uint64_t, view_state_names.size()> states{};
        double renders = 0;
        for (const Outcome& o : all) {
            ++states[static_cast<std::size_t>(o.states[v])];
            renders += static_cast<double>(o.renders[v]) / static_cast<double>(all.size());
        }
        const auto of = [&](ViewState s) { return states[static_cast<std::size_t>(s)]; };
        fmt::print("| {} | {} | {} | {} | {} | {:.1f} | {} |\n", kinds[v].name, of(ViewState::changed),
            of(ViewState::noisier) + of(ViewState::improved), of(ViewState::same), of(ViewState::too_few), renders,
            fixed[v] == most_renders ? fmt::format("{} or more", most_renders) : std::to_string(fixed[v]));
    }
    std::fflush(stdout);
}

// ---- Renders and their 8-bit versions.

/// The render as a display gets it, read again: sRGB, 8 bits.
Render eight_bits(Render render) {
    for (std::vector<float>* plane : {&render.r, &render.g, &render.b})
        for (float& value : *plane)
            value = static_cast<float>(srgb_decode(srgb_byte(static_cast<double>(value)) / 255.0));
    render.steps = {.levels = 256, .srgb = true};
    render.rounding = 0;
    render.display_referred = true;
    return render;
}

/// Decides a pair of sides of 8 renders, in floating point or of 8 bits; mean 0.2, so that little is clipped.
ViewState decided(std::uint32_t seed, double noise, double change, bool whole) {
    Suite suite;
    suite.options.alpha = alpha;
    suite.options.smallest = 0.05;
    SuiteView& view = suite.views.emplace_back();
    view.name = "view";
    for (int k = 0; k < 8; ++k) {
        view.baseline.push_back(fmt::format("b {}", k));
        view.candidate.push_back(fmt::format("c {}", k));
    }
    RenderSource source;
    source.read = [&](const std::string& path, const std::string&) {
        const bool candidate = path[0] == 'c';
        const SyntheticNoise kind{Kind::gamma, noise, candidate ? change : 0};
        Render r = synthetic_render(path, kind,
            seed_of(seed, 2 * static_cast<std::uint32_t>(std::stoul(path.substr(2))) + (candidate ? 1 : 0)),
            SyntheticScene{});
        for (std::vector<float>* plane : {&r.r, &r.g, &r.b})
            for (float& value : *plane) value *= 0.2f;
        return whole ? eight_bits(std::move(r)) : r;
    };
    ProgressMonitor monitor;
    return compare_suite(suite, monitor, source).views[0].state;
}

void print_pairs(std::uint32_t pairs, std::uint32_t seed) {
    fmt::print(
        "\n| noise of a pixel | change | pairs | float: changed | 8 bits: changed | equal decisions |\n"
        "|---|---|---|---|---|---|\n");
    for (const double noise : {0.02, 0.1, 0.4})
        for (const double change : {0.0, 0.002, 0.01, 0.03}) {
            const std::uint32_t count = pairs / 12 + (pairs % 12 > 0);
            std::vector<std::array<bool, 2>> changed(count);
            parallel_for(std::uint32_t{0}, count, [&](std::uint32_t k) {
                const std::uint32_t own = seed_of(seed, k + 1000 * static_cast<std::uint32_t>(1e4 * (noise + change)));
                for (const bool whole : {false, true})
                    changed[k][whole] = decided(own, noise, change, whole) == ViewState::changed;
            });
            std::size_t floats = 0, bytes = 0, equal = 0;
            for (const auto& [f, b] : changed) {
                floats += f;
                bytes += b;
                equal += f == b;
            }
            fmt::print(
                "| {:g} % | {:g} % | {} | {} | {} | {} |\n", 100 * noise, 100 * change, count, floats, bytes, equal);
            std::fflush(stdout);
        }
}

int print_bounds(const std::string& file) {
    std::ifstream in(file);
    double p = 0, df = 0, information = 0;
    while (in >> p >> df >> information) {
        const double t = anytime_quantile(p, df, information);
        fmt::print("{} {}\n", t, anytime_p(t, df, information));
    }
    return in.eof() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Measures decisions that may be taken after any render, and those of 8-bit files."};
    std::uint32_t suites = 1000, pairs = 200, seed = 1;
    app.add_option("--suites", suites, "unchanged suites; a tenth as many are changed")->capture_default_str();
    app.add_option("--pairs", pairs, "of a render and its 8-bit version")->capture_default_str();
    app.add_option("--seed", seed, "of all renders")->capture_default_str();
    std::string bounds, file;
    app.add_option("--rows", file, "gets a line for each suite; those that it has are not decided again");
    app.add_option("--bounds", bounds, "lines of p, df and information: prints bounds, and nothing else");
    CLI11_PARSE(app, argc, argv);
    if (!bounds.empty()) return print_bounds(bounds);
    if (suites > 0) {
        Rows rows(file);
        const std::vector<Outcome> all = outcomes(suites, 0, seed, rows);
        const auto alarms =
            static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), [](const Outcome& o) { return o.alarm; }));
        fmt::print(
            "{} suites of {} unchanged views, {} x {} pixels, {} renders of the baseline, at most {} of the "
            "candidate, smallest = {:g} %, alpha = {:g}: {} report a change.\n",
            suites, kinds.size(), side, side, baseline_renders, most_renders, 100 * smallest, alpha,
            rate_cell(alarms, suites));
        std::fflush(stdout);
        print_outcomes(all, 0, seed_of(seed, 98), "unchanged views");
        for (const double bias : {0.03, 0.1})
            print_outcomes(outcomes(std::max(20u, suites / 10), bias, seed_of(seed, 99), rows), bias, seed_of(seed, 97),
                fmt::format("{:g} % brighter", 100 * bias).c_str());
    }
    if (pairs > 0) print_pairs(pairs, seed);
    return 0;
}
