// The plugin is compiled from tests/system/odd_plugin.c; this program, executed again, is its host.
#include "check/sources/plugin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <unistd.h>

#include "base/errors.h"
#include "base/progress.h"
#include "check/sources/check_case.h"
#include "check/sources/external.h"

namespace crescent {
namespace plugin_test {

using ::testing::HasSubstr;

/// A plugin that executes `on_call` in each call, in a folder that exists as long as the test.
class Plugins : public ::testing::Test {
protected:
    std::string compiled(const std::string& on_call, const std::string& flags = "") {
        const std::string file = (folder_ / "libodd.so").string();
        const std::string command =
            "cc -O1 -shared -fPIC -pthread -I " CRESCENT_SOURCE_DIR "/src -D 'ON_CALL=" + on_call + "' " + flags +
            " -o '" + file + "' " CRESCENT_SOURCE_DIR "/tests/system/odd_plugin.c -lm";
        EXPECT_EQ(std::system(command.c_str()), 0);
        return file;
    }
    /// The message of the error thrown by a draw.
    template <class Error> std::string error(const SamplerAdapter& plugin) {
        const std::vector<PrimarySample> u(10, {0.25, 0.5});
        std::vector<Draw> out(u.size());
        try {
            plugin.sample(0, {0, 0, 1}, u, out);
        } catch (const Error& e) { return e.what(); }
        return "";
    }
    void SetUp() override { std::filesystem::create_directory(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("crescent-plugins-" + std::to_string(::getpid()));
};

TEST_F(Plugins, AnswerManyThreadsAtOnce) {
    const auto plugin = open_plugin(compiled(""));
    EXPECT_EQ(plugin->name(), "libodd.so");
    EXPECT_EQ(plugin->traits().numbers, 2);
    EXPECT_TRUE(plugin->traits().has_pdf);
    EXPECT_FALSE(plugin->has_f());
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            // More rows than one request can contain.
            std::vector<PrimarySample> u;
            for (int i = 0; i < 70000; ++i) u.push_back({(i + 0.5) / 70000, 0.25});
            std::vector<Draw> out(u.size());
            plugin->sample(0, {0, 0, 1}, u, out);
            for (std::size_t i = 0; i < u.size(); ++i) ASSERT_DOUBLE_EQ(out[i].pdf, std::sqrt(u[i].x) / pi) << i;
            std::vector<Pair> at;
            for (const Draw& d : out) at.push_back({d.wi, d.wi});
            std::vector<double> p(at.size());
            plugin->pdf(0, at, p);
            for (std::size_t i = 0; i < p.size(); ++i) ASSERT_DOUBLE_EQ(p[i], out[i].pdf) << i;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(plugin->spending().answers, 4u * 2 * 70000);
}

TEST_F(Plugins, EndingTheProcessIsAnError) {
    const auto plugin = open_plugin(compiled("raise(SIGFPE)"));
    const std::string message = error<SamplerError>(*plugin);
    EXPECT_THAT(message, HasSubstr("libodd.so"));
    EXPECT_THAT(message, HasSubstr("SIGFPE"));
    EXPECT_THAT(message, HasSubstr("crescent_sampler_sample at w_o = (0, 0, 1)"));
    EXPECT_THAT(error<SamplerExited>(*plugin), HasSubstr("SIGFPE"));
}

TEST_F(Plugins, EndlessCallsAreStopped) {
    const std::string file = compiled("for (;;) {}");
    PipeLimits limits;
    limits.limit_answers(0.3);
    EXPECT_THAT(error<SamplerError>(*open_plugin(file, limits)), HasSubstr("after 0.3 s"));
    std::atomic<bool> stop = false;
    PipeLimits stopped;
    stopped.stop = &stop;
    const auto plugin = open_plugin(file, stopped);
    stop = true;
    EXPECT_EQ(error<Interrupted>(*plugin), "interrupted");
}

/// A name of 200 bytes is one; a longer one, or one without an end, would fill the pipe with what is taken for answers.
TEST_F(Plugins, LongNamesAreRefused) {
    EXPECT_EQ(open_plugin(compiled("", "-D NAME_BYTES=200"))->name(), std::string(200, 'a'));
    for (const char* bytes : {"201", "65499", "65528", "1000000"}) {
        const std::string file = compiled("", "-D NAME_BYTES=" + std::string(bytes));
        EXPECT_THROW(open_plugin(file), OutputError) << bytes;
    }
}

/// A host that begins with a handshake and then answers every request with `rows` rows.
class OtherHosts : public Plugins {
protected:
    std::string host(const std::string& handshake, const std::string& answer) {
        const std::string path = (folder_ / "host.sh").string();
        std::ofstream(path) << "#!/bin/sh\nprintf '" << handshake << "'\nprintf '" << answer << "'\nsleep 5\n";
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    void SetUp() override {
        Plugins::SetUp();
        if (const char* before = std::getenv("CRESCENT_PLUGIN_HOST")) before_ = before;
    }
    void TearDown() override {
        before_.empty() ? unsetenv("CRESCENT_PLUGIN_HOST") : setenv("CRESCENT_PLUGIN_HOST", before_.c_str(), 1);
        Plugins::TearDown();
    }

private:
    std::string before_;
};

TEST_F(OtherHosts, AnswersOfAnotherSizeAreRefused) {
    const std::string handshake = "crescent-plugin 2 numbers=2 pdf=0 f=0 serial=0 name=x\\n";
    // Ten rows are asked for: nine, eleven, and ten with a text after them.
    for (const char* answer :
        {"\\011\\0\\0\\0\\0\\0\\0\\0", "\\013\\0\\0\\0\\0\\0\\0\\0", "\\012\\0\\0\\0\\1\\0\\0\\0"}) {
        setenv("CRESCENT_PLUGIN_HOST", host(handshake, answer).c_str(), 1);
        EXPECT_THAT(error<SamplerError>(*open_plugin("x.so")), HasSubstr("expected 10 rows")) << answer;
    }
    setenv("CRESCENT_PLUGIN_HOST", host("crescent-plugin 2 name=" + std::string(5000, 'a'), "").c_str(), 1);
    EXPECT_THROW(open_plugin("x.so"), OutputError);
}

TEST_F(Plugins, MissingFunctionsAreReported) {
    EXPECT_THROW(open_plugin("nowhere.so"), OutputError);
    EXPECT_THROW(open_plugin(CRESCENT_SOURCE_DIR "/README.md"), OutputError);
}

}  // namespace plugin_test
}  // namespace crescent
