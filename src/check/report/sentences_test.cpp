// What a verdict states without a fault: its limits, and the density that draws without pdf(w) imply.
#include "check/report/sentences.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "check/report/implied.h"
#include "tests/support/explained.h"

namespace crescent::check {
namespace sentences_test {

using ::testing::HasSubstr;

TEST(ImpliedDensities, AreThoseOfTheDraws) {
    FunctionSampler s;
    s.of.has_pdf = false;
    s.change = [](const PrimarySample&, Draw& d) { d.pdf = 1; };
    const CheckAt c = check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1);
    Verdict v;
    note_implied_density(c, v);
    ASSERT_TRUE(v.implied);
    EXPECT_EQ(v.implied->rings.size(), 18u);  // of 5 degrees, up to the horizon
    for (const ImpliedDensity::Ring& ring : v.implied->rings) {
        // cos / pi averages (sin^2 to - sin^2 from) / (2 pi (cos from - cos to)) over a ring.
        const double a = ring.from * pi / 180, b = ring.to * pi / 180;
        const double mean = (sqr(std::sin(b)) - sqr(std::sin(a))) / (2 * pi * (std::cos(a) - std::cos(b)));
        EXPECT_NEAR(ring.pdf, mean, 5 * ring.error + 1e-12);
        EXPECT_LT(ring.error, 0.2 * mean);
    }
    EXPECT_NEAR(v.implied->peak, 1 / pi, 4 * v.implied->peak_error);
    EXPECT_LT(v.implied->peak_error, 0.05);
    double mass = 0;
    for (const auto& row : v.evidence["implied_bins"]["rows"])
        mass += (row[1].get<double>() - row[0].get<double>()) * (row[3].get<double>() - row[2].get<double>()) *
            row[4].get<double>();
    EXPECT_NEAR(mass, 1, 1e-9);
}

const Verdict& verdict(const std::vector<Verdict>& all, std::string_view name) {
    return *std::ranges::find(all, name, &Verdict::name);
}

TEST(LimitsOfVerdicts, WithoutAPdfOrWeightsAreStated) {
    FunctionSampler s;
    s.of.has_pdf = false;
    s.change = [](const PrimarySample&, Draw& d) { d.pdf = 1; };
    const auto alone = checked(s).verdicts();
    EXPECT_EQ(verdict(alone, "density").state, State::inconclusive);
    EXPECT_EQ(verdict(alone, "normalised").state, State::skipped);
    EXPECT_TRUE(verdict(alone, "density").implied);
    s.f_value = lambert(0.5);
    s.change = [](const PrimarySample&, Draw& d) {
        d.pdf = 1;
        d.weight = 0.5;
        d.weights = {0.5, 0, 0};
    };
    const auto with_weights = checked(s).verdicts();
    EXPECT_EQ(verdict(with_weights, "density").state, State::skipped);
    EXPECT_EQ(verdict(with_weights, "mean").state, State::right);
}

TEST(SentencesOfRightVerdicts, HaveTheMeasuredNumbers) {
    FunctionSampler s;
    s.f_value = lambert(0.5);
    s.weights = [](Vec3d, Vec3d) { return Vec3d{0.5, 0, 0}; };
    const Explained r = checked(s);
    const CheckAt& at = r.outcomes.at(0).checks.at(0).at(0);
    EXPECT_THAT(text_of(sentences_of_right(at, "normalised")), HasSubstr("p integrates to 1.0000"));
    EXPECT_NEAR(std::stod(text_of(sentences_of_right(at, "physics"))), 0.5, 1e-3);
    EXPECT_THAT(text_of(sentences_of_right(at, "mean")), HasSubstr("Weights average to 1.000"));
    EXPECT_TRUE(sentences_of_right(at, "tail").empty());
}

TEST(SentencesOfFindings, HaveTheSizeOfTheFault) {
    const Explained r = checked(made(cosine_draw, [](Vec3d o, Vec3d w) { return 1.25 * cosine_pdf(o, w); }));
    const CheckAt& at = r.outcomes.at(0).checks.at(0).at(0);
    const auto mass_finding =
        std::ranges::find_if(at.findings, [](const Finding& f) { return f.first.family == Family::mass; });
    ASSERT_NE(mass_finding, at.findings.end());
    const Sentences sentences = sentences_of(at, *mass_finding);
    ASSERT_EQ(sentences.size(), 2u);
    EXPECT_EQ(sentences[0].what, "integral");
    EXPECT_THAT(sentences[0].text, HasSubstr("1.25"));
    EXPECT_EQ(sentences[1].what, Sentence::expected);
}

/// The sentence has the share that the test measured: its interval does not contain that of p.
TEST(Sentences, OfANodeStateWhatItsTestMeasured) {
    FunctionSampler s;  // 52 % of the draws have an azimuth below 180 degrees
    s.draw = [](Vec3d o, const PrimarySample& u) {
        PrimarySample moved = u;
        moved[1] = u[1] < 0.52 ? u[1] / 1.04 : 1 - (1 - u[1]) / 0.96;
        return cosine_draw(o, moved);
    };
    const CheckAt c = check_sampler_at(s, 0, {0, 0, 1}, {}, CheckBudget::limited(), 1);
    const auto node = std::ranges::find_if(c.findings,
        [](const Finding& f) { return f.first.family == Family::node || f.first.family == Family::node_sets; });
    ASSERT_NE(node, c.findings.end());
    double drawn = 0, half = 0, claimed = 0;
    const std::string text = text_of(sentences_of(c, *node));
    ASSERT_EQ(std::sscanf(text.c_str() + text.find(" +- ") - 6, "%lf +- %lf", &drawn, &half), 2) << text;
    ASSERT_EQ(std::sscanf(text.c_str() + text.find("p has ") + 6, "%lf", &claimed), 1) << text;
    EXPECT_GT(std::fabs(drawn - claimed), half) << text;
}

/// pow(1 - cos, 5) is not a number there, and is one at the normal itself.
TEST(Sentences, HaveTheLengthThatRoundingLeaves) {
    SmallFault f{.family = Family::corners, .times = 1, .trials = 8, .what = "The pdf is not a number >= 0"};
    f.wo = Vec3d{0, 0, 1};
    EXPECT_NE(sentence_of(f, {}).text.find("first at w_o = (0, 0, 1), "), std::string::npos);
    f.wo = Vec3d{0, 0, 1 + 0x1p-22};
    EXPECT_NE(sentence_of(f, {}).text.find("first at w_o = (0, 0, 1) of length 1 + 2.4e-07, "), std::string::npos);
}

}  // namespace sentences_test
}  // namespace crescent::check
