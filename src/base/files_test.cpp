// Outputs appear all at once: after a kill before any change, a reader finds one complete run, and the next run leaves
// the same files, including the user's, as after a run that was never killed. Tested for each method of moving outputs.
#include "base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "base/errors.h"
#include "base/whole_file.h"

namespace crescent {
namespace files_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Files = std::map<std::string, std::string>;  // name -> content

const Files old_run = {{"metrics.json", "old"}, {"report.html", "old"}, {"plates/hero.png", "old"},
    {"plates/heat.png", "old"}, {"films/a/b.exr", "old"}};
const Files new_run = {
    {"metrics.json", "new"}, {"report.html", "new"}, {"plates/hero.png", "new"}, {"plates/rose.png", "new"}};
const Files users = {{"notes.txt", "mine"}, {"plates/mine.png", "mine"}, {"films/mine.txt", "mine"},
    {"thesis/chapter/one.tex", "mine"}, {"plates/more/mine.png", "mine"}};

enum class Way { exchange, two_renames, one_by_one, current_folder };

int steps_left = 0;
void end_at_last_step() {
    if (steps_left-- == 0) ::_exit(99);
}

class Publishing : public testing::TestWithParam<Way> {
protected:
    // In memory if possible: these tests sync some thousand times.
    fs::path top_ = fs::path(fs::is_directory("/dev/shm") ? "/dev/shm" : testing::TempDir()) /
        ("publishing-" + std::to_string(getpid()));
    fs::path out_ = top_ / "out", before_ = fs::current_path();
    ProgressMonitor monitor_;
    void SetUp() override {
        fs::remove_all(top_);
        fs::create_directories(top_);
        publishing_faults() = {nullptr, way() == Way::two_renames, way() == Way::one_by_one};
    }
    void TearDown() override {
        fs::current_path(before_);
        publishing_faults() = {};
        fs::remove_all(top_);
    }
    Way way() const { return HasParam() ? GetParam() : Way::exchange; }
    static bool HasParam() { return testing::UnitTest::GetInstance()->current_test_info()->value_param() != nullptr; }

