// A sampler in a shared library with the C interface of sampler_plugin.h: checked by itself, or an arm of an
// experiment. A separate process (plugin_host.h), one for each calling thread, loads the library, so that changes to
// the process stay there.
#pragma once

#include <memory>
#include <string>

#include "check/sources/pipe.h"
#include "check/sources/sampler_adapter.h"
#include "samplers/external_sampler.h"

namespace crescent::inline sources {

/// As an arm it takes any surface point; a check uses one surface.
class PluginSampler : public ExternalSampler, public InProcessAdapter {
public:
    std::string name() const override = 0;
};

/// Opens the library at `path`; as a SamplerAdapter it is called on `surface`. Throws OutputError if the file is not
/// such a library, with what is missing, and SamplerError if it ends its process, throws or takes longer than
/// limits.call_seconds, here or in a later call.
std::shared_ptr<const PluginSampler> open_plugin(const std::string& path, const PipeLimits& limits = {},
    const ExternalSurface& surface = {32, 0.24253562503633297, 0.5, 0.5});

}  // namespace crescent::inline sources
