// The finished part of a long run, kept in OUT/.crescent-kept while it lasts, so that the same command resumes a
// stopped or killed run: tiles of long passes, and the metrics of finished passes. Removed once the outputs are
// published.
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
    /// other than the experiment and the build, such as the back end and the seeds. Logs if there is a checkpoint to
    /// resume from.
    Checkpoint(const Experiment& experiment, const std::string& work, const std::string& out, double checkpoint_after_s,
        ProgressMonitor& monitor);
    /// If the run ends before discard(), logs what is kept.
    ~Checkpoint();
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// Returns the checkpoint for the tiles of one pass; `name`, or what the job computes, distinguishes it from the
    /// run's others.
    TileCheckpoint tiles(const std::string& name);
    TileCheckpoint tiles(const Job& job);
    /// Returns the metrics of a finished pass, one per sample count; none if it is not finished.
    std::vector<RunMetrics> metrics(const Job& job) const;
    void add(const std::vector<RunMetrics>& metrics);
    /// Called when the outputs are published: nothing of this run is needed any more. What another run kept stays and
    /// is logged.
    void discard();

private:
    std::string all_, key_, folder_;  // all_: for every run into the same place
    double checkpoint_after_s_;
    ProgressMonitor& monitor_;
    Stopwatch start_;
    Journal journal_;
    std::vector<RunMetrics> metrics_;
    std::size_t written_ = 0;  // of metrics_
};

}  // namespace crescent::inline runs
