// A file is read each time it is hashed, because it may change between two runs of one process.
#include "experiment/sampler_files.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/errors.h"
#include "base/files.h"

namespace crescent::inline experiment {

std::string_view python_file(std::string_view sampler) {
    if (sampler.ends_with(".py")) return sampler;
    const std::string_view file = sampler.substr(0, sampler.rfind(':'));
    return file.ends_with(".py") ? file : std::string_view{};
}

std::string sampler_file(const ArmPlan& arm) {
    if (arm.plugin) return *arm.plugin;
    const std::optional<std::string>& python = arm.python ? arm.python : arm.combination.weights_python;
    return python ? std::string(python_file(*python)) : std::string{};
}

std::string sampler_file_hashes(const Experiment& experiment) {
    std::string all;
    for (const ArmPlan& arm : experiment.arms) {
        const std::string file = sampler_file(arm);
        if (file.empty()) continue;
        const std::string bytes = contents_of(file);
        all += fmt::format(" {}={:016x}", arm.name, bytes.empty() ? 0 : XXH3_64bits(bytes.data(), bytes.size()));
    }
    return all;
}

void refuse_code(const Experiment& experiment) {
    std::vector<Diagnostic> found;
    for (const ArmPlan& arm : experiment.arms) {
        const std::optional<std::string>& weights = arm.combination.weights_python;
        if (!arm.is_external() && !weights) continue;
        const char* key = arm.exec ? "exec" : arm.plugin ? "plugin" : arm.python ? "python" : "weights_python";
        const std::string path = fmt::format("arms.{}.{}", arm.name, key);
        found.push_back({experiment.place_of(path),
            fmt::format("{}: with --no-code, expected a built-in sampler (key 'sampler'); found code to run: '{}'",
                path,
                arm.exec         ? *arm.exec
                    : arm.plugin ? *arm.plugin
                    : arm.python ? *arm.python
                                 : *weights)});
    }
    if (!found.empty()) throw InputError(std::move(found));
}

}  // namespace crescent::inline experiment
