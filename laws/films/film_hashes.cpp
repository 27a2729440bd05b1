// film_hashes FILE.toml...: the hash of every film of an experiment at its own seed, for each instruction set of this
// machine, and of its references. Two builds of crescent agree where this prints the same; it needs none of the folders
// that draw and report, so that a second compiler has little to build.
#include <iostream>

#include "estimator/estimator.h"
#include "estimator/reference.h"
#include "experiment/experiment.h"

namespace {

using namespace crescent;

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
    for (int k = 1; k < argc; ++k) print(argv[k]);
} catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
}
