// The metrics of the finished passes of a long run, kept in OUT/.crescent-kept while it lasts, so that the same command
// resumes a stopped or killed run. References and the films of the first seed are computed again. Removed once the
// outputs are published.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "metrics/metrics.h"
#include "run/plan.h"

namespace crescent {

class Checkpoint {
public:
    /// Outputs go to `out`; nothing is kept before `checkpoint_after_s` seconds. `work`: what the results depend on
    /// other than the experiment and the build, such as the back end and the seeds. Logs if there is a checkpoint to
    /// resume from. Throws OutputError if its folder is a link.
    Checkpoint(const Experiment& experiment, const std::string& work, const std::string& out, double checkpoint_after_s,
        ProgressMonitor& monitor);
    /// If the run ends before discard(), logs what is kept.
    ~Checkpoint();
    Checkpoint(const Checkpoint&) = delete;
    Checkpoint& operator=(const Checkpoint&) = delete;

    /// Returns the metrics of a finished pass, one per sample count; none if it is not finished.
    std::vector<RunMetrics> metrics(const Job& job) const;
    /// If they cannot be written, the run goes on: a line is logged, and nothing more is kept.
    void add(const std::vector<RunMetrics>& metrics);
    /// Called when the outputs are published: nothing of this run is needed any more. What another run kept stays and
    /// is logged.
    void discard();

private:
    void read(const Experiment& experiment);

    std::string folder_, key_, file_;  // the folder is shared by every run into the same place
    double checkpoint_after_s_;
    ProgressMonitor& monitor_;
    Stopwatch start_;
    bool has_key_ = false, is_disabled_ = false;  // the file has the key; it cannot be written
    std::vector<RunMetrics> metrics_;
    std::size_t stored_count_ = 0;  // of metrics_
};

}  // namespace crescent
