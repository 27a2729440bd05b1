// Vectorised Python callables as a sampler for the check. They are called in batches, by any thread, with the
// interpreter's lock held only for the call:
//
//
//   sample(wo[n,3], u[n,k]) -> (wi[n,3], pdf[n], weight[n,c] or None, delta[n] or None)
//   pdf(wo[n,3], wi[n,3])   -> [n]
//   f(wo[n,3], wi[n,3])     -> [n] or [n,3], without the cosine
//
// Input arrays are of doubles, their columns contiguous; crescent/_arrays.py brings output arrays to these shapes.
#pragma once

#include "watched.h"

namespace crescent::python {

struct Callables {
    std::string name;
    nb::object sample, pdf, f;  // pdf and f may be None
    Traits traits;
    bool weighs = false;      // sample returns weights
    bool upper_only = false;  // pdf and f are 0 below the surface, for any result of the callables there
    bool serial = false;      // they require one thread
    EvaluationDevice device{};
};

class CallableSampler : public InProcessAdapter {
public:
    explicit CallableSampler(Callables callables) : c_(std::move(callables)) {}
    std::string name() const override { return c_.name; }
    Traits traits() const override { return c_.traits; }
    bool serial() const override { return c_.serial; }
    EvaluationDevice device() const override { return c_.device; }
    bool has_f() const override { return !c_.f.is_none(); }
    bool has_drawn_f() const override { return has_f() || c_.weighs; }
    void sample(int technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override;
    void pdf(int technique, std::span<const Pair> at, std::span<double> out) const override;
    void f(std::span<const Pair> at, std::span<double> out) const override;
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override;

    /// Receives exceptions of the callables; only during a check.
    void set_raised(Raised* raised) const { raised_ = raised; }
    /// Returns the draws of the callables since this object was created.
    std::uint64_t draws() const { return draws_; }

private:
    Callables c_;
    mutable Raised* raised_ = nullptr;
    mutable std::atomic<std::uint64_t> draws_{0};
    template <class Ask> void ask(Ask&& ask) const;
};

}  // namespace crescent::python
