// Trials of a user's sampler, with arms of the list beside it that are aimed at its BRDF.
#include <cmath>

#include "subjects/list.h"
#include "subjects/named_side.h"

namespace crescent::inline subjects {

namespace {

/// A built-in arm aimed at a user's BRDF.
template <template <class> class A> class Borrowed : public BuiltIn<A> {
public:
    Borrowed(std::shared_ptr<const JudgedSampler> owner, Vec3d wo) : BuiltIn<A>({}, wo, {}), owner_(std::move(owner)) {}
    void f(std::span<const Pair> at, std::span<double> out) const override { owner_->f(at, out); }
    bool serial() const override { return owner_->serial(); }
    bool limited() const override { return owner_->limited(); }

private:
    std::shared_ptr<const JudgedSampler> owner_;
};

}  // namespace

Trial trial_of_subject(const std::shared_ptr<const JudgedSampler>& subject, double theta, double azimuth) {
    Trial t;
    t.arm = subject->name();
    t.wo = tilt(theta, azimuth);
    t.theta_deg = theta;
    t.azimuth_deg = azimuth;
    t.subject = subject;
    return t;
}

namespace {

/// The grid of w_o that a sampler answers for: one where it has none, mirrored under the surface too where it takes
/// both sides.
Grid grid_for(const Traits& traits, bool full) {
    if (traits.wo == Traits::Asked::none) return {{0, 0}};
    Grid grid = wo_grid(full);
    if (traits.wo != Traits::Asked::both) return grid;
    for (const auto& [theta, azimuth] : wo_grid(full))
        if (full || theta == 0 || theta == 30 || theta == 60 || theta == 85) grid.emplace_back(180 - theta, azimuth);
    return grid;
}

}  // namespace

std::vector<Trial> trials_of_subject(const std::shared_ptr<const JudgedSampler>& subject, bool full, const Grid& own) {
    std::vector<Trial> trials;
    const Traits traits = subject->traits();
    const Grid grid = own.empty() ? grid_for(traits, full) : own;
    for (const auto& [theta, azimuth] : grid) {
        trials.push_back(trial_of_subject(subject, theta, azimuth));
        const bool can_be_ranked =
            subject->has_f() && traits.has_pdf && !traits.delta && theta < 90 && traits.wo != Traits::Asked::none;
        if (!can_be_ranked) continue;  // cosine and uniform reach neither delta parts nor the other side
        const Vec3d wo = tilt(theta, azimuth);
        for (const std::shared_ptr<const JudgedSampler>& peer :
            {std::shared_ptr<const JudgedSampler>(std::make_shared<Borrowed<Uniform>>(subject, wo)),
                std::shared_ptr<const JudgedSampler>(std::make_shared<Borrowed<Cosine>>(subject, wo))}) {
            trials.push_back(trial_of_subject(peer, theta, azimuth));
            trials.back().baseline = true;
        }
    }
    return trials;
}

namespace {

/// An arm of the list aimed at a user's f.
class WithF : public JudgedSampler {
public:
    WithF(std::shared_ptr<const JudgedSampler> arm, std::shared_ptr<const JudgedSampler> owner)
        : arm_(std::move(arm)), owner_(std::move(owner)) {}
    std::string name() const override { return arm_->name(); }
    Traits traits() const override { return arm_->traits(); }
    int techniques() const override { return arm_->techniques(); }
    void sample(int t, Vec3d wo, std::span<const Numbers> u, std::span<Draw> out) const override {
        arm_->sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override { arm_->pdf(t, at, out); }
    void exact_pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        arm_->exact_pdf(t, at, out);
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        arm_->mis_weight(t, at, out);
    }
    bool has_f() const override { return owner_->has_f(); }
    void f(std::span<const Pair> at, std::span<double> out) const override { owner_->f(at, out); }
    bool serial() const override { return owner_->serial(); }
    bool limited() const override { return owner_->limited(); }

private:
    std::shared_ptr<const JudgedSampler> arm_, owner_;
};

}  // namespace

std::vector<Trial> arm_against(const std::string& name, std::span<const Trial> a) {
    std::vector<Trial> out;
    for (const Trial& t : a) {
        Trial b = t;
        b.arm = name;
        b.theory = {};
        b.subject = std::make_shared<WithF>(arm_on(name, t), named_side(t.subject, "A"));  // f is A's
        out.push_back(std::move(b));
    }
    return out;
}

std::vector<Trial> sampler_against(const std::shared_ptr<const JudgedSampler>& subject, std::span<const Trial> a) {
    std::vector<Trial> out;
    for (const Trial& t : a) {
        out.push_back(t);
        out.back().arm = subject->name();
        out.back().subject = subject;
        out.back().theory = {};
    }
    return out;
}

}  // namespace crescent::inline subjects
