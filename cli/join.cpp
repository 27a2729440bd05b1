// crescent join: parts of one experiment -> the metrics of the run of all their seeds.
#include "commands.h"
#include "crescent.h"

namespace crescent::cli {

int join(const JoinFlags& flags) {
    std::string command = "crescent join";
    for (const std::string& part : flags.parts) command += " " + shell_word(part);
    const Measured joined = crescent::join(flags.parts, command);
    ProgressMonitor monitor;
    write_metrics(joined, flags.out, monitor);
    print(terminal_summary(report_inputs(joined), {}, flags.out, {true, false, false, false}));
    return joined.metrics.all_hold() ? held : failed;
}

}  // namespace crescent::cli
