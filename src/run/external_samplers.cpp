// A program (check/sources/external.h) has no limit to the whole; a library is opened there too. A wrapper
// around either puts the arm's name into what it throws.
#include "run/execute.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <mutex>
#include <vector>

#include "base/errors.h"
#include "check/sources/external.h"
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

/// Copies of a program, each a process that answers one batch at a time. Another one starts when a batch finds all of
/// them at work, one for each thread at most.
class Copies : public SamplerAdapter {
public:
    using Start = std::function<std::shared_ptr<const SamplerAdapter>()>;
    explicit Copies(Start start) : start_(std::move(start)), first_(start_()), free_{first_} {}
    SamplerDeclaration declaration() const override {
        SamplerDeclaration out = first_->declaration();
        out.serial = false;
        return out;
    }
    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override {
        Taken(*this)->evaluate(query, out);
    }

private:
    /// A copy that no other thread uses meanwhile.
    class Taken {
    public:
        explicit Taken(const Copies& from) : from_(from), program_(from.take()) {}
        ~Taken() {
            const std::lock_guard<std::mutex> guard(from_.lock_);
            from_.free_.push_back(std::move(program_));
        }
        Taken(const Taken&) = delete;
        Taken& operator=(const Taken&) = delete;
        const SamplerAdapter* operator->() const { return program_.get(); }

    private:
        const Copies& from_;
        std::shared_ptr<const SamplerAdapter> program_;
    };

    std::shared_ptr<const SamplerAdapter> take() const {
        {
            const std::lock_guard<std::mutex> guard(lock_);
            if (!free_.empty()) {
                std::shared_ptr<const SamplerAdapter> program = std::move(free_.back());
                free_.pop_back();
                return program;
            }
        }
        return start_();
    }

    Start start_;
    std::shared_ptr<const SamplerAdapter> first_;
    mutable std::mutex lock_;
    mutable std::vector<std::shared_ptr<const SamplerAdapter>> free_;
};

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
        const auto copies = std::make_shared<Copies>([arm, limits] {
            return arm.exec ? start_pipe(*arm.exec, limits) : start_python_sampler(*arm.python, limits);
        });
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

ExternalSamplers open_external(const Experiment& experiment, double timeout_s, ExternalSamplers given) {
    PipeLimits limits;
    limits.total_seconds = std::numeric_limits<double>::infinity();
    limits.limit_answers(timeout_s);
    for (const ArmPlan& arm : experiment.arms)
        if (arm.is_external() && !given.contains(arm.name))
            given[arm.name] = named_arm(arm.name, open(arm, experiment, limits));
    add_combinations(experiment, given);
    return given;
}

bool may_change(const Experiment& experiment) {
    return std::ranges::any_of(
        experiment.arms, [](const ArmPlan& arm) { return arm.exec || arm.python || arm.combination.weights_python; });
}

}  // namespace crescent
