// Vectorised Python callables as a sampler on case. They are asked in batches, by any thread, with the interpreter's
// lock held for the call alone:
//
//   sample(wo[n,3], u[n,k]) -> (wi[n,3], pdf[n], weight[n,c] or None, delta[n] or None)
//   pdf(wo[n,3], wi[n,3])   -> [n]
//   f(wo[n,3], wi[n,3])     -> [n] or [n,3], without the cosine
//
// Arrays that go in are of doubles, their columns contiguous; those that come out have been brought to these shapes by
// crescent/_arrays.py.
#pragma once

#include "watched.h"

namespace crescent::python {

struct Callables {
    std::string name;
    nb::object sample, pdf, f;  // pdf and f may be None
    Traits traits;
    bool weighs = false;      // sample gives weights
    bool upper_only = false;  // pdf and f are 0 under the surface, whatever the callables say there
    bool serial = false;      // they want one thread
};

class CallableSampler : public InProcessAdapter {
public:
    explicit CallableSampler(Callables callables) : c_(std::move(callables)) {}
    std::string name() const override { return c_.name; }
    Traits traits() const override { return c_.traits; }
    bool serial() const override { return c_.serial; }
    bool has_f() const override { return !c_.f.is_none(); }
    bool has_drawn_f() const override { return has_f() || c_.weighs; }
    void sample(int technique, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override;
    void pdf(int technique, std::span<const Pair> at, std::span<double> out) const override;
    void f(std::span<const Pair> at, std::span<double> out) const override;
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override;

    /// Who hears of what the callables raise; only while a result is under way.
    void set_raised(Raised* raised) const { raised_ = raised; }
    /// Draws that the callables made since this object was.
    std::uint64_t draws() const { return draws_; }

private:
    Callables c_;
    mutable Raised* raised_ = nullptr;
    mutable std::atomic<std::uint64_t> draws_{0};
    template <class Ask> void ask(Ask&& ask) const;
};

}  // namespace crescent::python
