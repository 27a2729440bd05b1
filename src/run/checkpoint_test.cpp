// The checkpoint of a stopped run is used only by the same work: another scene, ladder, seed or content is other work.
#include "run/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <set>

#include "run/plan.h"

namespace crescent {
namespace checkpoint_test {

namespace fs = std::filesystem;

struct Listener : ProgressMonitor {
    std::string message;
    void log(std::string_view line) override { message += std::string(line) + "\n"; }
};

class Keeping : public testing::Test {
protected:
    std::string out_ = fs::path(testing::TempDir()) / ("kept-" + std::to_string(getpid()));
    Experiment experiment_ = load(std::string(CRESCENT_SOURCE_DIR) + "/tests/system/tiny.toml");
    mutable Listener monitor_;
    void SetUp() override { fs::remove_all(out_); }
    void TearDown() override { fs::remove_all(out_); }

    Job job(const Experiment& e, std::size_t k = 0) const { return jobs_of(e, e.seed)[k]; }
    static RunMetrics metric(const Experiment& e, const Job& job, std::uint64_t n) {
        RunMetrics m;
        m.key = {job.arm, n, job.s, job.seed};
        m.regions.resize(e.regions.size());
        for (std::size_t r = 0; r < e.regions.size(); ++r) m.regions[r].region = e.regions[r].name;
        m.y_mean = 0.1;
        return m;
    }
    /// Writes what a run of `e` keeps: the metrics of its first two passes.
    void keep(const Experiment& e) const {
        Checkpoint kept(e, "CPU", out_, 0, monitor_);
        for (const std::size_t k : {0, 1}) {
            std::vector<RunMetrics> metrics;
            for (const std::uint64_t n : job(e, k).n) metrics.push_back(metric(e, job(e, k), n));
            kept.add(metrics);
        }
    }
    /// Returns how many metrics a run of `e` finds of its first two passes.
    std::array<std::size_t, 2> found(const Experiment& e) const {
        Checkpoint kept(e, "CPU", out_, 0, monitor_);
        for (const RunMetrics& m : kept.metrics(job(e))) EXPECT_EQ(m.y_mean, 0.1);
        return {kept.metrics(job(e)).size(), kept.metrics(job(e, 1)).size()};
    }
    fs::path file() const {
        for (const auto& entry : fs::recursive_directory_iterator(out_))
            if (entry.is_regular_file()) return entry.path();
        return {};
    }
};

constexpr std::array<std::size_t, 2> all{2, 2}, first{2, 0}, nothing{0, 0};

TEST_F(Keeping, GivesTheSameWorkBackWhatItFinished) {
    keep(experiment_);
    EXPECT_EQ(found(experiment_), all);
}

TEST_F(Keeping, GivesOtherWorkNothing) {
    keep(experiment_);
    Experiment other = experiment_;
    other.disks[0].radiance[0] *= 10;
    EXPECT_EQ(found(other), nothing) << "a brighter lamp, changed in code";
    other = experiment_;
    other.arms[1].n = {8, 16};
    EXPECT_EQ(found(other), nothing) << "another ladder of equal length";
    other = experiment_;
    other.seed = 8;
    EXPECT_EQ(found(other), nothing) << "another seed";
    Checkpoint by_another(experiment_, "GL", out_, 0, monitor_);
    EXPECT_TRUE(by_another.metrics(job(experiment_)).empty()) << "another instrument";
}

TEST_F(Keeping, AnItemThatIsCutOffIsNotUsedAndNotInTheWayOfOthers) {
    keep(experiment_);
    fs::resize_file(file(), fs::file_size(file()) - 1);
    EXPECT_EQ(found(experiment_), first);
    keep(experiment_);
    EXPECT_EQ(found(experiment_), all);
    fs::resize_file(file(), 3);
    EXPECT_EQ(found(experiment_), nothing);
    keep(experiment_);
    EXPECT_EQ(found(experiment_), all);
}

TEST_F(Keeping, OtherItemsAreNotUsed) {
    keep(experiment_);
    std::ofstream(file(), std::ios::binary | std::ios::app) << '\0' << "\x82\xf6\xf6";  // 0; [null, null]
    EXPECT_EQ(found(experiment_), all);
    EXPECT_EQ(found(experiment_), all);
}

TEST_F(Keeping, AnyChangedBitIsFound) {
    keep(experiment_);
    std::ifstream in(file(), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    for (std::size_t byte = 0; byte < whole.size(); byte += 7) {
        std::string damaged = whole;
        damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << byte % 8));
        std::ofstream(file(), std::ios::binary | std::ios::trunc) << damaged;
        const auto metrics = found(experiment_);  // compares their numbers
        EXPECT_NE(metrics, all) << "byte " << byte;
        EXPECT_NE(monitor_.message.find("incomplete or damaged"), std::string::npos);
        keep(experiment_);  // the file is there again if its key was damaged
    }
}

TEST_F(Keeping, NestedDataAndEndlessLengthsAreNotUsed) {
    keep(experiment_);
    std::ofstream(file(), std::ios::binary | std::ios::app) << std::string(2'000'000, '\x81');
    EXPECT_EQ(found(experiment_), all);
    std::ofstream(file(), std::ios::binary | std::ios::app) << std::string(64, '\xff');
    EXPECT_EQ(found(experiment_), all);
}

TEST_F(Keeping, APipeInItsPlaceStopsNothing) {
    keep(experiment_);
    const std::string path = file();
    fs::remove(path);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    EXPECT_EQ(found(experiment_), nothing);
    keep(experiment_);
}

TEST_F(Keeping, ForgetsItsOwnAndTellsOfOthers) {
    keep(experiment_);
    Experiment other = experiment_;
    other.seed = 8;
    keep(other);
    {
        Checkpoint kept(other, "CPU", out_, 0, monitor_);
        kept.discard();
    }
    EXPECT_NE(monitor_.message.find("another, unfinished run"), std::string::npos) << monitor_.message;
    EXPECT_EQ(found(experiment_), all);
    EXPECT_EQ(found(other), nothing);
    Checkpoint kept(experiment_, "CPU", out_, 0, monitor_);
    kept.discard();
    EXPECT_FALSE(fs::exists(out_ + "/.crescent-kept"));
}

TEST_F(Keeping, IsNotLedElsewhereByALink) {
    fs::create_directories(out_ + "/elsewhere");
    fs::create_directory_symlink("elsewhere", out_ + "/.crescent-kept");
    EXPECT_THROW(Checkpoint(experiment_, "CPU", out_, 0, monitor_), OutputError);
}

TEST(SeedSeries, HaveNoSeedTwice) {
    Experiment e = load(std::string(CRESCENT_SOURCE_DIR) + "/tests/system/tiny.toml", {"seed=79885786", "seeds=16"});
    const std::vector<std::uint32_t> series = seeds_of(e);
    EXPECT_EQ(series.size(), 16u);
    EXPECT_EQ(series.front(), 79885786u);
    EXPECT_EQ(std::set<std::uint32_t>(series.begin(), series.end()).size(), 16u);
}

}  // namespace checkpoint_test
}  // namespace crescent
