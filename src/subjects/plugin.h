// A sampler in a shared library with the C interface of sampler_plugin.h: judged by itself, or an arm of an experiment.
// What it throws is a SubjectFault. What ends the whole process there is told by whoever watches: plugin_call() says
// where a thread is.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "arms/outside.h"
#include "subjects/subject.h"

namespace crescent::inline subjects {

/// Drawn for any surface point as an arm; judged on one surface.
class PluginSampler : public OutsideSampler, public CalledSampler {
public:
    std::string name() const override = 0;
};

/// Opens the library at `path`; as a JudgedSampler it is asked on `surface`. Throws OutputError where the file is no
/// such library, with what is missing.
std::shared_ptr<const PluginSampler> open_plugin(
    const std::string& path, const OutsideSurface& surface = {32, 0.24253562503633297, 0.5, 0.5});

/// A call into a library: its path (null: none), what is called, and w_o of the first row, 0 where there is none.
struct PluginCall {
    const char* library = nullptr;
    const char* what = nullptr;
    Vec3d wo{};
};
/// The call that this thread is in; async-signal-safe.
PluginCall plugin_call() noexcept;
/// "lib.so: crescent_sampler_sample at w_o = (0, 0, 1)".
std::string to_string(const PluginCall& call);

/// XXH3 of the file: films of another library are other films.
std::uint64_t plugin_mark(const std::string& path);

}  // namespace crescent::inline subjects
