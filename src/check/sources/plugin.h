// A sampler in a shared library with the C interface of sampler_plugin.h: checked by itself, or an arm of an
// experiment. A separate process (plugin_host.h), one for each calling thread, loads the library, so that changes to
// the process stay there.
#pragma once

#include <memory>
#include <string>

#include "check/sources/external.h"
#include "samplers/sampler_adapter.h"
#include "samplers/surface_context.h"

namespace crescent {

/// Opens the library at `path`. A run asks it at the points of a scene, a check on `surface`. Throws OutputError if the
/// file is not such a library, with what is missing, and SamplerError if it ends its process, throws or takes longer
/// than limits.call_seconds, here or in a later call.
std::shared_ptr<const SamplerAdapter> open_plugin(const std::string& path, const PipeLimits& limits = {},
    const SurfaceParameters& surface = {.s = 32, .alpha = 0.24253562503633297, .diffuse = 0.5, .lobe = 0.5});

}  // namespace crescent
