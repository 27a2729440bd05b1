// Threads: oneTBB, or sequential calls if CRESCENT_NO_THREADS is defined (a page in a browser, the portable code under
// test for another machine). Only this file depends on the choice.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#ifndef CRESCENT_NO_THREADS
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include <mutex>
#endif

namespace crescent {

#ifndef CRESCENT_NO_THREADS

/// Calls work(i) for every i in [begin, end), on all cores, in any order; returns when all are done. An exception of
/// one of them stops the rest and is rethrown here.
template <class Index, class Work> void parallel_for(Index begin, Index end, const Work& work) {
    oneapi::tbb::parallel_for(begin, end, work);
}

/// Calls both, at the same time if a thread is free; an exception of either is rethrown here when both have ended.
template <class A, class B> void side_by_side(const A& a, const B& b) { oneapi::tbb::parallel_invoke(a, b); }

/// Calls work() and returns its result; parallel calls inside it use at most `threads` threads. Other threads of the
/// process, and oneTBB as a whole, are not limited.
template <class Work> auto on_threads(int threads, const Work& work) {
    oneapi::tbb::task_arena arena(threads);
    return arena.execute(work);
}

/// Returns how many threads the innermost on_threads() allows; without one, the default of oneTBB.
inline int threads_here() { return oneapi::tbb::this_task_arena::max_concurrency(); }

/// One T per thread, made by `make` when the thread first uses it.
template <class T> class PerThread {
public:
    /// `make` may be called by several threads at once; local() is the calling thread's own.
    explicit PerThread(std::function<T()> make) : values_(std::move(make)) {}
    T& local() { return values_.local(); }

private:
    oneapi::tbb::enumerable_thread_specific<T> values_;
};

using Mutex = std::mutex;
using Guard = std::lock_guard<std::mutex>;

#else

/// Like above, one after another in order.
template <class Index, class Work> void parallel_for(Index begin, Index end, const Work& work) {
    for (Index i = begin; i < end; ++i) work(i);
}

/// Like above: first a, then b.
template <class A, class B> void side_by_side(const A& a, const B& b) {
    a();
    b();
}

/// Like above; there is one thread.
template <class Work> auto on_threads(int, const Work& work) { return work(); }

/// Returns the number of threads that parallel_for may use here.
inline int threads_here() { return 1; }

/// Like above: one T, made at once.
template <class T> class PerThread {
public:
    /// local() is the result of `make`.
    explicit PerThread(const std::function<T()>& make) : value_(make()) {}
    T& local() { return value_; }

private:
    T value_;
};

/// With one thread there is nothing to lock.
struct Mutex {};
struct Guard {
    explicit Guard(Mutex&) {}  // does nothing
};

#endif

/// Calls work(i) for every i below `count`: one after another in order if it is serial, else on all cores.
template <class Work> void for_each_index(bool serial, std::size_t count, const Work& work) {
    if (!serial) return parallel_for(std::size_t{0}, count, work);
    for (std::size_t i = 0; i < count; ++i) work(i);
}

}  // namespace crescent
