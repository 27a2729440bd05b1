// What a long run has finished, kept in OUT/.crescent-kept while it lasts, so that the same command goes on where a run
// was stopped or killed: tiles of passes that take long, and the metrics of finished passes. Gone once the outputs
// stand.
#pragma once

#include <string>
#include <vector>

#include "base/journal.h"
#include "base/progress.h"
#include "metrics/metrics.h"
#include "render/tiles.h"
#include "run/plan.h"

namespace crescent::inline runs {

class Checkpoint {
public:
    /// Outputs go to `out`; nothing is kept before `checkpoint_after_s` seconds. `work`: what the results depend on
    /// beside the experiment and the build, as the back end and the seeds.
    /// Says so where there is something to go on from.
    Checkpoint(const Experiment& experiment, const std::string& work, const std::string& out, double checkpoint_after_s,
        ProgressMonitor& monitor);
    /// Where the run ends before discard(): says what is kept.
    ~Checkpoint();
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// For the tiles of one pass; `name`, or what the job computes, tells it from the run's others.
    TileCheckpoint tiles(const std::string& name);
    TileCheckpoint tiles(const Job& job);
    /// The metrics of a finished pass, one a sample count; none where it is not finished.
    std::vector<RunMetrics> metrics(const Job& job) const;
    void add(const std::vector<RunMetrics>& metrics);
    /// The outputs stand: nothing of this run is needed any more. What another run kept stays, and is told of.
    void discard();

private:
    std::string all_, key_, folder_;  // all_: of any run into the same place
    double checkpoint_after_s_;
    ProgressMonitor& monitor_;
    Stopwatch start_;
    Journal journal_;
    std::vector<RunMetrics> metrics_;
    std::size_t written_ = 0;  // of metrics_
};

}  // namespace crescent::inline runs
