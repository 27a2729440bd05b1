// The contents of metrics.json, metrics.csv, junit.xml and timing.json, including unusual numbers and names.
#include <cstdlib>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "experiment/identity.h"
#include "output/format.h"
#include "tests/support/sample_report.h"
#include "tests/support/scene_text.h"
#include "tests/support/wellformed.h"

namespace crescent::testing {
namespace metrics_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

nlohmann::json parsed(const Sample& s) { return nlohmann::json::parse(metrics_json(s.inputs())); }

/// Kept for tests/system/schema.sh, which checks them against docs/metrics.schema.json: valid files, and invalid ones.
void keep(const std::string& name, const nlohmann::json& json, bool fits) {
    if (const char* folder = std::getenv("CRESCENT_METRICS_SAMPLES"))
        std::ofstream(std::string(folder) + (fits ? "/fits-" : "/breaks-") + name + ".json") << json;
}

TEST(MetricsJson, ReadsBackEveryNumberExactly) {
    Sample s;
    s.region("phong", "H", 7).rmse = 0.1 + 0.2;
    s.metrics.runs[0].y_mean = 5e-324;
    const auto json = parsed(s);
    EXPECT_EQ(json["runs"][3]["regions"]["H"]["rmse"].get<double>(), 0.1 + 0.2);
    EXPECT_EQ(json["runs"][0]["y_mean"].get<double>(), 5e-324);
    EXPECT_EQ(json["runs"][3]["arm"], "phong");
    EXPECT_EQ(json["runs"][3]["n"], 64);
    EXPECT_EQ(json["films"]["phong n=64 s=32"], "0123456789abcdef");
    EXPECT_EQ(json["provenance"]["command"], "crescent run a.toml --seeds 3");
}

TEST(MetricsJson, IsReadBackToTheSameBytes) {
    Sample s;
    s.experiment = parse("seeds = 3\nseed = 7\n" + test::room_text, "a.toml", {"ball.radius=0.9"});
    s.experiment.figures.emplace();
    s.experiment.figures->source = "elsewhere";
    s.experiment.figures->seed = 7;
    s.experiment.figures->runs[{"cosine", 4, 1, "rmse.H"}] = 0.1 + 0.2;
    s.provenance.experiment_text = canonical_text(s.experiment);
    s.provenance.experiment_hash = fmt::format("{:016x}", hash(s.experiment));
    s.provenance.places = {1, 2, 3};
    s.provenance.series = 3;
    s.metrics.runs[0].largest = inf;
    s.metrics.runs[0].y_mean = 5e-324;
    s.metrics.runs[1].bad = ~std::uint64_t{0};
    s.region("cosine", "H", 7).rmse = nan;
    s.region("cosine", "H", 7).var = -0.0;
    const std::string text = metrics_json(s.inputs());
    MetricsFile read = read_metrics(text, "part/metrics.json");
    read.metrics.bands = s.metrics.bands;
    read.metrics.ladders = s.metrics.ladders;
    EXPECT_EQ(metrics_json({read.experiment, read.metrics, read.evidence, read.provenance, s.plates}), text);
    keep("with-its-experiment", nlohmann::json::parse(text), true);

    auto changed = nlohmann::json::parse(text);
    changed["provenance"]["experiment"]["text"] = s.provenance.experiment_text + "[arms.phong]\nn = 4\n";
    EXPECT_THROW((void)read_metrics(changed.dump(), "a"), InputError) << "another text than its hash says";
    for (const char* part : {"runs", "evidence", "provenance", "films"}) {
        auto lacking = nlohmann::json::parse(text);
        lacking.erase(part);
        EXPECT_THROW((void)read_metrics(lacking.dump(), "a"), InputError) << part;
    }
    EXPECT_THROW((void)read_metrics("{\"format\": \"another\"}", "a"), InputError);
    EXPECT_THROW((void)read_metrics("title = 'TOML'", "a"), InputError);
}

TEST(MetricsJson, HasNullForAnRmseBelowAPairedReference) {
    Sample s;
    s.experiment.reference.kind = ReferenceKind::paired;
    for (RunMetrics& run : s.metrics.runs)
        for (RegionMetrics& region : run.regions) {
            region.mse = 0.25;
            region.rmse = 0.5;
            region.mse_error = 0.125;
            region.reference_error = 0.1;
        }
    RegionMetrics& below = s.region("cosine", "H", 7);
    below.mse = -0.01;
    below.rmse = nan;
    s.metrics.references.clear();
    ReferenceQuality& quality = s.metrics.references.emplace_back();
    quality.s = 32;
    quality.region = "H";
    quality.paired_error = 0.1;
    quality.error_share = inf;
    const auto json = parsed(s);
    const auto run = json["runs"][0]["regions"]["H"];
    EXPECT_TRUE(run["rmse"].is_null());
    EXPECT_EQ(run["mse"], -0.01);
    EXPECT_NEAR(run["mse_interval"][0].get<double>(), -0.01 - 1.96 * 0.125, 1e-12);
    EXPECT_EQ(json["references"][0]["paired_error"], 0.1);
    EXPECT_FALSE(json["references"][0].contains("quadrature_error"));
    EXPECT_NE(metrics_csv(s.inputs()).find(",mse_low,H,"), std::string::npos);
    keep("paired", json, true);
}

TEST(MetricsJson, NotANumberAndInfinityAreWordsNeverNull) {
    Sample s;
    s.metrics.runs[0].largest = inf;
    s.region("cosine", "H", 7).rmse = nan;
    s.region("cosine", "H", 7).var = -inf;
    const auto run = parsed(s)["runs"][0];
    EXPECT_EQ(run["largest"], "inf");
    EXPECT_EQ(run["regions"]["H"]["rmse"], "nan");
    EXPECT_EQ(run["regions"]["H"]["var"], "-inf");
    keep("words", parsed(s), true);
}

TEST(MetricsJson, HasEveryPartThatItsSchemaAsksFor) {
    const auto json = parsed(Sample());
    for (const char* part : {"provenance", "runs", "bands", "ladders"}) EXPECT_TRUE(json.contains(part)) << part;
    keep("plain", json, true);
}

TEST(MetricsJson, HasNoRunsWithNothingMeasured) {
    Sample s;
    s.metrics = {};
    s.evidence = {};
    s.provenance.seeds.clear();
    EXPECT_TRUE(parsed(s)["runs"].empty());
    keep("nothing-measured", parsed(s), true);
}

TEST(MetricsJson, ProvenanceHasTheBackEndDetails) {
    Sample s;
    EXPECT_FALSE(parsed(s)["provenance"].contains("instrument_details"));
    s.provenance.backend_details = {{"GL_VERSION", "4.5 (Core Profile)"}, {"context", "OSMesa"}};
    EXPECT_EQ(parsed(s)["provenance"]["instrument_details"]["GL_VERSION"], "4.5 (Core Profile)");
    keep("instrument", parsed(s), true);
    EXPECT_NE(s.html().find("OSMesa"), std::string::npos);
}

TEST(MetricsJson, LeavesSamplesThatItsSchemaRefuses) {
    auto lacking = parsed(Sample());
    EXPECT_EQ(lacking["runs"][0].erase("arm"), 1u);
    keep("lacking", lacking, false);
    auto null = parsed(Sample());
    EXPECT_FALSE(null["bands"][0]["seeds"].is_null());
    null["bands"][0]["seeds"] = nullptr;
    keep("null", null, false);
    auto unknown = parsed(Sample());
    unknown["assertions"][0]["verdict"] = true;
    keep("unknown", unknown, false);
    auto added = parsed(Sample());
    added["runs"][0]["mae"] = 0.5;
    keep("added-metric", added, true);
    added["runs"][0]["mae"] = "half";
    keep("text-for-a-metric", added, false);
}

TEST(MetricsJson, HeavyTailStandsInPlaceOfTheInterval) {
    Sample s;
    s.band("phong", "rmse.S").band.heavy = true;
    s.metrics.ladders[1].heavy = true;
    const auto json = parsed(s);
    EXPECT_TRUE(json["bands"][0]["interval"].is_array());
    EXPECT_EQ(json["bands"][4]["interval"], "heavy tail");
    EXPECT_EQ(json["ladders"][1]["interval"], "heavy tail");
    EXPECT_EQ(json["furnace"][1]["se"], "heavy tail");
    EXPECT_EQ(json["furnace"][0]["se"], 0.001);
    keep("heavy-tail", json, true);
}

TEST(TimingJson, HoldsWhatVariesAndTheRateOfEachArm) {
    const Sample s;
    const auto json = nlohmann::json::parse(timing_json(s.timing, s.provenance));
    EXPECT_EQ(json["arms"][0]["msamples_per_s"], 8.0);
    EXPECT_EQ(json["threads"], 2);
    EXPECT_EQ(json["isa"], "AVX2");
    EXPECT_EQ(json["stages"][0]["name"], "estimating");
}

TEST(MetricsCsv, QuotesNamesAsRfc4180Says) {
    Sample s;
    s.metrics.runs.resize(1);
    s.metrics.runs[0].key.arm = "a, \"b\"";
    s.metrics.runs[0].largest = nan;
    const std::string csv = metrics_csv(s.inputs());
    EXPECT_TRUE(csv.starts_with("arm,n,s,seed,metric,region,value\r\n\"a, \"\"b\"\"\",64,32,7,rmse,H,6\r\n"));
    EXPECT_NE(csv.find(",largest,,nan\r\n"), std::string::npos);
    EXPECT_NE(csv.find(",tail_k,S,0.1\r\n"), std::string::npos);
}

TEST(MetricsCsv, HasOneUniqueColumnForEachSetKey) {
    Sample s;
    s.metrics.runs.resize(1);
    s.experiment.overrides = {"seed=9", "n=64", "fill.radiance=[1, 1, 1]", "exposure=2", "seeds=3", "exposure=4"};
    const std::string csv = metrics_csv(s.inputs());
    EXPECT_TRUE(csv.starts_with("arm,n,s,seed,metric,region,value,set.seed,set.n,fill.radiance,exposure\r\n")) << csv;
    EXPECT_NE(csv.find(",rmse,H,6,9,64,\"[1, 1, 1]\",4\r\n"), std::string::npos) << csv;
}

TEST(JunitXml, IsWellFormedAndEscapedWhateverTheNames) {
    Sample s;
    s.experiment.title = "<&\"'>\x01\xff";
    s.metrics.assertions[0].name = "a < b & \"c\"";
    s.metrics.assertions[0].pass = false;
    const std::string xml = junit_xml(s.inputs());
    EXPECT_EQ(xml_error(xml), "");
    EXPECT_EQ(xml.find('\x01'), std::string::npos);
    EXPECT_NE(xml.find("name=\"a &lt; b &amp; &quot;c&quot;\""), std::string::npos);
}

TEST(JunitXml, CountsFailuresWithMeasuredAndBound) {
    Sample s;
    s.metrics.assertions[1] = {"no bad samples", false, 3, 0, "==", "bad == 0"};
    const std::string xml = junit_xml(s.inputs());
    EXPECT_NE(xml.find("tests=\"2\" failures=\"1\""), std::string::npos);
    EXPECT_NE(xml.find("measured 3, must be == 0"), std::string::npos);
}

}  // namespace metrics_test
}  // namespace crescent::testing
