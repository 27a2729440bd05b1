// A correct sampler with one change: of u, of a draw, of pdf(w), of f, or of the weight of a pair.
#pragma once

#include <functional>

#include "check/sources/cases.h"

namespace crescent {

struct FaultInjection {
    std::function<Vec2d(Vec2d)> u{};                       // before the draw
    std::function<Vec3d(Vec3d wo)> wo{};                   // the w_o used by the draw
    std::function<void(Vec3d wo, Vec2d u, Draw&)> draw{};  // after it
    std::function<double(const Pair&, double p)> pdf{};    // both with the draw and for queries
    std::function<double(const Pair&, double p)> asked{};  // for queries only
    std::function<double(const Pair&, double f)> f{};
    std::function<double(int technique, const Pair&, double w)> mis{};
};

class FaultySampler : public SamplerSource {
public:
    FaultySampler(std::shared_ptr<const SamplerAdapter> right, FaultInjection bend)
        : right_(std::move(right)), bend_(std::move(bend)) {}
    std::string name() const override { return right_->name(); }
    int techniques() const override { return right_->techniques(); }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        std::vector<PrimarySample> v(u.begin(), u.end());
        if (bend_.u)
            for (PrimarySample& x : v) x = bend_.u(x);
        right_->sample(t, bend_.wo ? bend_.wo(wo) : wo, v, out);
        for (std::size_t i = 0; i < out.size(); ++i) {
            if (bend_.draw) bend_.draw(wo, v[i], out[i]);
            if (bend_.pdf && out[i].pdf > 0) out[i].pdf = bend_.pdf({wo, out[i].wi}, out[i].pdf);
        }
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        right_->pdf(t, at, out);
        bend_pdf(at, out);
    }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        right_->exact_pdf(t, at, out);
        bend_pdf(at, out);
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        right_->mis_weight(t, at, out);
        for (std::size_t i = 0; bend_.mis && i < out.size(); ++i) out[i] = bend_.mis(t, at[i], out[i]);
    }
    bool has_f() const override { return right_->has_f(); }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        right_->f(at, out);
        for (std::size_t i = 0; bend_.f && i < out.size(); ++i) out[i] = bend_.f(at[i], out[i]);
    }
    bool has_true_f() const override { return true; }
    void reference_f(std::span<const Pair> at, std::span<double> out) const override { right_->f(at, out); }

private:
    void bend_pdf(std::span<const Pair> at, std::span<double> out) const {
        for (std::size_t i = 0; i < out.size(); ++i) {
            if (bend_.pdf) out[i] = bend_.pdf(at[i], out[i]);
            if (bend_.asked) out[i] = bend_.asked(at[i], out[i]);
        }
    }
    std::shared_ptr<const SamplerAdapter> right_;
    FaultInjection bend_;
};

}  // namespace crescent
