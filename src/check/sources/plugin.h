// A sampler in a shared library with the C interface of sampler_plugin.h: checked by itself, or an arm of an
// experiment. The library is loaded by a process of its own (plugin_host.h), one for each thread that calls,
// where all that it does to its process stays.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "check/sources/pipe.h"
#include "check/sources/sampler_adapter.h"
#include "samplers/external_sampler.h"

namespace crescent::inline sources {

/// Drawn for any surface point as an arm; checked on one surface.
class PluginSampler : public ExternalSampler, public InProcessAdapter {
public:
    std::string name() const override = 0;
};

/// Opens the library at `path`; as a SamplerAdapter it is called on `surface`. Throws OutputError if the file is no
/// such library, with what is missing, and SamplerError if it ends its process, throws or takes longer than
/// limits.call_seconds, here or in a later call.
std::shared_ptr<const PluginSampler> open_plugin(const std::string& path, const PipeLimits& limits = {},
    const ExternalSurface& surface = {32, 0.24253562503633297, 0.5, 0.5});

/// XXH3 of the file: films of another library are other films.
std::uint64_t plugin_mark(const std::string& path);

}  // namespace crescent::inline sources
