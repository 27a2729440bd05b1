// Right samplers at random parameters are never accused. `crescent check --right N` judges as many as one likes,
// docs/error-rates.md has what came of it; here a few of every family.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "base/sanitized_test.h"
#include "laws/judged.h"
#include "laws/planted/planted.h"
#include "laws/right/law.h"
#include "laws/right/renderers.h"
#include "math/functions.h"
#include "math/spherical.h"
#include "subjects/list.h"

namespace crescent {
namespace {

std::string told(const RightLaw& law) {
    std::string out;
    for (const std::string& line : law.said) out += line;
    return out;
}

TEST(RightSamplers, OfEveryFamilyAreLeftAloneInQuickMode) {
    ProgressMonitor monitor;
    const RightLaw law = measure_right(0, 60 / test::every, TestSettings::quick(), monitor);
    EXPECT_GE(law.families.size(), 20u / test::every);
    EXPECT_EQ(law.accused, 0u) << told(law);
}

TEST(RightSamplers, OfEveryFamilyAreLeftAloneInFullMode) {
    ProgressMonitor monitor;
    TestSettings settings = TestSettings::thorough();
    settings.draws /= 8;  // as full mode integrates, with fewer draws
    const RightLaw law = measure_right(1000, 20 / test::every, settings, monitor);
    EXPECT_EQ(law.accused, 0u) << told(law);
}

/// Slivers of a rim that few points meet, corners where a horizon cuts a cone, texels that u itself is too coarse for,
/// and draws about the far pole, where 1 - cos in single precision is one number for many: with half a million draws
/// each is seen.
TEST(RightSamplers, WithThinRimsAndFineTablesAreLeftAloneInFullMode) {
    ProgressMonitor monitor;
    for (const std::uint64_t which : {116u, 306u, 296u, 106u}) {
        const RightLaw law = measure_right(which, 1, TestSettings::thorough(), monitor);
        EXPECT_EQ(law.accused, 0u) << told(law);
    }
}

/// p jumps where the half vector crosses the horizon; the first sampler of their own that people bring.
TEST(RightSamplers, WithAnisotropicVisibleNormalsAreLeftAlone) {
    ProgressMonitor monitor;
    const auto subject = subject_of(ggx_visible_at(0.1, 0.4));
    const Judgement quick = judge(trials_of_subject(subject, false), TestSettings::quick(), monitor);
    EXPECT_EQ(quick.state, State::right) << what_is_wrong(quick);
    for (std::uint32_t seed : {2u, 3u}) {
        TestSettings settings = TestSettings::thorough();
        settings.seed = seed;
        const Trial trial = trial_of_subject(subject, 60, 250);
        const Judgement full = judge({&trial, 1}, settings, monitor);
        EXPECT_EQ(full.state, State::right) << what_is_wrong(full);
    }
}

/// Differences of the warp are rounded there far more than its directions are, and its warp bends at every texel.
TEST(RightSamplers, WithASkyThatIsInterpolatedInSinglePrecisionAreLeftAlone) {
    ProgressMonitor monitor;
    for (const auto& [cells, sun] : {std::pair{16, 5.0}, {8, 0.5}, {32, 40.0}})
        for (std::uint32_t seed : {1u, 2u}) {
            TestSettings settings = TestSettings::quick();
            settings.seed = seed;
            const Judgement j = judge(trials_of_subject(subject_of(smooth_sky(cells, sun)), false), settings, monitor);
            EXPECT_EQ(j.state, State::right) << cells << " cells, seed " << seed << ": " << what_is_wrong(j);
        }
}

/// Thousands of texels in one number: only small steps stay within one, where the sphere's curve is no rounding.
TEST(RightSamplers, WithAnAliasTableOfThousandsOfTexelsAreLeftAlone) {
    ProgressMonitor monitor;
    for (int rows = 30; rows < 64; ++rows) {
        Dice dice(static_cast<std::uint64_t>(rows));
        const auto sky = subject_of(recipe_of(sky_with_sun(dice, rows, 2 * rows, 0.5, true)));
        const Judgement j = judge(trials_of_subject(sky, false), TestSettings::quick(), monitor);
        EXPECT_EQ(j.state, State::right) << rows << " rows: " << what_is_wrong(j);
    }
}

/// In single precision sqrt(1 - c c) makes stairs of a sharp lobe's warp; their slopes are no density.
TEST(RightSamplers, OfSharpLobesInSinglePrecisionAreLeftAlone) {
    ProgressMonitor monitor;
    const auto lobe = [](float s) {
        const auto p = [s](double cos) {
            return cos > 0 ? (s + 1) / (2 * pi) * std::pow(static_cast<float>(cos), s) : 0.0;
        };
        Recipe r{"Phong lobe in floats", std::to_string(s), {}, {}, {}};
        r.sample = [p, s](Vec3d, const Numbers& u) {
            const float c = std::pow(static_cast<float>(u[0]), 1 / (s + 1)), si = std::sqrt(1 - c * c);
            const float turn = 6.2831853f * static_cast<float>(u[1]);
            return Draw{{si * std::cos(turn), si * std::sin(turn), c}, p(c)};
        };
        r.pdf = [p](Vec3d, Vec3d w) { return p(w.z); };
        return r;
    };
    for (const float s : {500.0f, 5000.0f}) {
        const Judgement j = judge(trials_of_subject(subject_of(lobe(s)), false), TestSettings::quick(), monitor);
        EXPECT_EQ(j.state, State::right) << s << ": " << what_is_wrong(j);
    }
}

/// Half vectors of a measured table are at theta = u^2 pi / 2: at its axis p is as large as numbers go, and the
/// cubature that comes upon it knows no integral.
TEST(RightSamplers, WithAPoleThatNoQuadratureIntegratesAreLeftAlone) {
    const auto density = [](double theta) {
        return 1 / std::max(2 * pi * pi * std::sqrt(2 * theta / pi) * math::sin(theta), 1e-300);
    };
    Recipe r{"theta = u^2 pi / 2", "", {}, {}, {}};
    r.sample = [density](Vec3d, const Numbers& u) {
        const double theta = 0.5 * pi * u[0] * u[0];
        return Draw{math::spherical(math::cos(theta), 2 * pi * u[1]), density(theta)};
    };
    r.pdf = [density](Vec3d, Vec3d w) { return w.z > 0 ? density(math::acos(std::min(w.z, 1.0))) : 0.0; };
    const Judgement j = judged_at(subject_of(r), 0, of_draws(32768));
    EXPECT_NE(j.state, State::wrong) << what_is_wrong(j);
}

/// What explains a fault is named for four of five planted faults that have such a cause, and never where nothing is
/// wrong.
TEST(RightSamplers, HaveNothingThatADiagnosisExplains) {
    std::string told;
    EXPECT_EQ(count_false_diagnoses(2000, 60 / test::every, 1, told), 0u) << told;
}

}  // namespace
}  // namespace crescent
