// crescent_adapters PLUGIN SHADER [OPTION]...: the draws and densities in a second, in millions, of a plugin and of a
// shader with its options (docs/shaders.md), asked through crescent: batches of 65,536 rows at one w_o, by a thread for
// each processor unless the sampler answers one caller at a time. Prints a line "SAMPLER KIND RATE" for each, in turn,
// and fails if their densities differ. bench/shaders.py takes the medians.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "crescent/crescent.h"

namespace {

using namespace crescent;

constexpr std::size_t rows = 1 << 16, batches = 512;

/// A batch at one w_o: its random numbers, and directions above the surface.
struct Batch {
    Vec3d wo = tilt(40);
    std::vector<PrimarySample> u;
    std::vector<Pair> pairs;

    Batch() {
        for (std::uint32_t i = 0; i < rows; ++i) {
            const double x = (i + 0.5) / rows, y = std::fmod(i * 0.6180339887498949, 1);
            u.emplace_back(x, y);
            pairs.push_back({wo, tilt(180 / pi * std::acos(x), 360 * y)});
        }
    }
};

/// Calls work(draws, values) for all batches, and returns millions of rows in a second.
template <class Work> double rate(const SamplerAdapter& sampler, const Work& work) {
    const std::size_t threads = sampler.serial() ? 1 : std::max(1u, std::thread::hardware_concurrency());
    const auto start = std::chrono::steady_clock::now();
    {
        std::vector<std::jthread> pool;
        for (std::size_t t = 0; t < threads; ++t)
            pool.emplace_back([&, t] {
                std::vector<Draw> draws(rows);
                std::vector<double> values(rows);
                for (std::size_t k = t; k < batches; k += threads) work(std::span(draws), std::span(values));
            });
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    return 1e-6 * static_cast<double>(rows * batches) / seconds.count();
}

void print_rates(const char* name, const SamplerAdapter& sampler, const Batch& batch) {
    const auto draw = [&](std::span<Draw> draws, std::span<double>) { sampler.sample(0, batch.wo, batch.u, draws); };
    const auto density = [&](std::span<Draw>, std::span<double> values) { sampler.pdf(0, batch.pairs, values); };
    rate(sampler, draw);  // starts the processes
    std::printf("%s draws %.2f\n", name, rate(sampler, draw));
    std::printf("%s densities %.2f\n", name, rate(sampler, density));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("crescent_adapters: expected PLUGIN SHADER [OPTION]...\n", stderr);
        return 2;
    }
    try {
        const auto plugin = open_plugin(argv[1]);
        const auto shader = start_shader(argv[2], {argv + 3, argv + argc}, {});
        const Batch batch;
        std::vector<double> p(rows), q(rows);
        plugin->pdf(0, batch.pairs, p);
        shader->pdf(0, batch.pairs, q);
        for (std::size_t i = 0; i < rows; ++i)
            if (!(std::fabs(p[i] - q[i]) <= 1e-2 * p[i] + 1e-4)) {
                std::fprintf(stderr, "crescent_adapters: the densities differ: %g and %g\n", p[i], q[i]);
                return 1;
            }
        print_rates("plugin", *plugin, batch);
        print_rates("shader", *shader, batch);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "crescent_adapters: %s\n", e.what());
        return 3;
    }
    return 0;
}
