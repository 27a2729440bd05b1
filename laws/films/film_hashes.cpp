// film_hashes FILE.toml...: the hash of every film of an experiment at its own seed, for each instruction set of this
// machine, and of its references, and of the functions of math/. Two builds of crescent agree where this prints the same; it needs none of the folders
// that draw and report, so that a second compiler has little to build.
#include <xxhash.h>

#include <iostream>

#include "estimator/estimator.h"
#include "estimator/reference.h"
#include "experiment/experiment.h"
#include "math/functions.h"

namespace {

using namespace crescent;

/// The bits of f over an even sweep of [a, b].
template <class Function> void print_function(const char* name, Function f, double a, double b) {
    std::vector<double> values;
    constexpr int count = 4096;
    for (int k = 0; k <= count; ++k) values.push_back(f(a + (b - a) * k / count));
    std::cout << "function " << name << ' ' << std::hex << XXH3_64bits(values.data(), values.size() * sizeof(double)) << std::dec << '\n';
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

void print(const std::string& file) {
    const Experiment experiment = load(file);
    const Scene scene(experiment);
    Watch watch;
    for (const std::string& isa : isas())
        for (const ArmPlan& arm : experiment.arms)
            for (const Film& film : estimate_films(scene, arm.sampler, arm.n, experiment.seed, isa, watch))
                std::cout << file << ' ' << isa << ' ' << arm.name << " n=" << film.n << ' ' << hash(film) << '\n';
    for (const std::string& isa : isas())
        for (const ReferenceFilm& film : note_reference(scene, {experiment.s()}, isa, watch))
            std::cout << file << ' ' << isa << " note-reference " << hash(film) << '\n';
    for (const ReferenceFilm& film : quadrature_reference(scene, {experiment.s()}, watch))
        std::cout << file << " quadrature " << hash(film) << '\n';
}

}  // namespace

int main(int argc, char** argv) try {
    print_functions();
    for (int k = 1; k < argc; ++k) print(argv[k]);
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
}
