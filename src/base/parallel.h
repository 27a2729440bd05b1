// Threads: oneTBB where there are threads, one call after another where CRESCENT_NO_THREADS says that there are none (a
// page in a browser, another machine's core under test). Nothing outside this file asks which.
//
// Outputs never depend on it: what threads add up is merged in the order of tiles, by the caller.
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

namespace crescent::inline base {

#ifndef CRESCENT_NO_THREADS

/// Calls work(i) for every i in [begin, end), on all cores, in any order; returns when all are done. What one of them
/// throws ends the rest and comes out here.
template <class Index, class Work> void parallel_for(Index begin, Index end, const Work& work) {
    oneapi::tbb::parallel_for(begin, end, work);
}

/// Calls both, at the same time where a thread is free; what one of them throws comes out here once both have ended.
template <class A, class B> void side_by_side(const A& a, const B& b) { oneapi::tbb::parallel_invoke(a, b); }

/// work(), and what it returns; what it and all below it do at the same time, they do on `threads` threads at most.
/// Nothing outside of it is limited: other threads of the process, and oneTBB as a whole, stay as they are.
template <class Work> auto on_threads(int threads, const Work& work) {
    oneapi::tbb::task_arena arena(threads);
    return arena.execute(work);
}

/// How many threads the innermost on_threads() allows; without one, as many as oneTBB takes by itself.
inline int threads_here() { return oneapi::tbb::this_task_arena::max_concurrency(); }

/// One T a thread, made by `make` when the thread first asks.
template <class T> class PerThread {
public:
    /// `make` may be called by several threads at once; local() is the calling thread's own.
    explicit PerThread(std::function<T()> make) : all_(std::move(make)) {}
    T& local() { return all_.local(); }

private:
    oneapi::tbb::enumerable_thread_specific<T> all_;
};

using Mutex = std::mutex;
using Guard = std::lock_guard<std::mutex>;

#else

/// As above, one after another in order.
template <class Index, class Work> void parallel_for(Index begin, Index end, const Work& work) {
    for (Index i = begin; i < end; ++i) work(i);
}

/// As above: first a, then b.
template <class A, class B> void side_by_side(const A& a, const B& b) {
    a();
    b();
}

/// As above; there is one thread.
template <class Work> auto on_threads(int, const Work& work) { return work(); }

/// Threads that parallel_for may use at this place.
inline int threads_here() { return 1; }

/// As above: one T, made at once.
template <class T> class PerThread {
public:
    /// local() is what `make` gave.
    explicit PerThread(const std::function<T()>& make) : one_(make()) {}
    T& local() { return one_; }

private:
    T one_;
};

/// Nothing to lock where there is one thread.
struct Mutex {};
struct Guard {
    explicit Guard(Mutex&) {}  // does nothing
};

#endif

/// work(i) for every i below `count`: one after another in order if it is serial, else on all cores.
template <class Work> void for_each_index(bool serial, std::size_t count, const Work& work) {
    if (!serial) return parallel_for(std::size_t{0}, count, work);
    for (std::size_t i = 0; i < count; ++i) work(i);
}

}  // namespace crescent::inline base
