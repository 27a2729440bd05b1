// An experiment of 8 x 6 pixels, which runs in milliseconds, and its measurements without tails and article checks.
#pragma once

#include <string>
#include <vector>

#include "run/collect.h"
#include "tests/support/test_scene.h"

namespace crescent::test {

/// Three arms, three seeds.
inline Experiment small_experiment(std::vector<std::string> more = {}) {
    std::vector<std::string> overrides{"image.width=8", "image.height=6", "regions.all.box=[0,0,7,5]", "seeds=3",
        "arms.uniform.n=[16]", "arms.cosine.n=[4,16]", "arms.phong.n=[4,16]"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return small_scene(overrides);
}

/// Runs the jobs of a part of its seeds, films of the first seed included.
inline Measured measured(const Experiment& experiment, SeedRange range = {}) {
    ProgressMonitor monitor;
    const RunPlan part = plan(experiment, range);
    Prepared prepared = prepare(part, {}, monitor);
    std::vector<JobResult> results;
    for (const Job& job : part.jobs)
        results.push_back(execute(part, prepared, job, {}, monitor, job.seed == part.seeds[0]));
    return collect(part, std::move(prepared), std::move(results), {}, monitor, {.command = "test", .studies = false});
}

}  // namespace crescent::test
