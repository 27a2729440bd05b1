// samplers/pipe.h communicates with a program, one query after another under a lock and without a total limit;
// samplers/plugin.h opens a library. A wrapper around either adds the arm's name to exceptions.
#include "run/external_samplers.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <mutex>

#include "base/errors.h"
#include "check/sources/pipe.h"
#include "check/sources/plugin.h"

namespace crescent::inline runs {

namespace {

/// A program answers one query after another.
class Program : public ExternalSampler {
public:
    explicit Program(std::shared_ptr<const SamplerAdapter> program) : program_(std::move(program)) {}
    std::string name() const override { return program_->name(); }
    int numbers() const override { return program_->traits().numbers; }
    void draw(const ExternalBatch& batch, const ExternalDraws& out) const override {
        const auto count = static_cast<std::size_t>(numbers());
        std::size_t first = 0;
        for (const ExternalRun& run : batch.runs) {
            std::vector<PrimarySample> u(run.rows);
            for (std::size_t i = 0; i < run.rows; ++i)
                for (std::size_t k = 0; k < count; ++k) u[i][static_cast<int>(k)] = batch.u[(first + i) * count + k];
            std::vector<Draw> draws(run.rows);
            {
                const std::lock_guard<std::mutex> one_at_a_time(lock_);
                program_->sample(0, run.wo, u, draws);
            }
            for (std::size_t i = 0; i < run.rows; ++i)
                out.wi[first + i] = draws[i].wi, out.pdf[first + i] = draws[i].pdf;
            first += run.rows;
        }
    }
    bool has_density() const override { return program_->traits().has_pdf; }
    void density(
        Vec3d wo, const ExternalSurface& /*surface*/, std::span<const Vec3d> wi, std::span<double> out) const override {
        std::vector<Pair> at;
        for (const Vec3d& w : wi) at.push_back({wo, w});
        const std::lock_guard<std::mutex> one_at_a_time(lock_);
        program_->pdf(0, at, out);
    }

private:
    std::shared_ptr<const SamplerAdapter> program_;
    mutable std::mutex lock_;
};

/// Adds the arm's name to exceptions.
class Named : public ExternalSampler {
public:
    Named(std::string arm, std::shared_ptr<const ExternalSampler> of) : arm_(std::move(arm)), of_(std::move(of)) {}
    std::string name() const override { return of_->name(); }
    int numbers() const override { return of_->numbers(); }
    void draw(const ExternalBatch& batch, const ExternalDraws& out) const override {
        named([&] { of_->draw(batch, out); });
    }
    bool has_density() const override { return of_->has_density(); }
    void density(
        Vec3d wo, const ExternalSurface& surface, std::span<const Vec3d> wi, std::span<double> out) const override {
        named([&] { of_->density(wo, surface, wi, out); });
    }

private:
    template <class Call> void named(Call&& call) const {
        try {
            call();
        } catch (const SamplerError& fault) {
            throw OutputError(fmt::format("the arm '{}' broke off: {}", arm_, fault.what()));
        }
    }

    std::string arm_;
    std::shared_ptr<const ExternalSampler> of_;
};

/// An estimate divides f cos by the density of the draw: a sampler without one cannot be used as an arm.
void refuse(const Traits& traits) {
    if (traits.delta) throw OutputError("it has delta parts, which have no density to divide by");
    if (!traits.has_pdf) throw OutputError("it has no pdf to divide by");
}

std::shared_ptr<const ExternalSampler> open(
    const ArmPlan& arm, const Experiment& experiment, const PipeLimits& limits) {
    try {
        if (arm.plugin) return open_plugin(*arm.plugin, limits);
        std::shared_ptr<const SamplerAdapter> program = start_pipe(*arm.exec, limits);
        refuse(program->traits());
        return std::make_shared<Program>(std::move(program));
    } catch (const InputError&) {
        if (!arm.exec) throw;
        const std::string key = fmt::format("arms.{}.exec", arm.name);
        throw InputError(experiment.place_of(key), fmt::format("{}: the shell cannot start '{}'", key, *arm.exec));
    } catch (const std::runtime_error& fault) {  // OutputError, SamplerError
        throw OutputError(fmt::format("the arm '{}' does not start: {}", arm.name, fault.what()));
    }
}

}  // namespace

ExternalSamplers open_external(const Experiment& experiment, double timeout_s) {
    PipeLimits limits;
    limits.total_seconds = std::numeric_limits<double>::infinity();
    limits.limit_answers(timeout_s);
    ExternalSamplers all;
    for (const ArmPlan& arm : experiment.arms)
        if (arm.exec || arm.plugin) all[arm.name] = std::make_shared<Named>(arm.name, open(arm, experiment, limits));
    return all;
}

std::string marks_of(const Experiment& experiment) {
    std::string all;
    for (const ArmPlan& arm : experiment.arms)
        if (arm.plugin) all += fmt::format(" {}={:016x}", arm.name, plugin_mark(*arm.plugin));
    return all;
}

bool may_change(const Experiment& experiment) {
    return std::ranges::any_of(experiment.arms, [](const ArmPlan& arm) { return arm.exec.has_value(); });
}

}  // namespace crescent::inline runs
