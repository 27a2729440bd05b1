// Which files a run writes, and that they appear all at once.
#include "run/write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/scratch_folder.h"
#include "tests/support/small_run.h"

namespace crescent {
namespace write_test {

using ::testing::Contains;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;
namespace fs = std::filesystem;

class Written : public ScratchFolder {
protected:
    std::vector<std::string> files() const {
        std::vector<std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(path("out")))
            if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.'))
                out.push_back(fs::relative(entry.path(), path("out")));
        return out;
    }
};

TEST_F(Written, TheFilesArePlannedAndWritten) {
    ProgressMonitor monitor;
    const Experiment e = test::small_experiment({"seeds=1"});
    Measured m = test::measured(e);
    const OutputParts numbers{.metrics = true, .films = true, .plates = false, .report = false};
    EXPECT_TRUE(crescent::write(m, path("out"), monitor, numbers));
    EXPECT_THAT(files(), testing::UnorderedElementsAreArray(outputs_of(plan(e), numbers)));
    EXPECT_THAT(files(),
        UnorderedElementsAre("timing.json", "metrics.json", "metrics.csv", "junit.xml", "films/uniform.exr",
            "films/cosine.exr", "films/phong.exr", "films/reference.exr"));
    EXPECT_TRUE(
        crescent::write(m, path("out"), monitor, {.metrics = true, .films = false, .plates = false, .report = false}));
    EXPECT_THAT(files(), UnorderedElementsAre("timing.json", "metrics.json", "metrics.csv", "junit.xml"));
    EXPECT_EQ(read_metrics(bytes_of(path("out/metrics.json")), "it").metrics.runs.size(), m.metrics.runs.size());
}

TEST_F(Written, AStopLeavesTheFormerOutputs) {
    ProgressMonitor monitor;
    Measured m = test::measured(test::small_experiment({"seeds=1"}));
    const OutputParts metrics{.metrics = true, .films = false, .plates = false, .report = false};
    EXPECT_TRUE(crescent::write(m, path("out"), monitor, metrics));
    const std::string before = bytes_of(path("out/timing.json"));
    monitor.stop = true;
    EXPECT_FALSE(crescent::write(m, path("out"), monitor, metrics));
    EXPECT_EQ(bytes_of(path("out/timing.json")), before);
    EXPECT_EQ(files().size(), 4u);
}

TEST_F(Written, HeadersNameSeedAndExperiment) {
    Measured m;
    m.experiment.seed = 11;
    m.provenance.experiment_file = "e.toml";
    m.provenance.experiment_hash = "0123";
    EXPECT_THAT(attributes_of(m), Contains(Pair("seed", "11")));
    EXPECT_THAT(attributes_of(m), Contains(Pair("experiment", "e.toml 0123")));
}

TEST(OutputWords, SelectParts) {
    const OutputParts all = output_parts("report,films,metrics,plates"), one = output_parts("films");
    EXPECT_TRUE(all.metrics && all.films && all.plates && all.report);
    EXPECT_TRUE(one.films);
    EXPECT_FALSE(one.metrics || one.plates || one.report);
    EXPECT_EQ(outputs_of(plan(test::small_experiment()), {false, false, false, false}),
        (std::vector<std::string>{"timing.json"}));
}

}  // namespace write_test
}  // namespace crescent
