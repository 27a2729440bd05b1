// The files of the samplers that an experiment names: shared libraries and Python files.
#pragma once

#include <string>
#include <string_view>

#include "experiment/experiment.h"

namespace crescent::inline experiment {

/// FILE.py of "FILE.py" and "FILE.py:NAME"; "" for "module:NAME".
std::string_view python_file(std::string_view sampler);

/// The file of an arm's sampler; "" if it has none: a built-in sampler, a program or an installed module.
std::string sampler_file(const ArmPlan& arm);

/// XXH3 of the content of each sampler's file, " ARM=HASH" in the experiment's order; 0 for a file that cannot
/// be read. Another content is another experiment under any name of the file.
std::string sampler_file_hashes(const Experiment& experiment);

/// Throws InputError with the place of each plugin, program and Python sampler that the experiment names.
void refuse_code(const Experiment& experiment);

}  // namespace crescent::inline experiment
