// mean: bridged weights against the integral of f cos. support: light where p is 0. physics: no more comes back than
// arrives. All by channel.
#include <cmath>

#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

namespace {

/// Mean and the variance of that mean.
Estimate mean_of(const Sums& s, double n) {
    const double m = s.sum / n;
    return {m, std::max(s.square / n - m * m, 0.0) / n, 0};
}

void ask_mean(const Evidence& e, int channel, const Visit& visit) {
    const auto c = static_cast<std::size_t>(channel);
    const Observations& o = e.observations;
    if (!(o.weighed > 0) || o.checks.deltas > 0) return;  // deltas have no part in the integral
    const Estimate drawn = mean_of(o.mean[c], o.weighed), &due = e.integrals.light.mean[c];
    const double v = drawn.variance + due.variance, floor = detection_floor * due.value;
    Answer a{Family::mean, channel, drawn.value - due.value, std::sqrt(v), floor, 1, due.value};
    const double largest = e.source.has_density() ? e.plan.usual[c] : 0;  // a bridged weight is at most that
    a.p = largest > 0
        ? bennett_p(bennett_z2(std::fabs(a.difference) - floor, v, largest / o.weighed, freedom(v, due.doubt)))
        : 2 * normal_p_of(std::fabs(a.difference) - floor, v);
    if (largest > 0 || !e.source.has_density()) visit(a);
}

void ask_albedo(const Evidence& e, int channel, const Visit& visit) {
    const auto c = static_cast<std::size_t>(channel);
    const Observations& o = e.observations;
    const Estimate of_deltas = mean_of(o.delta[c], o.independent), &of_density = e.integrals.light.albedo[c];
    const double total = of_deltas.value + of_density.value, v = of_deltas.variance + of_density.variance;
    Answer a{Family::albedo, channel, total - 1, std::sqrt(v), albedo_excess, 1, 1};
    a.p = student_p_of(total - 1 - albedo_excess, v, freedom(v, of_density.doubt));
    visit(a);
}

}  // namespace

void ask_light(const Evidence& e, const Visit& visit) {
    if (!e.source.has_f() || !(e.integrals.light.points > 0)) return;
    for (int c = 0; c < e.source.channels(); ++c) {
        ask_mean(e, c, visit);
        if (e.source.traits.wo != Traits::Asked::none) ask_albedo(e, c, visit);
    }
    if (!e.source.has_density() || e.plan.estimates) return;
    const LightIntegrals& l = e.integrals.light;
    const double least = lost_light * l.lit.value;
    Answer a{Family::support, 0, l.lost.value, std::sqrt(l.lost.variance), least, 1, l.lit.value};
    a.p = l.lost.value > least
        ? student_p_of(l.lost.value - least, l.lost.variance, freedom(l.lost.variance, l.lost.doubt))
        : 1;
    visit(a);
}

}  // namespace crescent::check
