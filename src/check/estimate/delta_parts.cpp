// Directions, q and weights are compared to single precision.
#include "check/estimate/delta_parts.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/integrals.h"
#include "check/estimate/stream.h"

namespace crescent::check {

namespace {

bool same_value(double a, double b) { return std::fabs(a - b) <= same_number * std::max(std::fabs(a), std::fabs(b)); }
bool same_weight(Vec3d a, Vec3d b) { return same_value(a.x, b.x) && same_value(a.y, b.y) && same_value(a.z, b.z); }

/// Returns false if there are too many.
bool add_to(std::vector<DeltaPart>& parts, const Draw& d, Vec3d weight, bool by_weight) {
    const auto at = std::ranges::find_if(parts, [&](const DeltaPart& p) {
        return length(p.wi - d.wi) < same_number && same_value(p.q, d.delta) &&
            (!by_weight || same_weight(p.weight, weight));
    });
    if (at != parts.end()) {
        ++at->drawn;
        at->otherwise += !same_weight(at->weight, weight);
        return true;
    }
    if (parts.size() >= most_delta_parts) return false;
    parts.push_back({d.wi, d.delta, weight, 1, 0});
    return true;
}

/// Whether each part is drawn as often as its q, within six standard deviations.
bool all_come_by_q(const std::vector<DeltaPart>& parts, double n) {
    return std::ranges::all_of(parts, [n](const DeltaPart& p) {
        return std::fabs(static_cast<double>(p.drawn) - n * p.q) <= 6 * std::sqrt(n * p.q * (1 - p.q)) + 2;
    });
}

}  // namespace

void DeltaParts::add(const Draw& d, Vec3d weight) {
    scattered_ = !add_to(alike_, d, weight, false) || scattered_;
    many_weights_ = many_weights_ || !add_to(apart_, d, weight, true);
}

const std::vector<DeltaPart>& DeltaParts::parts(double of) const {
    const bool even = std::ranges::all_of(alike_, [](const DeltaPart& p) { return p.otherwise == 0; });
    return even || many_weights_ || !all_come_by_q(apart_, of) ? alike_ : apart_;
}

namespace {

constexpr double straight_on = unit_length;  // tolerance of a direction
constexpr double near_normal = 0.01;         // radians; refraction bends less than that there

/// Power of the first delta part that is transmitted straight at an oblique w_o, where refraction would bend it.
Vec3d through_holes(Source& source) {
    constexpr std::uint32_t tried = 512;
    Source slanted(source.adapter, source.technique, tilt(source.wo.z > 0 ? 30 : 150), source.light);
    std::vector<PrimarySample> u;
    const StreamKey key{1, 0, 0, 1, Purpose::light, 1};
    for (std::uint32_t i = 0; i < tried; ++i) u.push_back(numbers_at(key, i, source.numbers(), source.single()));
    std::vector<Draw> draws(tried);
    slanted.draw(u, draws);
    for (const Draw& d : draws) {
        if (!(d.delta > 0) || !(length(d.wi + slanted.wo) < straight_on)) continue;
        const double w = d.weight.value_or(0);
        return (source.channels() == 3 ? d.weights : Vec3d{w, w, w}) * d.delta;
    }
    return {};
}

}  // namespace

std::array<double, 3> delta_flux(Source& source, const std::vector<DeltaPart>& parts) {
    std::array<double, 3> out{}, onward{};
    const auto channels = static_cast<std::size_t>(source.channels());
    for (const DeltaPart& p : parts)
        for (std::size_t c = 0; c < channels; ++c) {
            const int channel = static_cast<int>(c);
            const double carried = p.q * channel_of(p.weight, channel);
            if (length(p.wi + source.wo) < straight_on) onward[c] += carried;
            else out[c] += carried * flux_factor(source, p.wi, channel);
        }
    if (std::ranges::all_of(onward, [](double v) { return v == 0; })) return out;
    const bool at_normal = math::hypot(source.wo.x, source.wo.y) < near_normal && source.adapter.can_draw();
    const Vec3d slanted = at_normal ? through_holes(source) : Vec3d{};
    for (std::size_t c = 0; c < channels; ++c) {
        const int channel = static_cast<int>(c);
        const double through_hole = channel_of(slanted, channel);
        // A pane transmits other shares at other angles: all of it counts as a hole if half of it is transmitted
        // straight there.
        const double holes = !at_normal || through_hole > onward[c] / 2 ? onward[c] : through_hole;
        out[c] += holes + (onward[c] - holes) * flux_factor(source, -source.wo, channel);
    }
    return out;
}

}  // namespace crescent::check
