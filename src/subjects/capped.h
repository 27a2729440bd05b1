// A sampler that is asked no more often than it may be: a question beyond that is not put.
#pragma once

#include <memory>
#include <span>

#include "subjects/faults.h"
#include "subjects/forwarded.h"

namespace crescent::inline subjects {

/// Throws SubjectTooSlow in place of questions by which `inner` would have given more than `most` answers in all.
class CappedSampler : public ForwardedSampler {
public:
    CappedSampler(std::shared_ptr<const JudgedSampler> inner, std::uint64_t most)
        : ForwardedSampler(std::move(inner)), most_(most) {}
    void sample(int t, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        allow(out.size());
        inner().sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        allow(out.size());
        inner().pdf(t, at, out);
    }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        allow(out.size());
        inner().exact_pdf(t, at, out);
    }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        allow(out.size());
        inner().f(at, out);
    }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        allow(out.size());
        inner().f_channels(at, out);
    }

private:
    std::uint64_t most_;
    void allow(std::size_t questions) const {
        if (spending().answers + questions > most_) throw SubjectTooSlow("it may not be asked more");
    }
};

}  // namespace crescent::inline subjects
