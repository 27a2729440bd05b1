// A first look at an experiment, before any arm is run: its reference with the boxes that it names.
#pragma once

#include <vector>

#include "base/progress.h"
#include "run/execute.h"

namespace crescent::inline runs {

/// The experiment's quadrature at its own s, 1280x720 as the plates, regions and crops on it, between rulers of pixels:
/// the bytes of a PNG. No arm is run, and no program or library of one is started. Throws InputError where nothing is
/// in view, OutputError where memory or the font is missing, Interrupted where the monitor says so.
std::vector<unsigned char> preview(const Experiment& experiment, const Engine& engine, ProgressMonitor& monitor);

}  // namespace crescent::inline runs
