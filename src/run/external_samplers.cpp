// A program (check/sources/pipe.h) has no limit to the whole; a library is opened by check/sources/plugin.h. A wrapper
// around either puts the arm's name into what it throws.
#include "run/external_samplers.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <vector>

#include "base/errors.h"
#include "check/sources/copies.h"
#include "check/sources/external.h"
#include "check/sources/pipe.h"
#include "check/sources/plugin.h"
#include "experiment/combinations.h"
#include "experiment/experiment.h"

namespace crescent {

namespace {

/// The sampler of an arm, which its errors name.
std::shared_ptr<const SamplerAdapter> named_arm(const std::string& arm, std::shared_ptr<const SamplerAdapter> sampler) {
    return std::make_shared<DecoratedSampler>(
        std::move(sampler), [arm](const SamplerAdapter& inner, const SamplerQuery& query, const SamplerAnswers& out) {
            try {
                inner.evaluate(query, out);
            } catch (const SamplerError& fault) {
                throw OutputError(fmt::format("the arm '{}' terminated: {}", arm, fault.what()));
            }
        });
}

/// An estimate divides f cos by the density of the drawn direction: a sampler without one cannot be used as an arm.
void refuse(const Traits& traits) {
    if (traits.domain)
        throw OutputError(
            fmt::format("it draws points of {}, and an arm draws directions", traits.domain->domain().name()));
    if (traits.delta) throw OutputError("it has delta parts, which have no density to divide by");
    if (!traits.has_pdf) throw OutputError("it has no pdf to divide by");
}

std::shared_ptr<const SamplerAdapter> open(const ArmPlan& arm, const Experiment& experiment, const PipeLimits& limits) {
    try {
        if (arm.plugin) return open_plugin(*arm.plugin, limits);
        const auto copies = std::make_shared<Copies>(
            [arm, limits] {
                return arm.exec ? start_pipe(*arm.exec, limits) : start_python_sampler(*arm.python, limits);
            },
            std::numeric_limits<std::size_t>::max());
        refuse(copies->traits());
        return copies;
    } catch (const InputError& error) {
        if (arm.plugin) throw;
        const std::string key = fmt::format("arms.{}.{}", arm.name, arm.exec ? "exec" : "python");
        const std::string what =
            arm.exec ? fmt::format("the shell cannot start '{}'", *arm.exec) : error.diagnostics().front().message;
        throw InputError(experiment.place_of(key), fmt::format("{}: {}", key, what));
    } catch (const std::runtime_error& fault) {  // OutputError, SamplerError
        throw OutputError(fmt::format("the arm '{}' does not start: {}", arm.name, fault.what()));
    }
}

}  // namespace

ExternalSamplers open_external(const Experiment& experiment, double timeout_s, ExternalSamplers samplers) {
    PipeLimits limits;
    limits.total_seconds = std::numeric_limits<double>::infinity();
    limits.limit_answers(timeout_s);
    for (const ArmPlan& arm : experiment.arms)
        if (arm.is_external() && !samplers.contains(arm.name))
            samplers[arm.name] = named_arm(arm.name, open(arm, experiment, limits));
    add_combinations(experiment, samplers);
    return samplers;
}

bool may_change(const Experiment& experiment) {
    return std::ranges::any_of(
        experiment.arms, [](const ArmPlan& arm) { return arm.exec || arm.python || arm.combination.weights_python; });
}

}  // namespace crescent
