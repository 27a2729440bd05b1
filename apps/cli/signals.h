// Ctrl-C and SIGTERM.
#pragma once

namespace crescent::inline base {
class ProgressMonitor;
}

namespace crescent::cli {

/// From here on SIGINT, SIGTERM and SIGHUP end the process at once with 130; SIGHUP not where it was ignored (nohup).
void end_on_signals();

/// While it lives, the first SIGINT, SIGTERM or SIGHUP sets monitor.stop; 0.5 s later (5 s where outputs are being
/// moved to their places), or on a second signal, the process ends at once with 130. Ending there leaves all outputs of
/// before, or all of this run; the last words say which.
class StopOnSignal {
public:
    explicit StopOnSignal(ProgressMonitor& monitor);
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;
};

}  // namespace crescent::cli
