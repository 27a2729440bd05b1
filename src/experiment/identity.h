// The identity of an experiment: a text with each of its values, and the hash of that text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "experiment/experiment.h"

namespace crescent {

/// Returns a text as a string of TOML, in quotes.
std::string toml_text(std::string_view text);

/// Returns the experiment as a file that is read as the same experiment: every key with its effective value, in one
/// layout.
std::string canonical_text(const Experiment& experiment);
/// Returns the identity of an experiment: XXH3 of every value but the number of seeds and, in place of their paths, of
/// the published figures, the meshes with their textures and the sky, and of the contents of the files of samplers
/// (input_files.h).
/// Computed at each call, so that it is right for an experiment that was made or changed in code.
std::uint64_t hash(const Experiment& experiment);

}  // namespace crescent
