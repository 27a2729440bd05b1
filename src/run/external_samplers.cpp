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

/// What it throws names the arm.
class Named : public ExternalSampler {
public:
    Named(std::string arm, std::shared_ptr<const ExternalSampler> sampler)
        : arm_(std::move(arm)), of_(std::move(sampler)) {}
    std::string name() const override { return of_->name(); }
    int numbers() const override { return of_->numbers(); }
    std::size_t batch_rows() const override { return of_->batch_rows(); }
    bool uses_lights() const override { return of_->uses_lights(); }
    void draw(const ExternalBatch& batch, const ExternalDraws& out) const override {
        named([&] { of_->draw(batch, out); });
    }
    bool has_density() const override { return of_->has_density(); }
    void density(const ExternalBatch& batch, std::span<const Vec3d> wi, std::span<double> out) const override {
        named([&] { of_->density(batch, wi, out); });
    }

private:
    template <class Call> void named(Call&& call) const {
        try {
            call();
        } catch (const SamplerError& fault) {
            throw OutputError(fmt::format("the arm '{}' terminated: {}", arm_, fault.what()));
        }
    }

    std::string arm_;
    std::shared_ptr<const ExternalSampler> of_;
};

/// Copies of a program, each a process that answers one batch at a time. Another one starts when a batch finds all of
/// them at work, one for each thread at most.
class Copies : public ExternalSampler {
public:
    using Start = std::function<std::shared_ptr<const ProgramSampler>()>;
    explicit Copies(Start start) : start_(std::move(start)), first_(start_()), free_{first_} {}
    std::string name() const override { return first_->name(); }
    int numbers() const override { return first_->numbers(); }
    std::size_t batch_rows() const override { return first_->batch_rows(); }
    bool uses_lights() const override { return first_->uses_lights(); }
    bool has_density() const override { return first_->has_density(); }
    Traits traits() const { return first_->traits(); }
    void draw(const ExternalBatch& batch, const ExternalDraws& out) const override { Taken(*this)->draw(batch, out); }
    void density(const ExternalBatch& batch, std::span<const Vec3d> wi, std::span<double> out) const override {
        Taken(*this)->density(batch, wi, out);
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
        const ProgramSampler* operator->() const { return program_.get(); }

    private:
        const Copies& from_;
        std::shared_ptr<const ProgramSampler> program_;
    };

    std::shared_ptr<const ProgramSampler> take() const {
        {
            const std::lock_guard<std::mutex> guard(lock_);
            if (!free_.empty()) {
                std::shared_ptr<const ProgramSampler> program = std::move(free_.back());
                free_.pop_back();
                return program;
            }
        }
        return start_();
    }

    Start start_;
    std::shared_ptr<const ProgramSampler> first_;
    mutable std::mutex lock_;
    mutable std::vector<std::shared_ptr<const ProgramSampler>> free_;
};

/// An estimate divides f cos by the density of the drawn direction: a sampler without one cannot be used as an arm.
void refuse(const Traits& traits) {
    if (traits.domain)
        throw OutputError(
            fmt::format("it draws points of {}, and an arm draws directions", traits.domain->domain().name()));
    if (traits.delta) throw OutputError("it has delta parts, which have no density to divide by");
    if (!traits.has_pdf) throw OutputError("it has no pdf to divide by");
}

std::shared_ptr<const ExternalSampler> open(
    const ArmPlan& arm, const Experiment& experiment, const PipeLimits& limits) {
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
            given[arm.name] = std::make_shared<Named>(arm.name, open(arm, experiment, limits));
    add_combinations(experiment, given);
    return given;
}

bool may_change(const Experiment& experiment) {
    return std::ranges::any_of(
        experiment.arms, [](const ArmPlan& arm) { return arm.exec || arm.python || arm.combination.weights_python; });
}

}  // namespace crescent
