// A preview of an experiment, before any arm is run: its reference with the boxes that it names.
#pragma once

#include <vector>

#include "base/progress.h"
#include "run/execute.h"

namespace crescent::inline runs {

/// Returns the experiment's quadrature at its own s, 1280x720 like the plates, with regions, crops and pixel rulers, as
/// the bytes of a PNG. No arm is run, and no program or library is started. Throws InputError if nothing is in view,
/// OutputError if memory or the font is missing, Interrupted if the monitor requests it.
std::vector<unsigned char> preview(const Experiment& experiment, const Engine& engine, ProgressMonitor& monitor);

}  // namespace crescent::inline runs
