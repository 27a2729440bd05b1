// Arms that combine samplers: how they are read and checked, and the samplers that they are.
#pragma once

#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/parser.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// The word for a sampler that is no sampler of its own but the combination a renderer uses in the scene.
inline constexpr const char* renderer_word = "renderer";
/// Returns the words of the key 'sampler'.
std::vector<std::string> sampler_words();
/// Makes each arm with that word the combination of `material` with a sampler for each kind of light of the scene;
/// under a fill alone, `material`. After shapes, meshes and lights were read.
void expand_renderers(ParseContext& context);

/// Reports every mistake in an arm with a kind: after names and shapes were read.
void check_combinations(ParseContext& context);

/// Adds the combinations of an experiment to its external samplers, which must be there already. Throws InputError.
void add_combinations(const Experiment& experiment, ExternalSamplers& samplers);

}  // namespace crescent
