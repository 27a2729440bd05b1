// metrics.json, metrics.csv, junit.xml and timing.json: what stands in them, and how they hold numbers and names that
// are not ordinary.
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "pages/json_number.h"
#include "report/sample_test.h"
#include "report/schema_check_test.h"
#include "report/wellformed_test.h"

namespace crescent::testing {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

nlohmann::json parsed(const Sample& s) { return nlohmann::json::parse(metrics_json(s.inputs())); }

SchemaCheck schema() {
    std::ifstream file(CRESCENT_SOURCE_DIR "/docs/metrics.schema.json");
    return SchemaCheck(nlohmann::json::parse(file));
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

TEST(MetricsJson, NotANumberAndInfinityAreWordsNeverNull) {
    Sample s;
    s.metrics.runs[0].largest = inf;
    s.region("cosine", "H", 7).rmse = nan;
    s.region("cosine", "H", 7).var = -inf;
    const auto run = parsed(s)["runs"][0];
    EXPECT_EQ(run["largest"], "inf");
    EXPECT_EQ(run["regions"]["H"]["rmse"], "nan");
    EXPECT_EQ(run["regions"]["H"]["var"], "-inf");
    EXPECT_EQ(schema().complaint(parsed(s)), "");
}

TEST(MetricsJson, FitsItsSchema) { EXPECT_EQ(schema().complaint(parsed(Sample())), ""); }

TEST(MetricsJson, FitsItsSchemaWithNothingMeasured) {
    Sample s;
    s.metrics = {};
    s.evidence = {};
    s.provenance.seeds.clear();
    EXPECT_EQ(schema().complaint(parsed(s)), "");
}

TEST(MetricsJson, AnInstrumentsOwnWordsStandInTheProvenanceAndTheCpuHasNone) {
    Sample s;
    EXPECT_FALSE(parsed(s)["provenance"].contains("instrument_details"));
    s.provenance.instrument_details = {{"GL_VERSION", "4.5 (Core Profile)"}, {"context", "OSMesa"}};
    EXPECT_EQ(parsed(s)["provenance"]["instrument_details"]["GL_VERSION"], "4.5 (Core Profile)");
    EXPECT_EQ(schema().complaint(parsed(s)), "");
    EXPECT_NE(s.html().find("OSMesa"), std::string::npos);
}

TEST(MetricsJson, ItsSchemaNoticesWhatIsMissingWrongOrUnknown) {
    auto lacking = parsed(Sample());
    lacking["runs"][0].erase("arm");
    EXPECT_NE(schema().complaint(lacking), "");
    auto null = parsed(Sample());
    null["bands"][0]["median"] = nullptr;
    EXPECT_NE(schema().complaint(null), "");
    auto unknown = parsed(Sample());
    unknown["assertions"][0]["verdict"] = true;
    EXPECT_NE(schema().complaint(unknown), "");
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
    EXPECT_EQ(schema().complaint(json), "");
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
    EXPECT_TRUE(csv.starts_with("arm,n,s,seed,meter,region,value\r\n\"a, \"\"b\"\"\",64,32,7,rmse,H,6\r\n"));
    EXPECT_NE(csv.find(",largest,,nan\r\n"), std::string::npos);
    EXPECT_NE(csv.find(",tail_k,S,0.1\r\n"), std::string::npos);
}

TEST(JunitXml, IsWellFormedAndEscapedWhateverTheNames) {
    Sample s;
    s.experiment.title = "<&\"'>\x01\xff";
    s.metrics.assertions[0].name = "a < b & \"c\"";
    s.metrics.assertions[0].pass = false;
    const std::string xml = junit_xml(s.inputs());
    EXPECT_EQ(xml_complaint(xml), "");
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

}  // namespace
}  // namespace crescent::testing
