// Threads: oneTBB where there are threads, one call after another where CRESCENT_SERIAL says that there are none (a
// page in a browser, another machine's core under test). Nothing outside this file asks which.
//
// Outputs never depend on it: what threads add up is merged in the order of tiles, by the caller.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

#ifndef CRESCENT_SERIAL
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <mutex>
#endif

namespace crescent {

#ifndef CRESCENT_SERIAL

/// Calls work(i) for every i in [begin, end), on all cores, in any order; returns when all are done. What one of them
/// throws ends the rest and comes out here.
template <class Index, class Work> void parallel_for(Index begin, Index end, const Work& work) {
    oneapi::tbb::parallel_for(begin, end, work);
}

/// One T a thread, made by `make` when the thread first asks.
template <class T> class PerThread {
public:
    explicit PerThread(std::function<T()> make) : all_(std::move(make)) {}
    T& local() { return all_.local(); }

private:
    oneapi::tbb::enumerable_thread_specific<T> all_;
};

using Mutex = std::mutex;
using Guard = std::lock_guard<std::mutex>;

#else

template <class Index, class Work> void parallel_for(Index begin, Index end, const Work& work) {
    for (Index i = begin; i < end; ++i) work(i);
}

template <class T> class PerThread {
public:
    explicit PerThread(const std::function<T()>& make) : one_(make()) {}
    T& local() { return one_; }

private:
    T one_;
};

struct Mutex {};
struct Guard {
    explicit Guard(Mutex&) {}
};

#endif

}  // namespace crescent
