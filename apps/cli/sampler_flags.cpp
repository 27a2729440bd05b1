// The list of flags, in the order of the help.
#include "sampler_flags.h"

namespace crescent::cli {

std::span<const SamplerFlag> sampler_flags() {
    static const SamplerFlag flags[] = {
        {.name = "exec",
            .type = "'PROGRAM ARGS'",
            .purpose = "check a program that responds over a pipe",
            .is_file = false,
            .is_limited = true,
            .fits = [](const std::string&) { return false; },  // any command: tried last
            .open =
                [](const std::string& value, const OpenOptions& options) {
                    return start_pipe(value, options.limits, "", options.domain, options.neighbours);
                }},
        {.name = "plugin",
            .type = "FILE",
            .purpose = "check a shared library, see docs/plugins.md",
            .is_file = true,
            .is_limited = false,
            .fits = [](const std::string& word) { return word.ends_with(".so"); },
            .open = [](const std::string& value,
                        const OpenOptions& options) { return open_plugin(value, options.limits); }},
    };
    return flags;
}

const SamplerFlag* given_flag(const CheckFlags& flags) {
    for (const SamplerFlag& flag : sampler_flags())
        if (!flags.sampler_of(flag.name).empty()) return &flag;
    return nullptr;
}

}  // namespace crescent::cli
