// crescent_backends FILE.toml N [CONTEXT [DEVICE [PEAK]]]: Msamples/s of every built-in sampler on the CPU and on GL,
// in one run on one machine, as a Markdown table. Samples are geometry pixels x N; each value is the best of some
// repetitions, CPU and GL alternating, because other load on the machine can only increase a time. PEAK: the device's
// arithmetic peak in Gflop/s as stated by its maker; the last column is then the fraction of it used by the samples'
// arithmetic (bench/counted.h).
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>

#include <fmt/format.h>

#include "counted.h"
#include "crescent/crescent.h"

namespace {

using namespace crescent;

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Figures {
    double cpu = 0, gl = 0;  // Msamples/s
};

Figures measure_arm(const Scene& scene, Backend& gl, const std::string& sampler, std::uint64_t n, double samples) {
    ProgressMonitor monitor;
    const Job job{sampler, sampler, {n}, scene.s(), 1};
    gl.films(scene, {sampler, sampler, {1}, job.s, 1}, monitor);  // compiles
    double cpu_s = 1e30, gl_s = 1e30;
    for (int k = 0; k < 7; ++k) {
        cpu_s = std::min(cpu_s, seconds_of([&] { estimate_films(scene, sampler, {n}, 1, "", monitor); }));
        gl_s = std::min(gl_s, seconds_of([&] { gl.films(scene, job, monitor); }));
    }
    return {samples / cpu_s * 1e-6, samples / gl_s * 1e-6};
}

std::string processor() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);)
        if (line.starts_with("model name")) return line.substr(line.find(": ") + 2);
    return "unknown processor";
}

void table(const Experiment& experiment, std::uint64_t n, const std::shared_ptr<Backend>& gl, double peak) {
    Scene scene(experiment);
    scene.remember_primaries();
    std::uint64_t pixels = 0, glossy = 0;
    for (const std::int16_t shape : shape_map(scene).shape) {
        pixels += shape >= 0;
        glossy += shape >= 0 && experiment.shapes[static_cast<std::size_t>(shape)].material.rho_s > 0;
    }
    const double share = static_cast<double>(glossy) / static_cast<double>(pixels);
    std::cout << fmt::format(
        "CPU: {}, {} threads, {}  \nGL: {}  \n{}, N = {}, {} geometry pixels; crescent {} {}, {}\n\n", processor(),
        std::thread::hardware_concurrency(), isas().back(), gl->name(), experiment.file, n, pixels, version(), commit(),
        compiler());
    std::cout << "| sampler | CPU, Msamples/s | GL, Msamples/s | CPU / GL | operations per sample |"
              << (peak > 0 ? " of the peak |" : "") << "\n|---|--:|--:|--:|--:|" << (peak > 0 ? "--:|" : "")
              << std::endl;
    for_each_sampler(Samplers{}, [&]<template <class> class A>() {
        if constexpr (A<float>::manual.gl.relative > 0) {
            const std::string name(A<float>::name);
            const double operations =
                share * static_cast<double>(bench::operations_per_sample<A, PhongLobe<Counted>>()) +
                (1 - share) * static_cast<double>(bench::operations_per_sample<A, NoLobe<Counted>>());
            const Figures f = measure_arm(scene, *gl, name, n, static_cast<double>(pixels * n));
            std::cout << fmt::format(
                "| {} | {:.1f} | {:.1f} | {:.2f} | {:.0f} |", name, f.cpu, f.gl, f.cpu / f.gl, operations);
            if (peak > 0) std::cout << fmt::format(" {:.1f} % |", 100 * f.gl * 1e-3 * operations / peak);
            std::cout << std::endl;
        }
    });
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 3 || argc > 6)
        throw InputError({"crescent_backends", 0, 0}, "expected FILE.toml N [CONTEXT [DEVICE [PEAK]]]");
    const auto kind = find_backend("gl");
    if (!kind) throw OutputError("this build has no GL back end");
    Experiment experiment = load(argv[1]);
    for (Shape& shape : experiment.shapes)
        if (!shape.material.alpha) shape.material.alpha = 0.2;  // used by the GGX samplers
    table(experiment, std::stoull(argv[2]), kind->open({argc > 3 ? argv[3] : "", argc > 4 ? std::stoi(argv[4]) : -1}),
        argc > 5 ? std::stod(argv[5]) : 0);
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
}
