// Renders that are made until a view is decided: on synthetic renders in memory, and by programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <random>

#include "compare/anytime.h"
#include "compare/suite/decide.h"
#include "compare/suite/until.h"
#include "math/simd/random.h"
#include "math/statistics.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/synthetic_renders.h"

namespace crescent {
namespace until_test {

using ::testing::HasSubstr;
using Kind = SyntheticNoise::Kind;
constexpr int side = 24;

/// A suite whose candidate is made in memory; the baseline has 12 renders.
struct Made {
    Suite suite;
    RenderSides sides;
    SyntheticNoise before{Kind::gamma, 0.2}, after{Kind::gamma, 0.2};
    bool constant = false;
    std::size_t render_limit = 200;
    int width = side;
    std::string failure;
    double seconds = 0, stopped_after = 0;  // of a program, and of those beyond `render_limit`
    ProgressMonitor silent;
    ProgressMonitor* monitor = &silent;

    Made() {
        suite.options.smallest = 0.02;
        suite.options.candidate = {"out/{view}-*.exr"};
        suite.candidate.emplace_back("out/{view}-*.exr", SourceLocation{}, true);
        SuiteView& view = suite.views.emplace_back();
        view.name = "view";
        for (int k = 1; k <= 12; ++k) view.baseline.push_back(fmt::format("base/view-{}.exr", k));
        sides.candidate = parse_render_command("pt {view} {seed} {out}", "--render");
    }
    SuiteResult decide(std::uint32_t seed = 1) {
        RenderSource source;
        source.read = [&, seed](const std::string& path, const std::string&) {
            const bool is_candidate = path.starts_with("out");
            const std::size_t dash = path.rfind('-');
            auto number = static_cast<std::uint32_t>(std::stoul(path.substr(dash + 1)));
            if (constant && is_candidate) number = 1;
            SyntheticScene scene;
            scene.width = width;
            return synthetic_render(
                path, is_candidate ? after : before, seed_of(seed, 2 * number + (is_candidate ? 1 : 0)), scene);
        };
        const Renderer render = [&](const std::vector<RenderJob>& jobs) {
            std::vector<RenderEnd> out(jobs.size());
            for (std::size_t k = 0; k < jobs.size(); ++k) {
                if (!failure.empty()) out[k].failure = failure;
                else if (made < render_limit) {
                    out[k].is_made = true;
                    out[k].seconds = seconds;
                    ++made;
                } else {
                    out[k].is_stopped = stopped_after > 0;
                    out[k].seconds = stopped_after;
                }
                seeds.push_back(jobs[k].seed);
            }
            return out;
        };
        return decide_by_renders(suite, sides, render, source, {}, *monitor);
    }
    std::size_t made = 0;
    std::vector<std::uint64_t> seeds;
};

TEST(Until, AnUnchangedViewEndsAsSameAndAChangedOneAsChanged) {
    Made same;
    EXPECT_EQ(same.decide().views[0].state, ViewState::same);
    EXPECT_GE(same.made, first_renders);
    EXPECT_LT(same.made, 60u);
    for (const std::uint64_t seed : same.seeds) EXPECT_GT(seed, 12u);  // those of the baseline are not used again
    Made changed;
    changed.after.bias = 0.05;
    EXPECT_EQ(changed.decide().views[0].state, ViewState::changed);
    EXPECT_LE(changed.made, same.made + 20);
}

TEST(Until, TheEndOfTheBudgetLeavesAViewUndecidedWithANumber) {
    Made few;
    few.suite.options.smallest = 0.0005;
    few.render_limit = 5;
    const ViewResult view = few.decide().views[0];
    EXPECT_EQ(view.state, ViewState::too_few);
    EXPECT_THAT(view.headline, HasSubstr("more renders"));
}

TEST(Until, AProgramThatTheBudgetStopsIsNamed) {
    for (const std::size_t limit : {std::size_t{0}, std::size_t{5}}) {
        Made slow;
        slow.suite.options.smallest = 0.0005;
        slow.render_limit = limit;
        slow.stopped_after = 90;
        const ViewResult view = slow.decide().views[0];
        EXPECT_EQ(view.state, ViewState::too_few);
        for (const std::string* text : {&view.headline, &view.sentence})
            EXPECT_THAT(*text, HasSubstr("The program was stopped after 90.0 s, at the end of the budget."));
        EXPECT_LE(view.headline.size(), longest_headline);
    }
}

TEST(Until, AProgramThatIsStoppedAfterItsUsualTimeIsNotNamed) {
    Made slow;
    slow.suite.options.smallest = 0.0005;
    slow.render_limit = 5;
    slow.seconds = 60;
    slow.stopped_after = 90;
    EXPECT_THAT(slow.decide().views[0].sentence, ::testing::Not(HasSubstr("stopped")));
}

TEST(Until, EachRoundIsLogged) {
    struct Log : ProgressMonitor {
        void log(std::string_view line) override { lines.emplace_back(line); }
        std::vector<std::string> lines;
    } log;
    Made made;
    made.monitor = &log;
    (void)made.decide();
    ASSERT_GE(log.lines.size(), 2u);
    EXPECT_EQ(log.lines[0], "0 of 1 view decided; making 4 renders");
}

TEST(Until, ASecondCallUsesTheRendersThatAreThere) {
    Made first;
    EXPECT_EQ(first.decide().views[0].state, ViewState::same);
    Made second;
    second.suite.views = first.suite.views;
    EXPECT_EQ(second.decide().views[0].state, ViewState::same);
    EXPECT_EQ(second.made, 0u);
}

TEST(Until, ProgramsThatFailOrIgnoreTheSeedAreNamed) {
    Made failing;
    failing.failure = "ended with signal 11 (SIGSEGV)";
    const SuiteResult crashed = failing.decide();
    EXPECT_EQ(crashed.views[0].state, ViewState::unreadable);
    EXPECT_THAT(crashed.views[0].sentence, HasSubstr("The program ended with signal 11 (SIGSEGV) for seed 13"));
    EXPECT_EQ(exit_code(crashed, false), 2);
    Made ignoring;
    ignoring.constant = true;
    EXPECT_THAT(ignoring.decide().views[0].sentence, HasSubstr("ignores the seed"));
}

TEST(Until, BlackRendersAreAChangeAndNotASeedThatIsIgnored) {
    Made black;
    black.after.bias = -1;
    const ViewResult view = black.decide().views[0];
    EXPECT_EQ(view.state, ViewState::changed) << view.sentence;
    EXPECT_EQ(black.made, 4u);
}

/// Two commands whose renders are made in memory; `noise_of` returns the number of the noise of a side for a seed.
ViewResult decide_two(const std::string& command,
    const std::function<std::uint64_t(bool is_b, std::uint64_t)>& noise_of, bool pair = false,
    const char* tolerance = nullptr, float difference = 0) {
    RenderSides sides;
    sides.baseline = parse_render_command(command, "--a");
    sides.candidate = parse_render_command(command, "--b");
    sides.same_seeds = pair;
    Suite stated;
    stated.options.noise = NoiseDemand::ignore;
    stated.options.smallest = 0.05;
    if (tolerance) stated.options.tolerance = parse_tolerance(tolerance);
    Suite suite = suite_of_commands(sides, views_of_commands(sides, {"v9"}), "no-such-folder", stated);
    RenderSource source;
    source.read = [&](const std::string& path, const std::string&) {
        const bool is_b = path.find("/b/") != std::string::npos;
        const auto number = static_cast<std::uint32_t>(noise_of(is_b, std::stoull(path.substr(path.rfind('-') + 1))));
        Render out = synthetic_render(path, {Kind::gamma, 0.2}, number, SyntheticScene{});
        if (is_b)
            for (std::vector<float>* plane : {&out.r, &out.g, &out.b})
                for (float& value : *plane) value *= 1 + difference;
        return out;
    };
    const Renderer render = [&](const std::vector<RenderJob>& jobs) {
        std::vector<RenderEnd> out(jobs.size());
        for (RenderEnd& end : out) end.is_made = true;
        return out;
    };
    ProgressMonitor monitor;
    UntilOptions until;
    until.most_renders = 100;
    const SuiteResult result = decide_by_renders(suite, sides, render, source, until, monitor);
    const ViewState state = result.views[0].state;
    EXPECT_EQ(exit_code(result, false), state == ViewState::same ? 0 : state == ViewState::changed ? 1 : 4);
    return result.views[0];
}

TEST(Until, TwoCommandsWhoseRendersIgnoreTheSeedAreUndecided) {
    const char *with_seed = "pt {view} {seed} {out}", *without = "pt {view} {out}";
    const auto independent = [](bool is_b, std::uint64_t seed) { return 2 * (seed % 100'000) + is_b; };
    const auto one = [](bool, std::uint64_t) -> std::uint64_t { return 7; };
    const auto one_each = [](bool is_b, std::uint64_t) -> std::uint64_t { return is_b ? 8 : 7; };
    const auto low_byte = [](bool, std::uint64_t seed) { return seed & 255; };  // 500 000 001 and 1 have the same
    const auto by_seed = [](bool, std::uint64_t seed) { return seed % 100'000'000; };
    EXPECT_EQ(decide_two(with_seed, independent).state, ViewState::same);
    EXPECT_EQ(decide_two(with_seed, by_seed, true).state, ViewState::same);  // the same seeds on purpose
    for (const auto& constant : {std::function<std::uint64_t(bool, std::uint64_t)>(one), {one_each}}) {
        const ViewResult view = decide_two(with_seed, constant);
        EXPECT_EQ(view.state, ViewState::too_few);
        EXPECT_THAT(view.headline, HasSubstr("the programs ignore {seed}"));
        EXPECT_THAT(view.sentence, HasSubstr("'--seed {seed}'"));
        EXPECT_EQ(view.candidate_renders, 1u);  // different ones; it stops after the first round
        EXPECT_THAT(decide_two(without, constant).headline, HasSubstr("neither command has {seed}"));
    }
    EXPECT_EQ(decide_two(with_seed, one, true).state, ViewState::too_few);
    for (const auto& [command, remedy] : {std::pair{with_seed, "--pair"}, std::pair{without, "Write {seed}"}}) {
        const ViewResult equal = decide_two(command, low_byte);
        EXPECT_EQ(equal.state, ViewState::too_few);
        EXPECT_THAT(equal.headline, HasSubstr("with seed 1 and of b with seed 500000001 are equal"));
        EXPECT_THAT(equal.sentence, HasSubstr(remedy));
    }
}

TEST(Until, TwoCommandsWithoutNoiseAreComparedWithATolerance) {
    const auto one = [](bool, std::uint64_t) -> std::uint64_t { return 7; };
    EXPECT_EQ(decide_two("pt {view} {out}", one, false, "0 ulp").state, ViewState::same);
    EXPECT_EQ(decide_two("pt {view} {out}", one, false, "0 ulp", 1e-3f).state, ViewState::changed);
    EXPECT_EQ(decide_two("pt {view} {out}", one, false, "0.5 %", 1e-3f).state, ViewState::same);
}

TEST(Until, HeavyTailsEndAsUndecided) {
    for (const int width : {side, 16})
        for (std::uint32_t seed = 1; seed < 5; ++seed) {
            Made heavy;
            heavy.before = heavy.after = {Kind::pareto, 1.5};
            heavy.render_limit = 60;
            heavy.width = width;
            EXPECT_EQ(heavy.decide(seed).views[0].state, ViewState::too_few) << width << " " << seed;
        }
}

/// Normal noise, tested after each of 60 renders: p is ever below alpha at most as often as alpha.
TEST(Anytime, PHoldsAtEveryLook) {
    for (const double alpha : {0.05, 0.2}) {
        int alarms = 0, fixed = 0;
        constexpr int runs = 1500, renders = 60;
        for (int run = 0; run < runs; ++run) {
            std::mt19937 random(static_cast<unsigned>(run));
            std::normal_distribution<double> normal(3, 7);
            double sum = 0, squares = 0;
            bool alarm = false, repeated = false;
            for (int n = 1; n <= renders; ++n) {
                const double x = normal(random) - 3;
                sum += x;
                squares += x * x;
                if (n < 2) continue;
                const double mean = sum / n, se = std::sqrt((squares - n * mean * mean) / (n - 1) / n);
                alarm |= anytime_p(mean / se, n - 1, n) <= alpha;
                repeated |= two_sided_p(mean / se, n - 1) <= alpha;
            }
            alarms += alarm;
            fixed += repeated;
        }
        const double limit = alpha + 3 * std::sqrt(alpha * (1 - alpha) / runs);
        EXPECT_LE(alarms / static_cast<double>(runs), limit);
        EXPECT_GT(fixed / static_cast<double>(runs), 2 * alpha);  // repeated tests do not hold
    }
}

TEST(Anytime, TheQuantileHasItsP) {
    for (const double df : {3.0, 14.0, 400.0})
        for (const double p : {0.05, 1e-3, 1e-6}) {
            const double t = anytime_quantile(p, df, 10);
            if (std::isfinite(t)) EXPECT_NEAR(anytime_p(t, df, 10) / p, 1, 1e-9);
            EXPECT_GT(t, student_quantile(1 - p / 2, df));
        }
    // Howard et al. 2021, (14), for known variance: t^2 = (1 + 1 / (n r)) (2 log(1 / p) + log(1 + n r)), here n r = 80.
    EXPECT_NEAR(anytime_quantile(0.01, 1e9, 10), std::sqrt(81.0 / 80 * (2 * std::log(100) + std::log(81))), 1e-3);
}

class Programs : public ScratchFolder {
protected:
    RenderEnd make(
        const std::string& program, const std::string& view = "v", double timeout = 60, double budget = 600) {
        const RenderCommand command = parse_render_command(program, "--render");
        RenderLimits limits;
        limits.timeout = timeout;
        limits.end = std::chrono::steady_clock::now() + std::chrono::milliseconds(std::lround(1000 * budget));
        ProgressMonitor monitor;
        return make_renders({{&command, view, path("out/" + view + "-1.pfm"), 7}}, limits, monitor)[0];
    }
};

TEST_F(Programs, AreGivenTheirValuesAsWordsThatNoShellReads) {
    const RenderCommand command = parse_render_command("pt '{view}' -s {seed} \"a b\" c\\ d -o={out}", "--render");
    EXPECT_THAT(command.for_render("$(touch x); {out}", 7, "/o"),
        ::testing::ElementsAre("pt", "$(touch x); {out}", "-s", "7", "a b", "c d", "-o=/o"));
    const RenderCommand png = parse_render_command("pt -o={out}.png {out}.log", "--render");
    EXPECT_EQ(png.extension, "png");
    EXPECT_THAT(png.for_render("v", 7, "/o.png"), ::testing::ElementsAre("pt", "-o=/o.png", "/o.png.log"));
    for (const char* bad : {"", "pt", "pt 'x {out}", "pt {out} \\", "pt {out}.png {out}.exr"})
        EXPECT_NE(refusal([&] { return parse_render_command(bad, "--render"); }), "") << bad;
}

TEST_F(Programs, ThatFailAreNamedAndLeaveNoFile) {
    EXPECT_TRUE(make("sh -c 'printf \"Pf\\n1 1\\n-1\\n1234\" >\"$0\"' {out}").is_made);
    EXPECT_TRUE(std::filesystem::exists(path("out/v-1.pfm")));
    std::filesystem::remove(path("out/v-1.pfm"));
    EXPECT_THAT(make("sh -c 'echo out of memory >&2; exit 3' {out}").failure, HasSubstr("exit code 3: out of memory"));
    EXPECT_THAT(make("sh -c 'kill -SEGV $$' {out}").failure, HasSubstr("signal 11"));
    EXPECT_EQ(make("true {out}").failure, "wrote no file");
    EXPECT_THAT(make("sh -c 'printf \"Pf\\n9 9\\n-1\\n1234\" >\"$0\"' {out}").failure, HasSubstr("cannot be read"));
    EXPECT_THAT(make("sh -c 'sleep 60' {out}", "v", 0.2).failure, HasSubstr("did not end within 0.2 s"));
    EXPECT_THAT(make("./no-such-program {out}").failure, HasSubstr("no-such-program"));
    const RenderEnd over = make("sh -c 'sleep 60' {out}", "v", 60, 0.2);
    EXPECT_TRUE(over.is_stopped && !over.is_made && over.failure.empty());
    EXPECT_GE(over.seconds, 0.2);
    EXPECT_TRUE(std::filesystem::is_empty(path("out")));
}

}  // namespace until_test
}  // namespace crescent
