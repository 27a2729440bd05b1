// Queries of several threads to copies of one sampler.
#include "check/sources/copies.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace crescent {
namespace copies_test {

/// A copy that answers when as many queries as are wanted have begun.
class Meeting : public SamplerSource {
public:
    explicit Meeting(int wanted) : wanted_(wanted) {}
    void meet() {
        std::unique_lock<std::mutex> guard(lock_);
        ++begun_;
        changed_.notify_all();
        changed_.wait(guard, [&] { return begun_ >= wanted_; });
    }
    int begun() const { return begun_; }

    std::string name() const override { return "meeting"; }
    bool serial() const override { return true; }
    void sample(int, Vec3d, std::span<const PrimarySample>, std::span<Draw>) const override {}
    void pdf(int, std::span<const Pair>, std::span<double>) const override {}

private:
    int wanted_;
    std::atomic<int> begun_ = 0;
    std::mutex lock_;
    std::condition_variable changed_;
};

/// A copy that calls a function for each query.
class Calling : public SamplerSource {
public:
    explicit Calling(std::function<void()> call) : call_(std::move(call)) {}
    std::string name() const override { return "calling"; }
    bool serial() const override { return true; }
    void sample(int, Vec3d, std::span<const PrimarySample>, std::span<Draw>) const override { call_(); }
    void pdf(int, std::span<const Pair>, std::span<double>) const override { call_(); }

private:
    std::function<void()> call_;
};

void ask(const SamplerAdapter& sampler) { sampler.sample(0, {0, 0, 1}, {}, {}); }

TEST(Copies, AnswerSeveralThreadsAtOnceUpToTheLimit) {
    Meeting meeting(3);
    std::atomic<int> started = 0;
    const Copies copies(
        [&] {
            ++started;
            return std::make_shared<Calling>([&] { meeting.meet(); });
        },
        3);
    EXPECT_FALSE(copies.serial());
    EXPECT_EQ(started, 1);
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 6; ++t) threads.emplace_back([&] { ask(copies); });
    }
    EXPECT_EQ(meeting.begun(), 6);
    EXPECT_EQ(started, 3);  // the queries wait for one another: three at once were answered by three copies
}

TEST(Copies, AreAllGivenUpAfterAFailure) {
    int started = 0;
    const Copies copies(
        [&] {
            ++started;
            return std::make_shared<Calling>([] { throw SamplerError("it crashed"); });
        },
        4);
    EXPECT_THROW(ask(copies), SamplerError);
    try {
        ask(copies);
        ADD_FAILURE() << "it answered";
    } catch (const SamplerExited& fault) { EXPECT_STREQ(fault.what(), "the program was given up: it crashed"); }
    EXPECT_EQ(started, 1);

    const Copies slow([] { return std::make_shared<Calling>([] { throw SamplerTimeout("too slow"); }); }, 4);
    EXPECT_THROW(ask(slow), SamplerTimeout);
    EXPECT_THROW(ask(slow), SamplerTimeout);
}

TEST(Copies, AreGivenBackAfterAnotherError) {
    const Copies copies([] { return std::make_shared<Calling>([] { throw std::bad_alloc(); }); }, 1);
    EXPECT_THROW(ask(copies), std::bad_alloc);
    EXPECT_THROW(ask(copies), std::bad_alloc);  // and does not wait for ever
}

TEST(Copies, GoOnWithThoseThatStart) {
    Meeting meeting(2);
    std::atomic<int> started = 0;
    const Copies copies(
        [&]() -> std::shared_ptr<const SamplerAdapter> {
            if (++started > 2) throw SamplerError("it does not start");
            return std::make_shared<Calling>([&] { meeting.meet(); });
        },
        4);
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t) threads.emplace_back([&] { ask(copies); });
    }
    EXPECT_EQ(meeting.begun(), 8);
    EXPECT_LE(started, 4);  // two that failed, at the same time
    EXPECT_EQ(copies.spending().answers, 0u);
}

}  // namespace copies_test
}  // namespace crescent
