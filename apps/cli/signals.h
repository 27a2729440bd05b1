// Ctrl-C and SIGTERM.
#pragma once

namespace crescent {
class ProgressMonitor;
}

namespace crescent::cli {

/// From here on SIGINT, SIGTERM and SIGHUP end the process at once with 130; SIGHUP is ignored if it was (nohup).
void end_on_signals();

/// While it exists, the first SIGINT, SIGTERM or SIGHUP sets monitor.stop; 0.5 s later (5 s if outputs are being moved
/// to their places), or on a second signal, the process ends at once with 130. This leaves either all previous outputs
/// or all outputs of this run; the last message states which.
class StopOnSignal {
public:
    explicit StopOnSignal(ProgressMonitor& monitor);
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;
};

}  // namespace crescent::cli
