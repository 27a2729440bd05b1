// Questions are put in batches for one w_o, and counted from where this trial began.
#include "trials/questions.h"

#include <algorithm>

#include "cubature/mesh.h"

namespace crescent::inline trials {

Questions::Questions(const Trial& t, const TestSettings& r, std::uint32_t index)
    : trial(t),
      settings(r),
      subject(*t.subject),
      traits(t.subject->traits()),
      index_(index),
      asked_before_(subject.spending().answers) {}

std::size_t Questions::affordable(std::size_t wanted, std::size_t keep) const {
    if (!subject.limited()) return wanted;
    constexpr std::size_t small_change = 80000;  // the warp, conditioning and the least of every integral
    const std::size_t asked =
        static_cast<std::size_t>(subject.spending().answers - asked_before_) + keep + small_change;
    return std::min(wanted, std::max<std::size_t>(settings.questions > asked ? settings.questions - asked : 0, 2000));
}

std::size_t Questions::left() const {
    const std::size_t asked = static_cast<std::size_t>(subject.spending().answers - asked_before_);
    return settings.questions > asked ? settings.questions - asked : 0;
}

std::size_t Questions::for_later() const {
    return std::min(settings.questions / (subject.has_f() ? 3 : 8), left() / 2);
}

std::vector<double> Questions::pdf(int technique, std::span<const Vec3d> wi, bool exact) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<double> out(wi.size(), 1.0);
    if (!traits.has_pdf) return out;  // not known; a draw has 1
    if (exact) subject.exact_pdf(technique, at, out);
    else subject.pdf(technique, at, out);
    return out;
}

std::vector<double> Questions::any_pdf(std::span<const Vec3d> wi) const {
    std::vector<double> sum(wi.size());
    for (int t = 0; t < subject.techniques(); ++t) {
        const std::vector<double> p = pdf(t, wi, true);
        for (std::size_t i = 0; i < p.size(); ++i) sum[i] += p[i];
    }
    return sum;
}

std::vector<double> Questions::f(std::span<const Vec3d> wi, bool truth) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<double> out(wi.size());
    if (truth) subject.true_f(at, out);
    else subject.f(at, out);
    return out;
}

std::vector<Vec3d> Questions::f_channels(std::span<const Vec3d> wi) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<Vec3d> out(wi.size());
    subject.f_channels(at, out);
    return out;
}

std::vector<double> Questions::f_of_channel(std::span<const Vec3d> wi, int channel) const {
    std::vector<double> out;
    for (Vec3d v : f_channels(wi)) out.push_back(channel == 0 ? v.x : channel == 1 ? v.y : v.z);
    return out;
}

Integral integral_of(std::vector<Rect> cells, int bins, const Batch& g, const Effort& effort, bool estimates,
    const SamplesPerBin* samples) {
    return estimates ? integrate_by_points(std::move(cells), bins, g, effort.most_evaluations, true)
                     : integrate(std::move(cells), bins, g, effort, samples);
}

}  // namespace crescent::inline trials
