// Vectorised Python callables as a sampler, of a check or of an experiment's arm. They are called in batches, by any
// thread, with the interpreter's lock held only for the call:
//
//   sample(wo[n,3], u[n,k]) -> (wi[n,3], pdf[n], weight[n,c] or None, delta[n] or None)
//   pdf(wo[n,3], wi[n,3])   -> [n]
//   f(wo[n,3], wi[n,3])     -> [n] or [n,3], without the cosine
//   weights(wo[n,3], wi[n,3], context) -> [n,K], of the K samplers of a combination, with their densities `p` in
//   context
//
// Input arrays are of doubles, their columns contiguous; crescent/_arrays.py brings output arrays to these shapes. In a
// run they take the context of the rows as a third argument (scene_context.h).
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "watched.h"

namespace crescent::python {

struct Callables {
    std::string name;
    nb::object sample, pdf, f;  // pdf and f may be None
    nb::object weights{};       // of a combination, in place of sampling; or None
    Traits traits{};
    std::set<std::string> uses{};  // of context_names()
    bool weighs = false;           // sample returns weights
    bool upper_only = false;       // pdf and f are 0 below the surface, for any result of the callables there
    bool serial = false;           // they require one thread, the caller's own
    EvaluationDevice device{};
};

/// What a callable raises stops the work and is raised again at its end.
class CallableSampler : public BatchSampler {
public:
    explicit CallableSampler(Callables callables);
    SamplerDeclaration declaration() const override { return declaration_; }
    QueryUsage spending() const override { return {answers_.load(std::memory_order_relaxed), 0, 0}; }

    /// Receives exceptions of the callables; only during a check or a run.
    void set_raised(Raised* raised) const { raised_ = raised; }
    /// Returns the draws of the callables since this object was created.
    std::uint64_t draws() const { return draws_; }

private:
    Callables c_;
    SamplerDeclaration declaration_;  // readable without the lock
    mutable Raised* raised_ = nullptr;
    mutable std::atomic<std::uint64_t> answers_{0}, draws_{0};

    template <class Take> void call(const nb::object& callable, const SamplerQuery& query, Take&& take) const;
    void draw_rows(const SamplerQuery& query, std::span<Draw> out) const override;
    void pdf_rows(const SamplerQuery& query, std::span<double> out) const override;
    void f_rows(const SamplerQuery& query, std::span<double> out) const override;
    void f_rows_by_channel(const SamplerQuery& query, std::span<Vec3d> out) const override;
    void weight_rows(const SamplerQuery& query, std::span<double> out) const override;
};

/// (arm, draw, pdf, weights, numbers, uses, serial) of each arm whose sampler, or whose weights, are a callable.
using CallableArms =
    std::vector<std::tuple<std::string, nb::object, nb::object, nb::object, int, std::vector<std::string>, bool>>;

/// The samplers of these arms.
std::map<std::string, std::shared_ptr<const CallableSampler>> samplers_of(const CallableArms& callables);

}  // namespace crescent::python
