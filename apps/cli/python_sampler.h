// Samplers in Python files: `crescent check mine.py:sampler`.
#pragma once

#include <memory>
#include <string>

#include "crescent/crescent.h"

namespace crescent::cli {

/// Whether the word is FILE.py, FILE.py:NAME or module:NAME.
bool names_python_sampler(const std::string& word);

/// Starts the Python interpreter with crescent.serve, which answers for this sampler over a pipe. The interpreter is
/// CRESCENT_PYTHON, which the installed command sets to its own, or else python3. Throws InputError if the sampler
/// cannot be loaded, OutputError if the interpreter or the package is missing.
std::shared_ptr<const SamplerAdapter> start_python_sampler(const std::string& word, const PipeLimits& limits);

}  // namespace crescent::cli
