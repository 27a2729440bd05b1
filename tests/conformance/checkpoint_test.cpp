// The checkpoint of a stopped run is used only by the same work: another scene, ladder, seed or content is other work.
#include "run/checkpoint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "render/film.h"
#include "run/plan.h"

namespace crescent {
namespace {

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
        m.y_mean = 0.25;
        return m;
    }
    /// Writes what a run of `e` keeps: the metrics of its first pass and one tile of its second.
    void keep(const Experiment& e) const {
        Checkpoint kept(e, "CPU", out_, 0, monitor_);
        const Job first = job(e), second = job(e, 1);
        std::vector<RunMetrics> metrics;
        for (const std::uint64_t n : first.n) metrics.push_back(metric(e, first, n));
        kept.add(metrics);
        TileCheckpoint tiles = kept.tiles(second);
        std::vector<Film> films(second.n.size(), Film(4, 4, 4));
        for (Film& film : films) film.y.assign(16, 0.5f);
        tiles.begin({{0, 0, 2, 4}, {2, 0, 4, 4}}, outputs_of(films));
        tiles.add(1, 8);
    }
    /// Returns how many metrics and tiles a run of `e` finds.
    std::pair<std::size_t, int> found(const Experiment& e) const {
        Checkpoint kept(e, "CPU", out_, 0, monitor_);
        const Job second = job(e, 1);
        TileCheckpoint tiles = kept.tiles(second);
        std::vector<Film> films(second.n.size(), Film(4, 4, 4));
        tiles.begin({{0, 0, 2, 4}, {2, 0, 4, 4}}, outputs_of(films));
        if (tiles.holds(1)) {
            EXPECT_EQ(films[0].y[2], 0.5f);
            EXPECT_EQ(films[0].y[0], 0) << "the other tile was not finished";
        }
        return {kept.metrics(job(e)).size(), tiles.holds(0) + tiles.holds(1)};
    }
};

TEST_F(Keeping, GivesTheSameWorkBackWhatItFinished) {
    keep(experiment_);
    EXPECT_EQ(found(experiment_), (std::pair<std::size_t, int>(2, 1)));
}

TEST_F(Keeping, GivesOtherWorkNothing) {
    keep(experiment_);
    const std::pair<std::size_t, int> nothing(0, 0);
    Experiment other = experiment_;
    other.disks[0].radiance[0] *= 10;
    EXPECT_EQ(found(other), nothing) << "a brighter lamp, changed in code";
    other = experiment_;
    other.arms[1].n = {8, 16};
    EXPECT_EQ(found(other), nothing) << "another ladder with as many rungs";
    other = experiment_;
    other.seed = 8;
    EXPECT_EQ(found(other), nothing) << "another seed";
    Checkpoint by_another(experiment_, "GL", out_, 0, monitor_);
    EXPECT_TRUE(by_another.metrics(job(experiment_)).empty()) << "another instrument";
}

TEST_F(Keeping, TwoLaddersOfOneArmAreTwoPasses) {
    Checkpoint kept(experiment_, "CPU", out_, 0, monitor_);
    Job other = job(experiment_, 1);
    other.n = {2, 16};
    keep(experiment_);
    TileCheckpoint tiles = kept.tiles(other);
    std::vector<Film> films(2, Film(4, 4, 4));
    tiles.begin({{0, 0, 2, 4}, {2, 0, 4, 4}}, outputs_of(films));
    EXPECT_FALSE(tiles.holds(1));
}

TEST_F(Keeping, ASecondCopyOfTheRecordsIsNotTakenForMore) {
    keep(experiment_);
    for (const auto& entry : fs::recursive_directory_iterator(out_)) {
        if (entry.path().filename() != "meters") continue;
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        std::ofstream(entry.path(), std::ios::binary | std::ios::app) << bytes;
    }
    EXPECT_EQ(found(experiment_).first, 2u);
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
    EXPECT_EQ(found(experiment_), (std::pair<std::size_t, int>(2, 1)));
    EXPECT_EQ(found(other).first, 0u);
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

}  // namespace
}  // namespace crescent
