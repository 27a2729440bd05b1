// A combination and its parts are each made once, also if several combinations share a part.
#include "experiment/combinations.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "render/combination.h"

namespace crescent::inline experiment {

namespace {

/// The combinations of an experiment and the parts that they share, each made once.
class Combinations {
public:
    Combinations(const Experiment& experiment, ExternalSamplers& samplers)
        : experiment_(experiment), samplers_(samplers) {}

    void add_all() {
        for (const ArmPlan& arm : experiment_.arms)
            if (arm.is_combination()) samplers_[arm.name] = of(arm);
    }

private:
    std::shared_ptr<const Combination> of(const ArmPlan& arm) {
        std::shared_ptr<const Combination>& known = combinations_[arm.name];
        if (known) return known;
        const std::string path = "arms." + arm.name;
        Techniques parts;
        for (const std::string& name : arm.combination.of) parts.push_back(part(arm, name, "of"));
        const std::optional<std::string>& target = arm.combination.target;
        const bool own_target = target && *target != target_product && *target != target_brdf;
        known = std::make_shared<Combination>(arm.name, arm.combination, std::move(parts),
            own_target ? part(arm, *target, "target") : nullptr, experiment_.place_of(path + ".weights"),
            experiment_.place_of(path + ".probabilities"), weight_function(arm, path));
        return known;
    }

    std::shared_ptr<const ExternalSampler> weight_function(const ArmPlan& arm, const std::string& path) const {
        if (!arm.combination.weights_python) return nullptr;
        if (const auto given = samplers_.find(arm.name); given != samplers_.end() && given->second->has_weights())
            return given->second;
        throw InputError(experiment_.place_of(path + ".weights_python"),
            fmt::format("{}.weights_python: expected a run in Python (crescent.run): the program cannot call '{}'",
                path, *arm.combination.weights_python));
    }

    std::shared_ptr<const Technique> part(const ArmPlan& owner, const std::string& name, const char* key) {
        const ArmPlan* arm = experiment_.find_arm(name);
        if (arm && arm->is_combination()) {
            std::shared_ptr<const Technique> technique = of(*arm)->technique();
            ensure(technique != nullptr, "the parser lets only combinations with a density through");
            return technique;
        }
        if (arm && arm->is_external()) {
            try {
                return external_technique(samplers_.at(name));
            } catch (const OutputError& error) {
                const std::string path = fmt::format("arms.{}.{}", owner.name, key);
                throw InputError(experiment_.place_of(path), fmt::format("{}: {}", path, error.what()));
            }
        }
        return built_in_technique(arm ? arm->sampler : name);
    }

    const Experiment& experiment_;
    ExternalSamplers& samplers_;
    std::map<std::string, std::shared_ptr<const Combination>> combinations_;
};

}  // namespace

void add_combinations(const Experiment& experiment, ExternalSamplers& samplers) {
    Combinations(experiment, samplers).add_all();
}

}  // namespace crescent::inline experiment
