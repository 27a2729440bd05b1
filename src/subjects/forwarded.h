// A sampler that answers as another one does, but for what a class derived from it changes.
#pragma once

#include <memory>

#include "subjects/subject.h"

namespace crescent::inline subjects {

class ForwardedSampler : public JudgedSampler {
public:
    explicit ForwardedSampler(std::shared_ptr<const JudgedSampler> inner) : inner_(std::move(inner)) {}
    std::string name() const override { return inner_->name(); }
    Traits traits() const override { return inner_->traits(); }
    int techniques() const override { return inner_->techniques(); }
    void sample(int t, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        inner_->sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override { inner_->pdf(t, at, out); }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        inner_->exact_pdf(t, at, out);
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        inner_->mis_weight(t, at, out);
    }
    bool has_f() const override { return inner_->has_f(); }
    void f(std::span<const Pair> at, std::span<double> out) const override { inner_->f(at, out); }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override { inner_->f_channels(at, out); }
    bool has_true_f() const override { return inner_->has_true_f(); }
    void true_f(std::span<const Pair> at, std::span<double> out) const override { inner_->true_f(at, out); }
    bool has_drawn_f() const override { return inner_->has_drawn_f(); }
    double tabulation_error(Vec3d w) const override { return inner_->tabulation_error(w); }
    bool draws_at_will() const override { return inner_->draws_at_will(); }
    Spending spending() const override { return inner_->spending(); }
    void make_way(std::size_t steps) const override { inner_->make_way(steps); }
    bool serial() const override { return inner_->serial(); }
    bool limited() const override { return inner_->limited(); }

protected:
    const JudgedSampler& inner() const { return *inner_; }

private:
    std::shared_ptr<const JudgedSampler> inner_;
};

}  // namespace crescent::inline subjects
