// A boundary is flat if it reflects to the mirror direction or, if it reflects nothing, if its refracted direction
// rotates with w_o about n.
#include "check/decide/delta_directions.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/decide/small_tests.h"
#include "math/functions.h"
#include "math/simd/scalar.h"

namespace crescent::check {

namespace {

bool near(Vec3d a, Vec3d b) { return length(a - b) < delta_direction; }
Vec3d mirrored(Vec3d wo) { return {-wo.x, -wo.y, wo.z}; }

/// The direction into which w_o is refracted; none for total reflection.
std::optional<Vec3d> refracted(Vec3d wo, double below_over_above) {
    const double e = wo.z > 0 ? below_over_above : 1 / below_over_above, x = -wo.x / e, y = -wo.y / e,
                 squared_cosine = 1 - x * x - y * y;
    if (squared_cosine < 0) return {};
    return Vec3d{x, y, wo.z > 0 ? -std::sqrt(squared_cosine) : std::sqrt(squared_cosine)};
}

bool is_refracted(Vec3d wo, Vec3d wi, Vec3d eta, bool is_inverted) {
    for (int c = 0; c < 3; ++c) {
        const double index = channel_of(eta, c);
        const std::optional<Vec3d> expected = refracted(wo, is_inverted ? 1 / index : index);
        if (expected && near(*expected, wi)) return true;
    }
    return false;
}

/// Draws of the same technique at another w_o.
std::vector<Draw> drawn_at(const Source& source, Vec3d wo, std::uint32_t n, const StreamKey& key) {
    const std::vector<PrimarySample> u = first_numbers(key, n, source.traits);
    std::vector<Draw> out(n);
    source.adapter.sample(source.technique, wo, u, out);
    return out;
}

/// Whether the direction rotates with w_o about n, as at a flat boundary.
bool turns_with_wo(const Source& source, Vec3d wi, const StreamKey& key) {
    constexpr double angle = 2.4;  // radians; no symmetry of a pattern
    if (!source.declaration.can_draw) return false;
    const math::SinCos rotation = math::sincos(angle);
    const auto turn = [&](Vec3d w) {
        return Vec3d{rotation.cos * w.x - rotation.sin * w.y, rotation.sin * w.x + rotation.cos * w.y, w.z};
    };
    const std::vector<Draw> draws = drawn_at(source, turn(source.wo), 256, key);
    return std::ranges::any_of(
        draws, [expected = turn(wi)](const Draw& d) { return d.delta > 0 && near(d.wi, expected); });
}

SmallFault fault_at(const DeltaPart& p, const char* what) {
    SmallFault out{.family = Family::delta_direction,
        .times = static_cast<double>(p.draws),
        .trials = static_cast<double>(p.draws),
        .what = what};
    out.first.draw.wi = p.wi;
    out.first.draw.delta = p.q;
    out.first.draw.weights = p.weight;
    return out;
}

}  // namespace

std::optional<SmallFault> refraction(const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key) {
    if (!source.traits.eta) return {};
    const Vec3d wo = source.wo, eta = *source.traits.eta;
    std::vector<const DeltaPart*> refracted_parts;
    const DeltaPart* off_mirror = nullptr;  // reflected, but not to the mirror direction of a flat boundary
    bool has_mirror = false;
    for (const DeltaPart& p : parts) {
        const bool is_transmitted = p.wi.z * wo.z < 0;
        if (!is_transmitted) {
            if (near(p.wi, mirrored(wo))) has_mirror = true;
            else if (!near(p.wi, wo)) off_mirror = &p;
        } else if (std::ranges::none_of(refracted_parts, [&](const DeltaPart* q) { return near(q->wi, p.wi); })) {
            refracted_parts.push_back(&p);
        }
    }
    const std::size_t indices = eta.x == eta.y && eta.y == eta.z ? 1 : 3;
    if (refracted_parts.size() > indices) return {};  // a boundary of another shape
    if (off_mirror) {                                 // a boundary that refracts as a flat one must also reflect as one
        const bool is_flat = std::ranges::any_of(refracted_parts,
            [&](const DeltaPart* p) { return !near(p->wi, -wo) && is_refracted(wo, p->wi, eta, false); });
        if (!is_flat) return {};
        return fault_at(*off_mirror,
            "A delta part is not reflected to the mirror direction, although the boundary refracts as a flat one");
    }
    for (const DeltaPart* p : refracted_parts) {
        if (near(p->wi, -wo) || is_refracted(wo, p->wi, eta, false)) continue;
        if (!has_mirror && !turns_with_wo(source, p->wi, key)) continue;
        return fault_at(*p,
            is_refracted(wo, p->wi, eta, true) ? "A delta part is refracted by 1 / eta in place of eta"
                                               : "A delta part is not refracted by the stated index");
    }
    return {};
}

namespace {

/// q times the weight by channel; a single channel is used three times.
Vec3d power_of(const Source& source, const Draw& d) { return d.delta * weight_by_channel(d, source.channels()); }

bool alike_power(double a, double b) {
    return std::fabs(a - b) <= delta_power_tolerance * std::max(std::fabs(a), std::fabs(b)) + 1e-6;
}
bool alike_power(Vec3d a, Vec3d b) { return alike_power(a.x, b.x) && alike_power(a.y, b.y) && alike_power(a.z, b.z); }

/// The ratio of the power of the reverse path to that of the forward path: f(a, b) / eta_a^2 = f(b, a) / eta_b^2 (Veach
/// 1997, 5.2), and radiance is scaled by 1 / eta^2 in both directions. None if it is not known.
std::optional<Vec3d> reverse_power_ratio(const Source& source, Vec3d wi) {
    const Vec3d wo = source.wo;
    if (wi.z * wo.z > 0) return near(wi, mirrored(wo)) ? std::optional(Vec3d{1, 1, 1}) : std::nullopt;
    if (!source.traits.eta || near(wi, -wo) || !is_refracted(wo, wi, *source.traits.eta, false)) return {};
    if (source.traits.importance) return Vec3d{1, 1, 1};
    const auto solid_angle_factor = [is_above = wo.z > 0](double eta) { return sqr(sqr(is_above ? eta : 1 / eta)); };
    return Vec3d{solid_angle_factor(source.traits.eta->x), solid_angle_factor(source.traits.eta->y),
        solid_angle_factor(source.traits.eta->z)};
}

/// Compares the power of a part with that of its reverse path, if each is a single part.
std::optional<SmallFault> reverse_power_fault(const Source& source, const std::vector<DeltaPart>& parts,
    const DeltaPart& p, const std::vector<Draw>& reverse_draws) {
    const std::optional<Vec3d> ratio = reverse_power_ratio(source, p.wi);
    const auto part_count = std::ranges::count_if(parts, [&](const DeltaPart& o) { return near(o.wi, p.wi); });
    if (!ratio || part_count != 1 || p.other_weights > 0) return {};
    const Vec3d first = power_of(source, reverse_draws[0]), forward_power = p.q * p.weight,
                expected = {forward_power.x * ratio->x, forward_power.y * ratio->y, forward_power.z * ratio->z};
    if (!std::ranges::all_of(reverse_draws, [&](const Draw& d) { return alike_power(power_of(source, d), first); }))
        return {};
    if (alike_power(first, expected)) return {};
    SmallFault out = fault_at(p, "The reverse path of a delta part has another power: not reciprocal");
    out.first.p = first.x;
    out.first.expected = expected.x;
    out.size = expected.x > 0 ? first.x / expected.x - 1 : 0;
    return out;
}

}  // namespace

std::optional<SmallFault> reverse_path(
    const Source& source, const std::vector<DeltaPart>& parts, const StreamKey& key) {
    const Traits& traits = source.traits;
    if (!traits.reciprocal || !traits.has_surface() || !source.declaration.can_draw) return {};
    for (const DeltaPart& p : parts) {
        if (p.wi.z < grazing_cosine && (traits.wo != Traits::WoDomain::both || p.wi.z > -grazing_cosine)) continue;
        // Of the same kind: reflected if w_i is a reflection of w_o, else transmitted.
        const Vec3d wi = normalize(p.wi);
        std::vector<Draw> reverse_draws = drawn_at(source, wi, 512, key);
        std::erase_if(reverse_draws,
            [&](const Draw& d) { return !(d.delta > 0) || (d.wi.z * wi.z < 0) != (wi.z * source.wo.z < 0); });
        const bool has_many_draws = reverse_draws.size() >= 8;
        std::erase_if(reverse_draws, [&](const Draw& d) { return !near(d.wi, source.wo); });
        if (!reverse_draws.empty()) {
            if (std::optional<SmallFault> fault = reverse_power_fault(source, parts, p, reverse_draws)) return fault;
        } else if (has_many_draws) {
            return fault_at(p, "No delta part returns from the direction of a delta part to w_o");
        }
    }
    return {};
}

}  // namespace crescent::check
