// Parts of one experiment joined: the numbers of the whole; parts that do not belong together are refused.
#include "run/join.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/write.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_run.h"

namespace crescent {
namespace join_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Joined : public ScratchFolder {
protected:
    /// Writes the metrics of a part and returns its folder.
    std::string part(const std::string& name, const Experiment& e, SeedRange range) const {
        ProgressMonitor monitor;
        write_metrics(test::measured(e, range), path(name), monitor);
        return path(name);
    }
    std::string mistake(const std::vector<std::string>& parts) const {
        return refusal([&] { return join(parts, "join"); });
    }
    const Experiment experiment = test::small_experiment();
};

TEST_F(Joined, PartsHaveTheNumbersOfOneRun) {
    const std::string first = part("first", experiment, {1, 1}), rest = part("rest", experiment, {2, 3});
    const Measured whole = test::measured(experiment), joined = join({rest, first, path("rest/metrics.json")}, "test");
    EXPECT_THAT(joined.provenance.places, ElementsAre(1, 2, 3));
    EXPECT_EQ(joined.metrics.series, whole.metrics.series);
    EXPECT_EQ(metrics_csv(report_inputs(joined)), metrics_csv(report_inputs(whole)));
    ASSERT_EQ(joined.metrics.bands.size(), whole.metrics.bands.size());
    for (std::size_t k = 0; k < whole.metrics.bands.size(); ++k)
        EXPECT_EQ(joined.metrics.bands[k].band.median, whole.metrics.bands[k].band.median);
    EXPECT_EQ(joined.metrics.film_hashes, whole.metrics.film_hashes);
    EXPECT_TRUE(joined.films.empty());
}

TEST_F(Joined, NothingIsRefused) { EXPECT_THAT(mistake({}), HasSubstr("one or more runs, found none")); }

TEST_F(Joined, MissingSeedsAreKnown) {
    const Measured joined = join({part("last", experiment, {3, 3})}, "join");
    EXPECT_THAT(joined.provenance.places, ElementsAre(3));
    EXPECT_THAT(joined.provenance.missing(), ElementsAre(1, 2));
    EXPECT_EQ(joined.metrics.runs.size(), 5u);
    EXPECT_EQ(joined.metrics.series.size(), 3u);
}

TEST_F(Joined, AnotherExperimentIsRefusedWithItsDifference) {
    const std::string first = part("first", experiment, {1, 1}),
                      other = part("other", test::small_experiment({"shapes.ball.s=25"}), {2, 2});
    EXPECT_THAT(mistake({first, other}), HasSubstr("s is 24 there and 25 here"));
    EXPECT_THAT(mistake({first, path("nothing")}), HasSubstr("nothing: "));
}

TEST_F(Joined, PartsThatContradictEachOtherAreRefused) {
    const std::string first = part("first", experiment, {1, 1}), again = part("again", experiment, {1, 2});
    EXPECT_EQ(mistake({first, again}), "");
    const nlohmann::ordered_json right = nlohmann::ordered_json::parse(bytes_of(path("again/metrics.json")));
    const auto mistake_with = [&](const char* pointer, const nlohmann::ordered_json& value) {
        nlohmann::ordered_json changed = right;
        changed[nlohmann::ordered_json::json_pointer(pointer)] = value;
        write("again/metrics.json", changed.dump());
        return mistake({first, again});
    };
    EXPECT_THAT(mistake_with("/runs/1/regions/all/rmse", 0.125), HasSubstr("at seed 11 differs"));
    EXPECT_THAT(mistake_with("/geometry_pixels", 7), HasSubstr("'geometry_pixels' differs"));
    EXPECT_THAT(mistake_with("/films/quadrature s=24", "0123"), HasSubstr("the hash of a reference differs"));
}

}  // namespace join_test
}  // namespace crescent
