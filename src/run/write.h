// Last step of a run: what was measured -> plates, films and reports in one folder, which appear as one.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "render/exr.h"
#include "run/collect.h"

namespace crescent::inline base {
class Staging;
}

namespace crescent::inline runs {

/// "metrics,report" -> those alone. Throws InputError, which names the nearest word, for any other word.
OutputParts output_parts(const std::string& words);

/// The names that a run of this plan writes `parts` under, about: references that are not asked for and SVGs apart.
std::vector<std::string> outputs_of(const RunPlan& plan, const OutputParts& parts);

/// Every plate of the experiment, on as many threads as on_threads() allows. Throws OutputError where the font is
/// missing, Interrupted where the monitor says so.
Plates draw_plates(const Measured& measured, const ProgressMonitor& monitor);

/// What a run says of itself in the header of a film or a picture: (name, text).
Attributes attributes_of(const Measured& measured);

/// Judges the assertions again, those on plates too, and writes `parts` and timing.json under `folder`, whose earlier
/// outputs go. False where the monitor stopped it: nothing has changed there then.
bool write(Measured& measured, const std::string& folder, ProgressMonitor& monitor, const OutputParts& parts = {},
    int threads = 0);
/// The same into a stage, which the caller commits; may throw Interrupted.
void write(Measured& measured, Staging& staging, ProgressMonitor& monitor, const OutputParts& parts);

/// What the numbers stand beside in reports.
ReportInputs report_inputs(const Measured& measured);

}  // namespace crescent::inline runs
