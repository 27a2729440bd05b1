// Last step of a run: writes plates, films and reports of the measurements into one folder, all at once.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "render/exr.h"
#include "run/collect.h"
#include "run/execute.h"

namespace crescent {
class Staging;
}

namespace crescent {

/// Parses "metrics,report" to those outputs only. Throws InputError with the nearest word for an unknown word.
OutputParts output_parts(const std::string& words);

/// Returns the names that a run of this plan writes `parts` under, without optional references and SVGs.
std::vector<std::string> outputs_of(const RunPlan& plan, const OutputParts& parts);

/// Draws every plate of the experiment, on as many threads as on_threads() allows. Throws OutputError if the font is
/// missing, Interrupted if the monitor requests it.
Plates draw_plates(const Measured& result, const ProgressMonitor& monitor);

/// Returns the attributes of a run for the header of a film or a picture: (name, text).
Attributes attributes_of(const Measured& result);

/// Checks the assertions again, including those on plates, and writes `parts` and timing.json under `folder`, whose
/// earlier outputs are removed. Returns false if the monitor stopped it; the folder is unchanged in this case.
bool write(Measured& result, const std::string& folder, ProgressMonitor& monitor, const OutputParts& parts = {},
    int threads = 0);
/// The same into a stage, which the caller commits; may throw Interrupted.
void write(Measured& result, Staging& staging, ProgressMonitor& monitor, const OutputParts& parts);

/// Returns the inputs of the reports.
ReportInputs report_inputs(const Measured& result);

// ---- A preview of an experiment, before any arm is run: its reference with the boxes that it names.

/// Returns the experiment's quadrature at its own s, 1280x720 like the plates, with regions, crops and pixel rulers, as
/// the bytes of a PNG. No arm is run, and no program or library is started. Throws InputError if nothing is in view,
/// OutputError if memory or the font is missing, Interrupted if the monitor requests it.
std::vector<unsigned char> preview(const Experiment& experiment, const Engine& engine, ProgressMonitor& monitor);

}  // namespace crescent
