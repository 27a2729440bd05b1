// crescent_bench FILE.toml N: one round. One line per arm, as JSON, of the seconds that a film takes with crescent's
// kernels and with the straightforward version, both on all cores, each the best of three films, because other load can
// only increase a time. bench/compare.py runs several rounds. The means of both are printed too: they must be of the
// same integral.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include <fmt/format.h>

#include "crescent/crescent.h"
#include "straightforward.h"

namespace {

using namespace crescent;

template <class Work> double best_of(int repetitions, Work&& work) {
    double best = 1e30;
    for (int k = 0; k < repetitions; ++k) {
        const auto start = std::chrono::steady_clock::now();
        work();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

constexpr int films_a_turn = 3;

void arm(const Scene& scene, const std::string& name, const std::string& sampler, std::uint64_t n, int threads) {
    ProgressMonitor monitor;
    std::vector<Film> films;
    double plain_mean = 0;
    const double fast = best_of(films_a_turn, [&] { films = estimate_films(scene, sampler, {n}, 1, "", monitor); });
    const double plain = best_of(
        films_a_turn, [&] { plain_mean = bench::straightforward(scene, sampler, static_cast<int>(n), 1, threads); });
    double mean = 0;
    for (float y : films.front().y) mean += y;
    mean /= static_cast<double>(films.front().size());
    std::cout << fmt::format(R"({{"arm": "{}", "crescent": {:.6f}, "straightforward": {:.6f}, "mean": {:.5f}, )"
                             R"("straightforward_mean": {:.5f}}})",
                     name, fast, plain, mean, plain_mean)
              << std::endl;
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 3) throw InputError({"crescent_bench", 0, 0}, "expected FILE.toml and N");
    const Experiment experiment = load(argv[1]);
    const std::uint64_t n = std::stoull(argv[2]);
    Scene scene(experiment);
    scene.remember_primaries();  // once for all films, as in a run
    const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::uint64_t pixels = 0;
    for (std::int16_t shape : shape_map(scene).shape) pixels += shape >= 0;
    std::cout
        << fmt::format(
               R"({{"geometry_pixels": {}, "n": {}, "threads": {}, "isa": "{}", "version": "{}", "commit": "{}", )"
               R"("compiler": "{}"}})",
               pixels, n, threads, isas().back(), version(), commit(), compiler())
        << std::endl;
    for (const ArmPlan& plan : experiment.arms) arm(scene, plan.name, plan.sampler, n, threads);
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
}
