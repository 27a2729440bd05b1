// noise FILE.toml: the noise of each arm of an experiment, as the root of the mean variance of its pixels (luminance,
// W/(sr m^2)).
#include <cmath>
#include <iostream>
#include <numeric>

#include <crescent/crescent.h>

int main(int argc, char** argv) try {
    const crescent::Experiment experiment = crescent::load(argc > 1 ? argv[1] : "experiment.toml");
    crescent::ProgressMonitor monitor;
    for (const crescent::ArmPlan& arm : experiment.arms)
        for (const crescent::Film& film :
            crescent::estimate_films(crescent::Scene(experiment), arm.sampler, arm.n, experiment.seed, "", monitor)) {
            const double sum = std::accumulate(film.var.begin(), film.var.end(), 0.0);
            std::cout << arm.name << " n=" << film.n << " noise " << std::sqrt(sum / static_cast<double>(film.size()))
                      << '\n';
        }
} catch (const crescent::InputError& e) {
    std::cerr << e.what() << '\n';
    return 2;
}
