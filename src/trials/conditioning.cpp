// Conditioning: how far p and f move where the components of wi and wo move by four roundings. Per sr.
#include "trials/conditioning.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crescent::inline trials {

namespace {

std::array<Vec3d, 6> nudges(Vec3d w, double by) {
    return {{{w.x + by, w.y, w.z}, {w.x - by, w.y, w.z}, {w.x, w.y + by, w.z}, {w.x, w.y - by, w.z},
        {w.x, w.y, w.z + by}, {w.x, w.y, w.z - by}}};
}

std::vector<Pair> nudged(Vec3d wo, Vec3d wi, double direction_resolution) {
    const double by = 4 * std::max(direction_resolution, 0x1p-50);
    std::vector<Pair> at;
    for (Vec3d v : nudges(wi, by)) at.push_back({wo, v});
    for (Vec3d v : nudges(wo, by)) at.push_back({v, wi});
    return at;
}

double largest_change(std::span<const double> values, double from) {
    double most = 0;
    for (double v : values)
        if (std::isfinite(v)) most = std::max(most, std::fabs(v - from));
    return most;
}

}  // namespace

double pdf_conditioning(const Draws& work, int technique, Vec3d wi, double p) {
    const std::vector<Pair> at = nudged(work.trial.wo, wi, work.direction_resolution());
    std::vector<double> values(at.size());
    work.subject.pdf(technique, at, values);
    const double most = largest_change(values, p);
    // At the very rim of what p covers it is rounding that tells inside from outside, and p may have a pole there.
    const bool rim = p == 0 ? most > 0 : std::ranges::find(values, 0.0) != values.end();
    return rim ? std::numeric_limits<double>::infinity() : 2 * most;
}

double f_conditioning(const Draws& work, Vec3d wo, Vec3d wi, double f, int channel) {
    const std::vector<Pair> at = nudged(wo, wi, std::max(work.direction_resolution(), 0x1p-24));
    std::vector<double> values(at.size());
    if (work.traits.channels == 3) {
        std::vector<Vec3d> by_channel(at.size());
        work.subject.f_channels(at, by_channel);
        for (std::size_t i = 0; i < at.size(); ++i) values[i] = channel_of(by_channel[i], channel);
    } else {
        work.subject.f(at, values);
    }
    return 2 * largest_change(values, f);
}

}  // namespace crescent::inline trials
