// The flags of `check` whose value is a sampler: --exec, --plugin.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "commands.h"

namespace crescent::cli {

/// What a sampler is opened with.
struct OpenOptions {
    PipeLimits limits;
    std::optional<Domain> domain{};  // of a sampler that states none
    int neighbours = default_neighbours;
};

struct SamplerFlag {
    const char *name, *type, *purpose;      // --NAME TYPE
    bool is_file;                           // no output may replace it
    bool is_limited;                        // it takes --patience and --accept-few
    bool (*fits)(const std::string& word);  // whether --against WORD opens it, without a flag
    std::shared_ptr<const SamplerAdapter> (*open)(const std::string& value, const OpenOptions& options);
};
/// A new source of samplers is a file in src/check/sources, and a row here.
std::span<const SamplerFlag> sampler_flags();

/// The flag that is given; null: none.
const SamplerFlag* given_flag(const CheckFlags& flags);

}  // namespace crescent::cli
