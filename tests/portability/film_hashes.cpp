// The bits of crescent's results: functions of math/, and, for every experiment, each film at its own seed on each
// instruction set of this machine, its references, and FLIP. Two builds agree if this prints the same; it needs no
// folder that draws or reports, so that a second compiler has little to build.
//
//
//   film_hashes FILE.toml...            the hashes
//   film_hashes --fewer FILE.toml...    of small images and few samples
//   film_hashes --plain FILE.toml...    no hashes: the (small) experiments as plain numbers, for another machine's
//   film_hashes < PLAIN                 which prints the hashes of them
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <iostream>

#include "experiment/experiment.h"
#include "math/functions.h"
#include "math/simd/random.h"
#include "metrics/flip.h"
#include "metrics/monte_carlo_reference.h"
#include "render/estimator.h"
#include "render/reference/paired.h"
#include "render/reference/reference.h"
#include "tests/portability/plain.h"

namespace {

using namespace crescent;

/// Prints the bits of f over an even sweep of [a, b].
template <class Function> void print_function(const char* name, Function f, double a, double b) {
    std::vector<double> values;
    constexpr int count = 4096;
    for (int k = 0; k <= count; ++k) values.push_back(f(a + (b - a) * k / count));
    const std::uint64_t bits = XXH3_64bits(values.data(), values.size() * sizeof(double));
    std::cout << "function " << name << ' ' << std::hex << bits << std::dec << '\n';
}

void print_functions() {
    print_function("exp", math::exp, -750, 710);
    print_function("exp2", math::exp2, -1080, 1024);
    print_function("expm1", math::expm1, -2, 2);
    print_function("log", math::log, 0x1p-1060, 3);
    print_function("log10", math::log10, 0.01, 1e6);
    print_function("log1p", math::log1p, -0.999, 3);
    print_function("sin", math::sin, -100, 1e5);
    print_function("cos", math::cos, -1e12, 1e13);
    print_function("tan", math::tan, -2, 2);
    print_function("asin", math::asin, -1, 1);
    print_function("acos", math::acos, -1, 1);
    print_function("pow", [](double x) { return math::pow(x, 40 - 7 * x); }, 0, 9);
    print_function("atan2", [](double x) { return math::atan2(x, 1 - x * x); }, -3, 3);
    print_function("hypot", [](double x) { return math::hypot(x, 2, 1 / x); }, -3, 3.1);
}

/// A sky of 32 x 16 texels over five orders of magnitude.
SkyLight some_sky() {
    auto image = std::make_shared<RgbImage>();
    image->width = 32;
    image->height = 16;
    for (std::uint32_t k = 0; k < 32 * 16; ++k)
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t hash = pcg4d(Vec4u<std::uint32_t>{k, c, 1, 2}).x;
            image->rgb.push_back(static_cast<float>(hash >> 8) * (k % 61 == 0 ? 0x1p-10f : 0x1p-24f));
        }
    SkyLight sky;
    sky.rotation = 77;
    sky.image = std::move(image);
    return sky;
}

/// 24 pixels of the same view under a sky in place of the fill.
void print_under_a_sky(Experiment e) {
    e.image.height = std::max(1, e.image.height * 24 / e.image.width);
    e.image.width = 24;
    e.fill = {};
    e.sky = some_sky();
    const Scene scene(e);
    ProgressMonitor monitor;
    for (const std::string& isa : isas())
        for (const char* sampler : {"sky", "cosine"})
            for (const Film& film : estimate_films(scene, {sampler}, {4}, e.seed, isa, monitor))
                std::cout << e.file << ' ' << isa << " under a sky, " << sampler << ' ' << hash(film) << '\n';
    for (const ReferenceFilm& film : paired_reference({TiledScene(scene)}, {8, {1, 2}}, monitor))
        std::cout << e.file << " paired " << hash(film) << '\n';
}

/// FLIP of the first arm's film.
void print_flip(const Experiment& experiment, const Scene& scene, const ReferenceFilm& reference) {
    ProgressMonitor monitor;
    const ArmPlan& arm = experiment.arms.front();
    const Film film = estimate_films(scene, arm.sampler, {arm.n.front()}, experiment.seed, "scalar", monitor).front();
    const auto image = [](const auto& of) { return FlipImage{of.width, of.height, of.r, of.g, of.b}; };
    for (const std::string& isa : isas()) {
        const std::vector<float> map = hdr_flip(image(reference), image(film), flip_pixels_per_degree, isa);
        std::cout << experiment.file << ' ' << isa << " flip " << arm.name << ' ' << std::hex
                  << XXH3_64bits(map.data(), map.size() * sizeof(float)) << std::dec << '\n';
    }
}

void print(const Experiment& experiment) {
    const Scene scene(experiment);
    ProgressMonitor monitor;
    for (const std::string& isa : isas())
        for (const ArmPlan& arm : experiment.arms)
            for (const Film& film : estimate_films(scene, arm.sampler, arm.n, experiment.seed, isa, monitor))
                std::cout << experiment.file << ' ' << isa << ' ' << arm.name << " n=" << film.n << ' ' << hash(film)
                          << '\n';
    for (const std::string& isa : isas())
        for (const ReferenceFilm& film : monte_carlo_reference({scene}, experiment, isa, monitor))
            std::cout << experiment.file << ' ' << isa << " note-reference " << hash(film) << '\n';
    for (const ReferenceFilm& film : quadrature_reference(scene, {experiment.s()}, monitor)) {
        std::cout << experiment.file << " quadrature " << hash(film) << '\n';
        print_flip(experiment, scene, film);
    }
    print_under_a_sky(experiment);
}

/// 24 pixels across, at most 16 samples.
[[maybe_unused]] void make_small(Experiment& e) {
    e.image.height = std::max(1, e.image.height * 24 / e.image.width);
    e.image.width = 24;
    for (ArmPlan& arm : e.arms) {
        std::erase_if(arm.n, [](std::uint64_t n) { return n > 16; });
        if (arm.n.empty()) arm.n = {16};
    }
}

void print_what_stdin_has() {
    plain::Reader reader{std::cin};
    while (std::cin.peek() != std::char_traits<char>::eof()) {
        Experiment experiment;
        plain::visit(reader, experiment);
        print(experiment);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const std::string mode = argc > 1 ? argv[1] : "";
    if (mode != "--plain") print_functions();
    if (argc == 1) print_what_stdin_has();
#ifndef CRESCENT_NO_FILESYSTEM
    const bool small = mode == "--plain" || mode == "--fewer";
    for (int k = small ? 2 : 1; k < argc; ++k) {
        Experiment experiment = load(argv[k]);
        if (small) make_small(experiment);
        plain::Writer writer{std::cout};
        mode == "--plain" ? plain::visit(writer, experiment) : print(experiment);
    }
#endif
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
}
