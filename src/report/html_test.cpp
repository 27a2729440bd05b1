// The page: well-formed for any input, without sections that lack data, and with sentences that follow the numbers.
#include <limits>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "output/charts.h"
#include "report/findings.h"
#include "tests/support/sample_report.h"
#include "tests/support/wellformed.h"

namespace crescent::testing {
namespace html_test {

using ::testing::HasSubstr;
using ::testing::Not;

bool has_section(const std::string& html, const std::string& id) {
    return html.find("<section id=\"" + id + "\"") != std::string::npos;
}

TEST(ReportHtml, IsWellFormed) { EXPECT_EQ(xml_error(Sample().html()), ""); }

TEST(ReportHtml, EscapesEveryNameOfTheExperiment) {
    Sample s;
    const std::string bad = "<script>&\"'\x02\xff";
    s.experiment.title = s.experiment.shapes[0].name = s.experiment.disks[0].name = s.experiment.plates[0].caption =
        bad;
    s.experiment.arms[0].name = s.experiment.regions[0].name = s.experiment.exponent->shape = bad;
    s.metrics.assertions[0].name = s.metrics.assertions[0].text = s.provenance.command = s.provenance.experiment_file =
        bad;
    s.metrics.furnaces[0].name = s.metrics.references[0].region = s.evidence.furnace[0].arithmetic = bad;
    for (RunMetrics& run : s.metrics.runs) {
        run.key.arm = run.key.arm == "cosine" ? bad : run.key.arm;
        run.regions[0].region = bad;
    }
    for (SeedSpread& b : s.metrics.bands) {
        b.key.arm = b.key.arm == "cosine" ? bad : b.key.arm;
        b.metric = b.metric == "rmse.H" ? "rmse." + bad : b.metric;
    }
    for (Ladder& l : s.metrics.ladders) l.arm = l.region = bad;
    EXPECT_EQ(xml_error(s.html()), "");
    EXPECT_THAT(s.html(), Not(HasSubstr("<script")));
}

TEST(ReportHtml, LoadsNothingFromElsewhere) {
    const std::string html = Sample().html();
    EXPECT_THAT(html, Not(HasSubstr("http")));
    EXPECT_THAT(html, Not(HasSubstr("url(")));
    EXPECT_THAT(html, HasSubstr("src=\"data:image/png;base64,AQIDBA==\""));
}

TEST(ReportHtml, SectionsStandWhereTheirDataIs) {
    const std::string html = Sample().html();
    for (const char* id :
        {"question", "estimator", "scene", "densities", "results", "failure-a", "failure-b", "ladders", "exponent",
            "furnaces", "published", "reference", "wrong", "disagreements", "limits", "assertions", "provenance"})
        EXPECT_TRUE(has_section(html, id)) << id;
}

// The list of contents and the sections are written separately in the templates.
TEST(ReportHtml, ContentsNameEverySectionInOrder) {
    const std::string html = Sample().html();
    const std::regex heading("<span class=\"number\">(\\d+)</span><a href=\"#([a-z-]+)\">(.*?)</a></h2>");
    std::size_t at = html.find("<ol>"), number = 0;
    for (std::sregex_iterator i(html.begin(), html.end(), heading), end; i != end; ++i) {
        EXPECT_EQ((*i)[1], std::to_string(++number));
        EXPECT_TRUE(has_section(html, (*i)[2]));
        at = html.find("<li><a href=\"#" + (*i)[2].str() + "\">" + (*i)[3].str() + "</a></li>", at);
        ASSERT_NE(at, std::string::npos) << (*i)[2];
    }
    EXPECT_GE(number, 17u);
}

TEST(ReportHtml, SectionsVanishWithoutTheirData) {
    Sample s;
    s.experiment.exponent.reset();
    s.experiment.regions.clear();
    s.experiment.arms[0].sampler = "uniform";
    s.metrics.ladders.clear();
    s.metrics.furnaces.clear();
    s.metrics.references.clear();
    s.metrics.assertions.clear();
    s.evidence = {};
    for (SeedSpread& b : s.metrics.bands) b.published.reset();
    for (RunMetrics& r : s.metrics.runs) r.regions.clear();
    const std::string html = s.html();
    EXPECT_EQ(xml_error(html), "");
    for (const char* id : {"failure-a", "failure-b", "ladders", "exponent", "furnaces", "reference", "wrong",
             "disagreements", "assertions"}) {
        EXPECT_FALSE(has_section(html, id)) << id;
        EXPECT_THAT(html, Not(HasSubstr("href=\"#" + std::string(id) + "\""))) << id;
    }
    EXPECT_THAT(html, Not(HasSubstr("ublished value")));
    EXPECT_TRUE(has_section(html, "results"));
}

TEST(ReportHtml, StandsWithAnEmptyRun) {
    Sample s;
    s.metrics = {};
    s.evidence = {};
    s.experiment = {};
    s.plates.clear();
    EXPECT_EQ(xml_error(s.html()), "");
}

TEST(ReportHtml, EachPointOfTheNoteNeedsItsMeasurement) {
    Sample s;
    s.evidence.lost.clear();
    const std::string html = s.html();
    EXPECT_THAT(html, HasSubstr("id=\"wrong-furnace\""));
    EXPECT_THAT(html, Not(HasSubstr("id=\"wrong-support\"")));
}

TEST(ReportHtml, TheFurnaceSentenceFollowsTheArithmetic) {
    Sample s;
    EXPECT_THAT(s.html(), HasSubstr("precision is not the cause"));
    s.evidence.furnace[1].median = 0.299;
    EXPECT_THAT(s.html(), HasSubstr("precision does explain the undershoot"));
}

TEST(ReportHtml, SentencesTurnRoundWithTheOrder) {
    Sample s;
    EXPECT_THAT(s.html(), HasSubstr("cosine’s RMSE<sub>H</sub> is <b>3.0 times</b> phong’s"));
    EXPECT_THAT(s.html(), HasSubstr("The order is the same in 3 of 3 seeds"));
    s.region("cosine", "H", 7).rmse = 1;
    EXPECT_THAT(s.html(), HasSubstr("phong’s RMSE<sub>H</sub> is <b>2.0 times</b> cosine’s"));
    EXPECT_THAT(s.html(), HasSubstr("The order is the same in 1 of 3 seeds"));
    EXPECT_THAT(s.html(), HasSubstr("In this run the failure does not show"));
    EXPECT_FALSE(has_section(s.html(), "failure-a")) << "a heading claims what was not measured";
}

TEST(ReportHtml, StatesTwoTechniquesAndUnreachableLight) {
    Sample s;
    EXPECT_THAT(s.html(), Not(HasSubstr("counts pairs")));
    EXPECT_THAT(s.html(), Not(HasSubstr("is biased in this scene")));
    s.experiment.arms.push_back({"both", "mis-balance", {64}, {}});
    s.experiment.arms.push_back({"lamp", "light-area", {64}, {}});
    EXPECT_THAT(s.html(), HasSubstr("<b>both</b> joins two techniques: its <i>N</i> counts pairs"));
    EXPECT_THAT(s.html(), Not(HasSubstr("is biased in this scene"))) << "no fill: it reaches all light";
    s.experiment.fill = {1, 1, 1};
    EXPECT_THAT(s.html(), HasSubstr("<b>lamp</b> is biased in this scene: it cannot reach the fill"));
    EXPECT_EQ(xml_error(s.html()), "");
}

TEST(ReportHtml, NamesTheExponentWhereItSaysSomething) {
    Sample s;
    EXPECT_THAT(s.html(), HasSubstr("phong, <i>N</i> = 64, <i>s</i> = 32"));
    EXPECT_THAT(s.html(), Not(HasSubstr("cosine, <i>N</i> = 64, <i>s</i>")));
}

TEST(ReportHtml, WarnsOfASurfaceThatCreatesEnergy) {
    Sample s;
    EXPECT_THAT(s.html(), Not(HasSubstr("reflects more than it receives")));
    s.experiment.shapes[0].material.rho_d = {0.2, 0.95, 0.2};
    EXPECT_THAT(s.html(), HasSubstr("ball: rho_d + rho_s is 1.05, above 1"));
    EXPECT_THAT(terminal_summary(s.inputs(), s.timing, "out"), HasSubstr("warning: ball: rho_d + rho_s is 1.05"));
}

TEST(ReportHtml, WarnsOfEvidenceThatCannotBeMeasured) {
    Sample s;
    const auto warned = [&](const char* of) {
        const std::string text = terminal_summary(s.inputs(), s.timing, "out");
        EXPECT_THAT(text, HasSubstr(std::string("warning: note_evidence measures nothing: ") + of));
        return text;
    };
    s.experiment.note_evidence = true;
    EXPECT_THAT(s.html(), Not(HasSubstr("note_evidence measures nothing")));
    s.experiment.shapes[0].material.brdf = lobe_named("ggx");
    warned("exponent.shape has no Phong lobe");
    s.experiment.exponent.reset();
    warned("no shape has a Phong lobe");
    s.experiment.arms[1].sampler = "ggx-d";
    warned("no arm has the sampler 'phong'");
    s.experiment.note_evidence = false;
    EXPECT_THAT(s.html(), Not(HasSubstr("note_evidence measures nothing")));
}

TEST(ReportHtml, MissesALightWhicheverTableNamesIt) {
    Sample s;
    s.experiment.disks.clear();
    EXPECT_FALSE(has_section(s.html(), "failure-a")) << "no light to miss";
    s.experiment.lights = {{"lamp", lights::Sphere{{0, 3, 0}, 0.25}, {5, 5, 5}, {}}};
    EXPECT_TRUE(has_section(s.html(), "failure-a"));
    EXPECT_EQ(xml_error(s.html()), "");
}

TEST(ReportHtml, ShowsTheValueOfEveryLobeInTheScene) {
    Sample s;
    EXPECT_THAT(s.html(), Not(HasSubstr("<th>GGX")));
    Shape other = s.experiment.shapes[0];
    other.name = "metal";
    other.material.brdf = lobe_named("ggx");
    other.material.alpha = 0.2;
    s.experiment.shapes.push_back(other);
    const std::string html = s.html();
    const std::size_t lobes = html.find("Lobes of this scene");
    ASSERT_NE(lobes, std::string::npos);
    for (const char* label : {"Phong", "GGX"}) EXPECT_NE(html.find(label, lobes), std::string::npos) << label;
}

// A name in a template that the model lacks is an error only where it is rendered.
TEST(ReportHtml, HasTheValuesOfSectionsThatAreRare) {
    Sample s;
    s.experiment.sky = SkyLight{.file = "<sky>.exr", .layer = "<layer>", .rotation = 30, .scale = 2};
    MeshObject mesh;
    mesh.name = "<mesh>";
    mesh.file = "<file>.mesh";
    mesh.rho_d_texture.file = "<rho>.exr";
    mesh.emission = {1, 2, 3};
    mesh.material = s.experiment.shapes[0].material;
    s.experiment.meshes = {mesh};
    s.experiment.overrides = {"a=<1>", "b=2"};
    s.provenance.backend_details = {{"<driver>", "<message>"}};
    s.provenance.places = {1};
    s.provenance.series = 3;
    RegionMetrics& paired = s.metrics.runs[0].regions[0];
    paired.mse = -1;
    paired.mse_error = 0.5;
    s.metrics.references[0].error_share = 1;
    s.metrics.references[0].max_relative_rmse_change = 0.25;
    for (const ReferenceKind kind : {ReferenceKind::quadrature, ReferenceKind::paired}) {
        s.experiment.reference.kind = kind;
        const std::string html = s.html();
        EXPECT_EQ(xml_error(html), "");
        for (const char* text :
            {"the image <code>&lt;sky&gt;.exr</code>, layer <code>&lt;layer&gt;</code>", "&lt;file&gt;.mesh",
                "&lt;rho&gt;.exr", "<code>a=&lt;1&gt;</code>, <code>b=2</code>", "&lt;driver&gt;", "seeds 1 of 3",
                "not good enough in region H", "Monte Carlo reference against the quadrature", "<td class=\"n\">−1"})
            EXPECT_THAT(html, HasSubstr(text));
    }
    s.metrics.references[0].max_relative_rmse_change.reset();
    EXPECT_THAT(s.html(), HasSubstr("a pair of independent estimates"));
}

TEST(ReportHtml, MarksUnfailingAndSkippedAssertions) {
    Sample s;
    s.metrics.assertions[0].cannot_fail = true;
    s.metrics.assertions[1].pass = false;
    s.metrics.assertions[1].skipped = "no plates were drawn";
    EXPECT_THAT(s.html(), HasSubstr("for any measurements"));
    EXPECT_THAT(s.html(), HasSubstr("skipped: no plates were drawn"));
    EXPECT_TRUE(s.metrics.all_hold());
}

TEST(ReportHtml, OverlappingBandsAreNotRanked) {
    Sample s;
    for (SeedSpread& b : s.metrics.bands) b.band.seeds = 4;
    EXPECT_THAT(s.html(), Not(HasSubstr("so the two are not ranked")));
    s.band("phong", "rmse.H").band.q95 = 7;
    EXPECT_THAT(s.html(), HasSubstr("bands overlap, so the two are not ranked"));
}

// With six values of equal arms, three each, all values of one arm are above all of the other's in one run of ten.
TEST(ReportHtml, ArmsOfThreeSeedsAreNotRanked) {
    EXPECT_THAT(Sample().html(), HasSubstr("With 3 seeds the bands of equal arms are disjoint in 10 % of all runs"));
    EXPECT_DOUBLE_EQ(chance_of_parted_bands(3), 0.1);
    EXPECT_DOUBLE_EQ(chance_of_parted_bands(1), 1);
}

TEST(ReportHtml, HeavyTailReplacesTheInterval) {
    Sample s;
    s.band("phong", "rmse.H").band = {1.8888, 2, 2.2222, 3, true};
    const std::string html = s.html();
    EXPECT_THAT(html, Not(HasSubstr("1.889")));
    EXPECT_THAT(html, Not(HasSubstr("2.222")));
    EXPECT_THAT(html, HasSubstr("<span class=\"heavy\">heavy tail</span>"));
    EXPECT_THAT(html, HasSubstr("inconclusive: heavy tail"));
}

TEST(ReportHtml, NumbersThatAreNoneDoNotBreakThePage) {
    Sample s;
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (RunMetrics& run : s.metrics.runs) {
        run.regions[0].rmse = nan;
        run.regions[1].rmse = inf;
        run.bad = 5;
    }
    for (SeedSpread& b : s.metrics.bands) {
        b.measured = nan;
        b.band.median = inf;
    }
    for (Ladder& l : s.metrics.ladders) {
        l.rmse = {nan, 0};
        l.slope = nan;
    }
    const std::string html = s.html();
    EXPECT_EQ(xml_error(html), "");
    EXPECT_THAT(html, HasSubstr("30 samples"));
    EXPECT_THAT(html, Not(HasSubstr("d=\"Mnan")));
}

TEST(ReportHtml, LinksTheLargestPlatesToStaySmall) {
    Sample s;
    s.plates["hero"] = std::vector<unsigned char>(12'000'000);
    s.plates["small"] = {1, 2, 3};
    const std::string html = s.html();
    EXPECT_LT(html.size(), 15'000'000u);
    EXPECT_THAT(html, HasSubstr("src=\"plates/hero.png\""));
    EXPECT_THAT(html, HasSubstr("base64,AQID\""));
}

TEST(ReportHtml, SaysOfEveryFigureWhichCommandMakesIt) {
    EXPECT_THAT(
        Sample().html(), HasSubstr("<code>crescent run a.toml --seeds 3</code> → <code>plates/hero.png</code>"));
}

TEST(Charts, AxesHoldTheirValuesAndTicksLieOnThem) {
    for (const Axis& axis : {linear_axis("x", {0.013, 0.97}), linear_axis("x", {5, 5}), linear_axis("x", {-3, 4}),
             log_axis("x", {4, 256}), log_axis("x", {1e-6, 1e6}), log_axis("x", {2, 2}), log_axis("x", {7}),
             log_axis("x", {5.2, 9}), log_axis("x", {-1, 0}), linear_axis("x", {})}) {
        ASSERT_LT(axis.low, axis.high);
        ASSERT_FALSE(axis.ticks.empty());
        for (const double tick : axis.ticks) {
            EXPECT_GE(axis.share(tick), -1e-9);
            EXPECT_LE(axis.share(tick), 1 + 1e-9);
        }
    }
    const Axis axis = log_axis("x", {4, 256});
    EXPECT_GE(axis.share(4), 0);
    EXPECT_LE(axis.share(256), 1);
    EXPECT_NEAR(axis.share(32) - axis.share(16), axis.share(8) - axis.share(4), 1e-12);
}

TEST(Charts, PointsThatALogAxisCannotShowAreLeftOut) {
    Chart chart(300, 200, log_axis("x", {1, 10}), log_axis("y", {1, 10}), "t");
    chart.dots({{1, 0}, {2, -1}, {3, 4}}, "c0");
    const std::string svg = chart.str();
    EXPECT_EQ(svg.find("<circle"), svg.rfind("<circle"));
    EXPECT_EQ(xml_error(svg), "");
}

}  // namespace html_test
}  // namespace crescent::testing
