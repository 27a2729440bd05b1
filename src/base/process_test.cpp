// Starting, ending and reading other programs, tested with shell commands.
#include "base/process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <thread>
#include <unistd.h>

#include "base/errors.h"

namespace crescent {
namespace process_test {

using ::testing::HasSubstr;
using ::testing::Not;

/// Returns what a shell command prints to stdout, and how it ended.
std::pair<std::string, std::string> run(const std::string& command) {
    Process process({.argv = {"/bin/sh", "-c", command}, .stdin_file = "/dev/null", .label = "sh"});
    std::string out;
    for (char buffer[4096];;) {
        const ssize_t n = process.read(buffer, sizeof buffer);
        if (n == 0) break;
        if (n > 0) out.append(buffer, static_cast<std::size_t>(n));
        else process.wait_ready(false, true, 1000);
    }
    return {out, process.ended(5000).value_or(ProcessEnd{-1, 0}).text()};
}

TEST(Processes, ReportHowTheyEnded) {
    EXPECT_EQ(run("echo yes; exit 3"), (std::pair<std::string, std::string>{"yes\n", "exit code 3"}));
    EXPECT_THAT(run("kill -SEGV $$").second, HasSubstr("signal 11"));
    EXPECT_THROW(Process({.argv = {"crescent-has-no-such-program"}}), OutputError);
}

TEST(Processes, InheritNoSignalMaskHandlerOrDescriptor) {
    const int file = ::open("/dev/null", O_RDONLY);  // without O_CLOEXEC
    const auto before = std::signal(SIGUSR2, SIG_IGN);
    sigset_t usr1, mask;
    sigemptyset(&usr1);
    sigaddset(&usr1, SIGUSR1);
    pthread_sigmask(SIG_BLOCK, &usr1, &mask);
    const std::string status = run("exec cat /proc/self/status").first, files = run("exec ls /proc/self/fd").first;
    pthread_sigmask(SIG_SETMASK, &mask, nullptr);
    std::signal(SIGUSR2, before);
    ::close(file);
    EXPECT_THAT(status, HasSubstr("SigBlk:\t0000000000000000"));
    EXPECT_THAT(status, HasSubstr("SigIgn:\t0000000000000000"));
    EXPECT_EQ(files, "0\n1\n2\n3\n");  // 3: the folder that ls reads
}

/// Returns whether a process runs; a killed process that waits to be reaped does not.
bool runs(const std::string& id) {
    std::ifstream file("/proc/" + id + "/stat");
    std::string text;
    std::getline(file, text);
    const std::size_t state = text.rfind(')');
    return state != std::string::npos && text.substr(state + 2, 1) != "Z";
}

TEST(Processes, EndWithTheirGroup) {
    std::string id;
    {
        Process process({.argv = {"/bin/sh", "-c", "sleep 300 & echo $!; wait"}, .stdin_file = "/dev/null"});
        for (char c = 0; c != '\n';) {
            if (process.read(&c, 1) < 1) process.wait_ready(false, true, 1000);
            else if (c != '\n') id += c;
        }
        EXPECT_TRUE(runs(id));
    }
    for (int k = 0; k < 200 && runs(id); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(runs(id));
}

TEST(Processes, OutliveTheThreadThatStartedThem) {
    std::unique_ptr<Process> process;
    std::thread([&] { process.reset(new Process({.argv = {"sleep", "300"}, .stdin_file = "/dev/null"})); }).join();
    EXPECT_FALSE(process->ended(100));
    const auto start = std::chrono::steady_clock::now();
    process.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(Processes, EndWhileAChildKeepsTheirPipesOpen) {
    Process process({.argv = {"/bin/sh", "-c", "sleep 300 & exit 4"}, .stdin_file = "/dev/null"});
    const std::optional<ProcessEnd> end = process.ended(5000);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->code, 4);
}

/// Returns what arrives on our own stderr of a command's stderr.
std::string passed_on(const std::string& command) {
    ::testing::internal::CaptureStderr();
    {
        Process process({.argv = {"/bin/sh", "-c", command}, .stdin_file = "/dev/null", .label = "it"});
        process.ended(5000);
    }
    return ::testing::internal::GetCapturedStderr();
}

TEST(Processes, HaveTheirStderrPassedOnInLines) {
    EXPECT_EQ(passed_on("echo one >&2; printf 'two\\r\\nthree' >&2"), "it: one\nit: two\nit: three\n");
    EXPECT_EQ(passed_on("printf 'a\\033[2Jb\\007\\000c\\n' >&2"), "it: a\\x1b[2Jb\\x07\\x00c\n");
    EXPECT_EQ(passed_on("printf 'caf\\303\\251 \\377 \\302\\233\\n\\n' >&2"), "it: café \\xff \\u{9b}\nit: \n");
    EXPECT_EQ(passed_on("true"), "");
}

TEST(Processes, LongLinesAreSplitBetweenCharacters) {
    const std::string text = passed_on("for k in $(seq 5001); do printf '\\342\\202\\254'; done >&2");  // €
    std::istringstream lines(text);
    std::string all;
    for (std::string line; std::getline(lines, line);) {
        ASSERT_EQ(line.substr(0, 4), "it: ");
        EXPECT_LE(line.size(), 4100u);
        all += line.substr(4);
    }
    EXPECT_EQ(all.size(), 3u * 5001);
    EXPECT_THAT(all, Not(HasSubstr("\\x")));
}

}  // namespace process_test
}  // namespace crescent