    static void put(const fs::path& at, const std::string& text) {
        fs::create_directories(at.parent_path());
        std::ofstream(at) << text;
    }
    static std::string text_of(const fs::path& at) {
        std::ifstream file(at);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void publish(const Files& files, const std::string& kind = "outputs") {
        Staging staging(out_, kind);
        for (const auto& [name, text] : files) staging.write(name, text);
        staging.commit(monitor_);
    }
    void start_over(const Files& run) {
        fs::current_path(before_);
        fs::remove_all(out_);
        fs::remove_all(top_ / ".out.crescent");
        for (const auto& [name, text] : users) put(out_ / name, text);
        if (way() == Way::current_folder) fs::current_path(out_);
        publish(run);
    }
    /// Returns every file and link below the folder that contains OUT.
    Files all() const {
        Files out;
        for (const auto& entry : fs::recursive_directory_iterator(top_))
            if (!entry.is_directory() || entry.is_symlink() || fs::is_empty(entry))
                out[entry.path().lexically_relative(top_).string()] = entry.is_regular_file() ? text_of(entry) : "-";
        return out;
    }
    /// Returns what a reader finds in OUT under the names of both runs.
    Files seen() const {
        Files out;
        for (const Files& run : {old_run, new_run})
            for (const auto& [name, text] : run)
                if (fs::is_regular_file(out_ / name)) out[name] = text_of(out_ / name);
        return out;
    }
    std::size_t users_files_seen() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(users, [&](const auto& file) { return text_of(out_ / file.first) == file.second; }));
    }
    /// Runs the work in a process that ends before its `step`-th change. Returns true if the work was completed.
    template <class Work> bool ends_before(int step, const Work& work) {
        const pid_t child = fork();
        if (child == 0) {
            steps_left = step;
            publishing_faults().before_change = end_at_last_step;
            work();
            ::_exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }
};

std::string name_of(const testing::TestParamInfo<Way>& info) {
    const char* names[] = {"exchange", "two_renames", "one_by_one", "current_folder"};
    return names[static_cast<int>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(
    Each, Publishing, testing::Values(Way::exchange, Way::two_renames, Way::one_by_one, Way::current_folder), name_of);

TEST_P(Publishing, KillBeforeAnyChangeLosesNothing) {
    start_over(new_run);
    const Files clean = all();
    ASSERT_EQ(users_files_seen(), users.size());
    ASSERT_FALSE(fs::exists(top_ / ".out.crescent"));
    int steps = 0, mixed = 0;
    for (bool done = false; !done; ++steps) {
        start_over(old_run);
        done = ends_before(steps, [&] { publish(new_run); });
        const Files now = seen();
        const bool whole = now == old_run || now == new_run || (way() == Way::two_renames && now.empty());
        mixed += !whole;
        if (way() != Way::one_by_one && way() != Way::current_folder) {
            ASSERT_TRUE(whole) << "ended before change " << steps;
        }
        if (way() == Way::exchange) {
            EXPECT_EQ(text_of(out_ / "notes.txt") + text_of(out_ / "plates/mine.png"), "minemine") << steps;
        }
        { Staging next(out_); }  // a later run that is stopped at its start
        ASSERT_TRUE(seen() == old_run || seen() == new_run) << "ended before change " << steps;
        ASSERT_EQ(users_files_seen(), users.size()) << "ended before change " << steps;
        ASSERT_FALSE(fs::exists(top_ / ".out.crescent")) << "ended before change " << steps;
        publish(new_run);
        ASSERT_EQ(all(), clean) << "ended before change " << steps;
    }
    EXPECT_GT(steps, 20);
    EXPECT_LT(mixed, 10);
}

TEST_P(Publishing, KilledTwiceLosesNothing) {
    start_over(new_run);
    const Files clean = all();
    for (int first = 3; first < 60; first += 7)
        for (int second = 0; second < 40; second += 3) {
            start_over(old_run);
            ends_before(first, [&] { publish(new_run); });
            ends_before(second, [&] { publish(new_run); });
            publish(new_run);
            ASSERT_EQ(all(), clean) << first << " " << second;
        }
}

TEST_P(Publishing, KilledInOneWayIsCompletedInAnother) {
    start_over(new_run);
    const Files clean = all();
    for (int step = 3; step < 60; ++step) {
        start_over(old_run);
        ends_before(step, [&] { publish(new_run); });
        fs::current_path(before_);
        publishing_faults() = {nullptr, step % 2 == 0, way() == Way::exchange};
        { Staging next(out_); }
        EXPECT_TRUE(seen() == old_run || seen() == new_run) << "ended before change " << step;
        publish(new_run);
        ASSERT_EQ(all(), clean) << "ended before change " << step;
        publishing_faults() = {nullptr, way() == Way::two_renames, way() == Way::one_by_one};
    }
}

TEST_P(Publishing, ReplacesItsOwnFilesAndKeepsTheUsers) {
    start_over(old_run);
    put(out_ / "report.html", "ours, changed");
    put(out_ / "plates/rose.png", "written by hand");
    publish({{"film.mp4", "film"}}, "film");
    EXPECT_EQ(seen().size(), old_run.size() + 1) << "another kind of work leaves these outputs";
    publish(new_run);
    EXPECT_EQ(seen(), new_run);
    EXPECT_EQ(text_of(out_ / "plates/rose.png.~1~"), "written by hand");
    EXPECT_EQ(text_of(out_ / "film.mp4"), "film");
    EXPECT_EQ(users_files_seen(), users.size());
    EXPECT_FALSE(fs::exists(out_ / "films/a"));
    EXPECT_EQ(monitor_.outputs, Outputs::complete);
}

TEST_F(Publishing, ForTheFirstTimeShowsAllOrNothing) {
    for (int step = 0;; ++step) {
        fs::remove_all(out_);
        const bool done = ends_before(step, [&] { publish(new_run); });
        ASSERT_TRUE(!fs::exists(out_) || seen() == new_run) << "ended before change " << step;
        if (done) break;
    }
}

TEST_F(Publishing, KeepsPermissionsAndFollowsALink) {
    fs::create_directories(top_ / "real/out");
    fs::permissions(top_ / "real/out", fs::perms(0750));
    fs::create_directory_symlink("real/out", out_);
    publish(old_run);
    publish(new_run);
    EXPECT_TRUE(fs::is_symlink(out_));
    EXPECT_EQ(seen(), new_run);
    EXPECT_EQ(fs::status(out_).permissions(), fs::perms(0750));
    EXPECT_EQ(std::distance(fs::directory_iterator(top_ / "real"), {}), 1);
}

TEST_F(Publishing, WritesToTheFolderOfThePathAtItsStart) {
    fs::create_directories(top_ / "elsewhere");
    fs::current_path(top_);
    Staging staging("out");
    staging.write("metrics.json", "new");
    fs::current_path(top_ / "elsewhere");
    staging.commit(monitor_);
    EXPECT_EQ(text_of(out_ / "metrics.json"), "new");
}

TEST_F(Publishing, DoesNotFollowALink) {
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
    fs::create_directory_symlink(top_ / "victim", out_ / "linked");
    put(out_ / ".crescent-outputs",
        "../victim/hero.png\n/etc/hostname\nplates/../../victim/hero.png\nlinked/hero.png\n");
    for (const bool stays : {true, false}) {
        publishing_faults().no_rename_of_folders = stays;
        publish(new_run);
        EXPECT_EQ(text_of(top_ / "victim/hero.png"), "victim");
        EXPECT_TRUE(fs::is_symlink(out_ / "linked"));
    }
}

TEST_F(Publishing, IsForOneRunAtATimeAndNoChildKeepsTheLock) {
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    pid_t child = 0;
    {
        Staging first(out_);
        try {
            Staging second(out_);
            FAIL();
        } catch (const OutputError& error) { EXPECT_THAT(error.what(), HasSubstr("another run")); }
        if (child = fork(); child == 0) {
            char byte;
            close(pipe_ends[1]);
            ::_exit(read(pipe_ends[0], &byte, 1) == 0 ? 0 : 1);
        }
        EXPECT_TRUE(ends_before(99, [&] {
            try {
                Staging second(out_);
                ::_exit(1);
            } catch (const OutputError&) { ::_exit(0); }
        })) << "another process";
        first.write("metrics.json", "first");
        first.commit(monitor_);
    }
    EXPECT_NO_THROW(publish(new_run)) << "while a child of the first run lives";
    close(pipe_ends[1]);
    close(pipe_ends[0]);
    waitpid(child, nullptr, 0);
}

TEST_F(Publishing, IsForOneProcessAtATime) {
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    const pid_t child = fork();  // before the first run: it knows of that run's lock by the file alone
    if (child == 0) {
        char byte = 0;
        if (read(pipe_ends[0], &byte, 1) != 1) ::_exit(2);
        try {
            Staging second(out_);
        } catch (const OutputError&) { ::_exit(0); }
        ::_exit(1);
    }
    int status = 0;
    {
        Staging first(out_);
        EXPECT_EQ(::write(pipe_ends[1], "x", 1), 1);
        waitpid(child, &status, 0);
    }
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0) << "1: the second process got the lock";
}

TEST_F(Publishing, NamesTheFileThatCannotBeWritten) {
    put(out_, "a file");
    EXPECT_THROW(Staging{out_.string()}, OutputError);
    EXPECT_THROW(Staging{(out_ / "below").string()}, OutputError);
    EXPECT_THROW(Staging{"/proc/crescent"}, OutputError);
    fs::remove(out_);
    fs::create_directory_symlink("nowhere", out_);
    EXPECT_THROW(Staging{out_.string()}, OutputError);
    fs::remove(out_);
    put(top_ / ".out.crescent/new/theirs", "theirs");
    EXPECT_THROW(Staging{out_.string()}, OutputError);
    EXPECT_EQ(text_of(top_ / ".out.crescent/new/theirs"), "theirs");
}

TEST(BackupNames, AreTheFirstThatNoFileHas) {
    const fs::path folder = fs::path(testing::TempDir()) / ("backups-" + std::to_string(getpid()));
    fs::create_directories(folder);
    const fs::path file = folder / "notes.txt";
    EXPECT_EQ(free_backup_name(file), folder / "notes.txt.~1~");
    std::ofstream(folder / "notes.txt.~1~") << "mine";
    fs::create_symlink("nowhere", folder / "notes.txt.~2~");
    EXPECT_EQ(free_backup_name(file), folder / "notes.txt.~3~");
    fs::remove_all(folder);
}

TEST(WholeFiles, BelowDevShmAreFiles) {
    if (!fs::is_directory("/dev/shm")) GTEST_SKIP() << "no /dev/shm";
    const std::string path = "/dev/shm/crescent-whole-" + std::to_string(getpid());
    write_whole(path, std::string(100, 'x'));
    write_whole(path, "new");
    EXPECT_EQ(contents_of(path), "new");
    fs::remove(path);
    EXPECT_NO_THROW(write_whole("/dev/null", "x"));
    EXPECT_THROW(write_whole("/dev/crescent-absent", "x"), OutputError);
    EXPECT_FALSE(fs::exists("/dev/crescent-absent"));
}

}  // namespace files_test
}  // namespace crescent
