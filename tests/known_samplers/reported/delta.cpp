// Delta parts have the directions of a smooth boundary or a thin wall, carry at most the incoming energy, and are
// reciprocal.
#include <algorithm>
#include <cmath>

#include "check/sources/check_case.h"
#include "math/functions.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/reported/known.h"

namespace crescent {

namespace {

using Change = std::function<void(Vec3d wo, Draw&)>;

SyntheticSampler changed(SyntheticSampler r, const Change& change) {
    r.sample = [sample = r.sample, change](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        change(o, d);
        return d;
    };
    return r;
}
bool reflected(Vec3d o, const Draw& d) { return d.wi.z * o.z > 0; }

/// Smooth glass of 1.5 with a change in its transmission.
SyntheticSampler glass_through(const Change& change) {
    return changed(smooth_glass(1.5), [change](Vec3d o, Draw& d) {
        if (!reflected(o, d)) change(o, d);
    });
}
void by_the_inverse_index(Vec3d o, Draw& d) {
    const double e = o.z > 0 ? 1 / 1.5 : 1.5, x = -o.x / e, y = -o.y / e;
    d.wi = {x, y, -std::copysign(std::sqrt(std::max(1 - x * x - y * y, 0.0)), o.z)};
}
SyntheticSampler without_index(SyntheticSampler r) {
    r.traits.eta = {};
    return r;
}

/// Smooth glass that reflects nothing, refracted by the index `drawn` while 1.5 is stated.
SyntheticSampler refracted_by(double drawn) {
    SyntheticSampler r = smooth_glass(1.5);
    r.sample = [=](Vec3d o, const PrimarySample&) {
        const double e = o.z > 0 ? drawn : 1 / drawn, rest = 1 - (1 - o.z * o.z) / (e * e);
        if (rest < 0) return Draw{{0, 0, 1}, 0, {}, {}};
        Draw d{{-o.x / e, -o.y / e, -std::copysign(std::sqrt(rest), o.z)}, 0, {}, {}};
        d.delta = 1;
        d.weight = o.z > 0 ? 1 / (1.5 * 1.5) : 1.5 * 1.5;
        return d;
    };
    return r;
}

/// Smooth glass of three indices, one per channel: a third of the transmitted draws belongs to each, with weight only
/// in its channel, times `scale`. Along the normal the three directions coincide.
SyntheticSampler dispersive_glass(double scale) {
    constexpr double eta[] = {1.45, 1.5, 1.6}, mirrored = 0.1;
    SyntheticSampler r{"dispersive glass", "", {}, {}, {}};
    r.traits.numbers = 4;
    r.traits.channels = 3;
    r.traits.wo = Traits::WoDomain::both;
    r.traits.delta = true;
    r.traits.eta = Vec3d{eta[0], eta[1], eta[2]};
    r.pdf = [](Vec3d, Vec3d) { return 0.0; };
    r.f_channels = [](Vec3d, Vec3d) { return Vec3d{}; };
    r.sample = [=](Vec3d o, const PrimarySample& u) {
        const int channel = std::min(static_cast<int>(3 * u[2]), 2);
        const double e = o.z > 0 ? eta[channel] : 1 / eta[channel], rest = 1 - (1 - o.z * o.z) / (e * e);
        Draw d{{-o.x, -o.y, o.z}, 0};
        d.delta = mirrored;
        d.weights = {1, 1, 1};
        if (u[3] >= mirrored) {
            if (rest < 0) return Draw{{0, 0, 1}, 0, {}, {}};
            const double w = 3 * scale / (e * e);
            d.wi = {-o.x / e, -o.y / e, -std::copysign(std::sqrt(rest), o.z)};
            d.delta = (1 - mirrored) / 3;
            d.weights = {channel == 0 ? w : 0, channel == 1 ? w : 0, channel == 2 ? w : 0};
        }
        d.weight = luminance(d.weights);
        return d;
    };
    return r;
}

/// Half goes straight through with `open` of its light, half is reflected by Lambert of 0.5.
SyntheticSampler mask(double open) {
    SyntheticSampler r{"mask", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.wo = Traits::WoDomain::both;
    r.traits.delta = true;
    r.pdf = [](Vec3d o, Vec3d i) { return o.z * i.z > 0 ? 0.5 * std::fabs(i.z) / pi : 0; };
    r.f = [](Vec3d o, Vec3d i) { return o.z * i.z > 0 ? 0.5 / pi : 0; };
    r.sample = [open](Vec3d o, const PrimarySample& u) {
        const double z = std::sqrt(1 - u[0]);
        Draw d{math::spherical(std::sqrt(u[0]), std::copysign(z, o.z), 2 * pi * u[1]), 0.5 * z / pi};
        d.weight = 1;
        if (u[2] >= 0.5) return d;
        d = {-o, 0};
        d.delta = 0.5;
        d.weight = open / 0.5;
        return d;
    };
    return r;
}

/// A mirror; if not `whole`, it flips y for half of all w_o.
SyntheticSampler mirror(bool whole) {
    SyntheticSampler r{"mirror", "", {}, {}, {}};
    r.traits.delta = true;
    r.pdf = [](Vec3d, Vec3d) { return 0; };
    r.sample = [whole](Vec3d o, const PrimarySample&) {
        Draw d{{-o.x, whole || o.x > 0 ? -o.y : o.y, o.z}, 0};
        d.delta = 1;
        d.weight = 0.9;
        return d;
    };
    return r;
}

/// Smooth glass that tints the transmitted light; `alike` from above and from below.
SyntheticSampler tinted(bool alike) {
    SyntheticSampler r = changed(smooth_glass(1.5), [alike](Vec3d o, Draw& d) {
        const double w = *d.weight;
        const Vec3d tint = alike || o.z > 0 ? Vec3d{0.9, 0.8, 0.6} : Vec3d{0.6, 0.8, 0.9};
        d.weights = reflected(o, d) ? Vec3d{w, w, w} : w * tint;
        d.weight = luminance(d.weights);
    });
    r.traits.channels = 3;
    r.f_channels = [](Vec3d, Vec3d) { return Vec3d{}; };
    return r;
}

/// A tenth of the glass is holes that transmit `through` of their light.
SyntheticSampler holes(double through) {
    SyntheticSampler r = smooth_glass(1.5);
    const int chooser = r.traits.numbers++;
    r.sample = [=, sample = r.sample](Vec3d o, const PrimarySample& u) {
        Draw d = sample(o, u);
        d.delta *= 0.9;
        if (u[chooser] >= 0.1) return d;
        d = {-o, 0};
        d.delta = 0.1;
        d.weight = through;
        return d;
    };
    return r;
}

}  // namespace

std::vector<KnownSampler> delta_samplers() {
    KnownList list;
    list.right("smooth glass", smooth_glass(1.5), {0, 30, 60, 150, 175});
    list.wrong("smooth glass refracted by 1 / eta", "physics", glass_through(by_the_inverse_index), {30});
    list.not_wrong("the same without a stated index", without_index(glass_through(by_the_inverse_index)), {30});
    list.wrong("smooth glass that mirrors y the wrong way", "physics",
        changed(smooth_glass(1.5),
            [](Vec3d o, Draw& d) {
                if (reflected(o, d)) d.wi = {o.x, -o.y, o.z};
            }),
        {30, 85, 150});
    list.not_wrong("a thin wall of glass", glass_through([](Vec3d o, Draw& d) {
        d.wi = -o;
        d.weight = 1;
    }),
        {0, 30, 150, 180});
    list.right("glass that reflects nothing", refracted_by(1.5), {0, 30, 85, 150});
    list.wrong("refracted by 1.4 for 1.5", "physics", refracted_by(1.4), {30});
    list.wrong("refracted by 1 / 1.5 for 1.5", "physics", refracted_by(1 / 1.5), {30});
    list.right("dispersive glass", dispersive_glass(1), {0, 40, 160, 180});
    list.wrong("dispersive glass that creates energy", "physics", dispersive_glass(1.02), {0});
    list.right("mask", mask(0.5), {30, 150});
    list.wrong("mask that creates energy", "physics", mask(0.733), {30, 150});
    list.right("mirror", mirror(true), {60});
    list.wrong("mirror that does not lead back", "physics", mirror(false), {60});
    list.right("tinted glass", tinted(true), {30, 150});
    list.wrong("glass tinted otherwise from below", "physics", tinted(false), {30, 150});
    list.right("glass with holes", holes(1), {0, 30, 150, 180});
    list.wrong("holes that create energy", "physics", holes(1.9), {0, 30, 150, 180});
    list.right("coat with a delta part", recipe_of(SmoothCoat{}));
    list.wrong("coat whose third channel creates energy", "physics", recipe_of(SmoothCoat{0.2, 0.3, {0.5, 0.5, 1.01}}));
    return list.take();
}

}  // namespace crescent
