// Outputs appear as one: whichever system call is the last one, all that is seen is of one run; and no file of others
// is touched.
#include "base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "base/errors.h"
#include "base/publish.h"

namespace crescent::inline base {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Files = std::map<std::string, std::string>;  // name -> content

const Files old_run = {{"metrics.json", "old"}, {"report.html", "old"}, {"plates/hero.png", "old"},
    {"plates/heat.png", "old"}, {"films/a/b.exr", "old"}};
const Files new_run = {
    {"metrics.json", "new"}, {"report.html", "new"}, {"plates/hero.png", "new"}, {"plates/rose.png", "new"}};

int steps_left = 0;
void end_at_last_step() {
    if (steps_left-- == 0) ::_exit(99);
}

class Publishing : public testing::Test {
protected:
    // In memory, where there is such a place: these tests sync some thousand times.
    fs::path top_ = fs::path(fs::is_directory("/dev/shm") ? "/dev/shm" : testing::TempDir()) /
        ("publishing-" + std::to_string(getpid()));
    fs::path out_ = top_ / "out";
    ProgressMonitor monitor_;
    void SetUp() override { fs::remove_all(top_), fs::create_directories(top_); }
    void TearDown() override { fs::remove_all(top_); }

    static void put(const fs::path& at, const std::string& text) {
        fs::create_directories(at.parent_path());
        std::ofstream(at) << text;
    }
    static std::string text_of(const fs::path& at) {
        std::ifstream file(at);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void publish(const Files& files) {
        Staging staging(out_);
        for (const auto& [name, text] : files) staging.write(name, text);
        staging.commit(monitor_);
    }
    /// What a reader finds under the names of both runs, links followed.
    Files seen() const {
        Files out;
        for (const Files& run : {old_run, new_run})
            for (const auto& [name, text] : run)
                if (fs::is_regular_file(out_ / name)) out[name] = text_of(out_ / name);
        return out;
    }
    /// Every regular file and link below OUT but for the manifest.
    std::vector<std::string> all() const {
        std::vector<std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(out_))
            if (!entry.is_directory() || entry.is_symlink())
                if (entry.path().filename() != manifest_file("outputs"))
                    out.push_back(
                        entry.path().lexically_relative(out_).string() + (entry.is_symlink() ? " (a link)" : ""));
        std::sort(out.begin(), out.end());
        return out;
    }
    /// A process that publishes and ends before its `step`-th change. True where it came to its end.
    bool publish_until(int step, const Files& files) {
        const pid_t child = fork();
        if (child == 0) {
            Staging staging(out_);
            for (const auto& [name, text] : files) staging.write(name, text);
            steps_left = step;
            before_change = end_at_last_step;
            staging.commit(monitor_);
            ::_exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }
};

std::vector<std::string> names_of(const Files& files) {
    std::vector<std::string> out;
    for (const auto& [name, text] : files) out.push_back(name);
    return out;
}

TEST_F(Publishing, StoppedBeforeAnyStepLeavesOneRunWhole) {
    int old_seen = 0, new_seen = 0;
    for (bool done = false; !done;) {
        fs::remove_all(out_);
        publish(old_run);
        done = publish_until(old_seen + new_seen, new_run);
        const Files now = seen();
        ASSERT_TRUE(now == old_run || now == new_run) << "ended before step " << old_seen + new_seen;
        ++(now == old_run ? old_seen : new_seen);
        { Staging next(out_); }  // a later run that is stopped as it begins
        EXPECT_EQ(seen(), now);
        EXPECT_EQ(all(), names_of(now)) << "nothing else is left";
        publish(old_run);
        EXPECT_EQ(all(), names_of(old_run));
    }
    EXPECT_GT(old_seen, 15);
    EXPECT_GT(new_seen, 5);
}

TEST_F(Publishing, ForTheFirstTimeShowsAllOrNothing) {
    for (int step = 0;; ++step) {
        fs::remove_all(out_);
        const bool done = publish_until(step, new_run);
        ASSERT_TRUE(seen().empty() || seen() == new_run) << "ended before step " << step;
        if (done) break;
    }
    EXPECT_EQ(seen(), new_run);
}

TEST_F(Publishing, EndsWhatWasStoppedEvenIfThatIsStoppedToo) {
    for (const int first : {12, 20, 24, 28})
        for (int second = 0; second < 60; second += 3) {
            fs::remove_all(out_);
            publish(old_run);
            publish_until(first, new_run);
            const Files now = seen();
            if (const pid_t child = fork(); child == 0) {
                steps_left = second;
                before_change = end_at_last_step;
                { Staging next(out_); }
                ::_exit(0);
            } else {
                waitpid(child, nullptr, 0);
            }
            ASSERT_EQ(seen(), now) << first << " " << second;
            { Staging next(out_); }
            ASSERT_EQ(all(), names_of(now)) << first << " " << second;
        }
}

TEST_F(Publishing, WhatIsInTheWayAfterTheFirstStepsLeavesEverythingOld) {
    publish(old_run);
    Staging staging(out_);
    for (const auto& [name, text] : new_run) staging.write(name, text);
    static fs::path way;
    way = out_ / "plates/hero.png";
    steps_left = 8;
    before_change = [] {
        if (steps_left-- == 0) fs::remove(way), fs::create_directories(way / "in the way");
    };
    EXPECT_THROW(staging.commit(monitor_), OutputError);
    before_change = nullptr;
    EXPECT_EQ(monitor_.outputs, Outputs::untouched);
    Files expected = old_run;
    expected.erase("plates/hero.png");
    Files now = seen();
    now.erase("plates/hero.png");
    EXPECT_EQ(now, expected);
}

TEST_F(Publishing, LeavesFilesOfOthersAlone) {
    const std::vector<std::string> theirs = {".crescent-99999-backup/thesis.txt", ".crescent-123abc/notes",
        "plates/mine.png", ".crescent-stage-0123456789abcdef/kept", "thesis.tex"};
    for (const std::string& name : theirs) put(out_ / name, "theirs");
    put(out_ / "report.html", "written by hand");
    publish(old_run);
    EXPECT_EQ(text_of(out_ / "report.html.~1~"), "written by hand");
    publish(new_run);
    publish({{"metrics.json", "alone"}});
    for (const std::string& name : theirs) EXPECT_EQ(text_of(out_ / name), "theirs") << name;
    EXPECT_EQ(all().size(), theirs.size() + 2) << testing::PrintToString(all());
}

TEST_F(Publishing, IsNotLedElsewhereByALink) {
    put(top_ / "victim/hero.png", "victim");
    fs::create_directories(out_);
    fs::create_directory_symlink(top_ / "victim", out_ / "plates");
    EXPECT_THROW(publish(new_run), OutputError);
    fs::remove(out_ / "plates");
    fs::create_symlink(top_ / "victim/hero.png", out_ / "metrics.json");
    EXPECT_THROW(publish(new_run), OutputError);
    EXPECT_EQ(text_of(top_ / "victim/hero.png"), "victim");
    EXPECT_TRUE(seen().size() == 1 && fs::is_symlink(out_ / "metrics.json"));
    fs::remove(out_ / "metrics.json");
    put(out_ / manifest_file("outputs"), "../victim/hero.png\n/etc/hostname\nplates/../../victim/hero.png\n");
    publish(new_run);
    EXPECT_EQ(text_of(top_ / "victim/hero.png"), "victim");
}

TEST_F(Publishing, WorksThroughALinkAndInTheCurrentFolder) {
    fs::create_directories(top_ / "real");
    fs::create_directory_symlink("real", out_);
    publish(old_run);
    EXPECT_TRUE(fs::is_symlink(out_));
    EXPECT_EQ(seen(), old_run);
    const fs::path before = fs::current_path();
    fs::current_path(top_ / "real");
    out_ = ".";
    publish(new_run);
    EXPECT_EQ(seen(), new_run);
    fs::current_path(before);
}

TEST_F(Publishing, IsForOneRunAtATime) {
    Staging first(out_);
    try {
        Staging second(out_);
        FAIL();
    } catch (const OutputError& error) { EXPECT_THAT(error.what(), HasSubstr("another run")); }
    first.write("metrics.json", "first");
    first.commit(monitor_);
    EXPECT_EQ(text_of(out_ / "metrics.json"), "first");
    EXPECT_EQ(monitor_.outputs, Outputs::stand);
}

TEST_F(Publishing, OfAnotherKindLeavesTheseOutputs) {
    publish(old_run);
    Staging film(out_, "film");
    film.write("film.mp4", "film");
    film.commit(monitor_);
    EXPECT_EQ(seen(), old_run);
    EXPECT_EQ(text_of(out_ / "film.mp4"), "film");
}

TEST_F(Publishing, NamesWhatCannotBeWritten) {
    put(out_, "a file");
    EXPECT_THROW(Staging{out_.string()}, OutputError);
    EXPECT_THROW(Staging{(out_ / "below").string()}, OutputError);
    EXPECT_THROW(Staging{"/proc/crescent"}, OutputError);
}

}  // namespace
}  // namespace crescent::inline base
