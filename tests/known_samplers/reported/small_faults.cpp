// Faults in a small part of the draws, and correct samplers that look like them.
#include <cmath>

#include "check/sources/cases.h"
#include "tests/known_samplers/reported/known.h"

namespace crescent {

namespace {

constexpr Vec3d n{0, 0, 1};

SyntheticSampler cosine() {
    SyntheticSampler r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return std::max(wi.z, 0.0) / pi; };
    r.f = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 0.5 / pi : 0.0; };
    r.sample = [](Vec3d, const PrimarySample& u) {
        const Vec3d wi = about(n, std::sqrt(1 - u[0]), u[1]);
        return Draw{wi, wi.z / pi, {}, {}};
    };
    return r;
}
SyntheticSampler with_numbers(SyntheticSampler r, std::function<void(PrimarySample&)> change) {
    r.sample = [sample = r.sample, change](Vec3d wo, const PrimarySample& u) {
        PrimarySample v = u;
        change(v);
        return sample(wo, v);
    };
    return r;
}
/// Every weight is 10 % more than the reflected light.
SyntheticSampler bright_weights() {
    SyntheticSampler r = cosine();
    r.sample = [sample = r.sample](Vec3d wo, const PrimarySample& u) {
        Draw d = sample(wo, u);
        d.weight = 0.55;
        return d;
    };
    return r;
}

/// Uniform over the sphere; one draw in 1500 goes to a disk of 0.27 degrees that p, which integrates to one, omits.
SyntheticSampler hidden_sun(bool own_numbers) {
    SyntheticSampler r{"even, with a sun", "", {}, {}, {}};
    r.traits.wo = Traits::WoDomain::none;
    r.traits.own_random = own_numbers;
    r.pdf = [](Vec3d, Vec3d) { return 1 / (4 * pi); };
    r.sample = [](Vec3d, const PrimarySample& u) {
        constexpr double share = 1.0 / 1500;
        if (u[0] < share) return Draw{about(tilt(50, 30), 1 - u[0] / share * 1.1e-5, u[1]), 1 / (4 * pi), {}, {}};
        return Draw{about(n, 1 - 2 * (u[0] - share) / (1 - share), u[1]), 1 / (4 * pi), {}, {}};
    };
    return r;
}

/// Seven bands of cos theta, of which p has `share`.
SyntheticSampler bands(double share) {
    static const std::vector<double> edge = {-1, -0.6, -0.1, 0, 0.15, 0.4, 0.8, 1}, height = {.5, 1, 2, 5, 3, 4, 2};
    double all = 0;
    for (std::size_t k = 0; k < height.size(); ++k) all += height[k] * (edge[k + 1] - edge[k]);
    const auto p = [all, share](double z) {
        std::size_t k = 0;
        while (k + 1 < height.size() && z >= edge[k + 1]) ++k;
        return share * height[k] / all / (2 * pi);
    };
    SyntheticSampler r{"bands", "", {}, {}, {}};
    r.traits.wo = Traits::WoDomain::none;
    r.pdf = [p](Vec3d, Vec3d wi) { return p(wi.z); };
    r.sample = [p, all](Vec3d, const PrimarySample& u) {
        double left = u[0] * all;
        std::size_t k = 0;
        for (; k + 1 < height.size() && left >= height[k] * (edge[k + 1] - edge[k]); ++k)
            left -= height[k] * (edge[k + 1] - edge[k]);
        const Vec3d wi = about(n, std::min(edge[k] + left / height[k], edge[k + 1] - 1e-12), u[1]);
        return Draw{wi, p(wi.z), {}, {}};
    };
    return r;
}

/// p covers the range below 0.6 and nothing is drawn there, so part of the light is missing.
SyntheticSampler left_out() {
    SyntheticSampler r{"cosine above 0.6", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z <= 0 ? 0 : wi.z > 0.6 ? wi.z / (0.64 * pi) : 0.2 * wi.z / pi; };
    r.f = [](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? 0.5 / pi : 0.0; };
    r.sample = [p = r.pdf](Vec3d wo, const PrimarySample& u) {
        const Vec3d wi = about(n, std::sqrt(1 - 0.64 * u[0]), u[1]);
        return Draw{wi, p(wo, wi), {}, {}};
    };
    return r;
}

/// Weights of three values, of which the largest occurs once in 200 draws: the steps between them are not a heavy tail.
SyntheticSampler three_weights() {
    SyntheticSampler r{"three weights", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 1 / (2 * pi) : 0.0; };
    r.f = [](Vec3d, Vec3d wi) {
        return wi.z > 0 ? 0.05 * (wi.z > 0.995 ? 60 : wi.z > 0.985 ? 5 : 1) / wi.z / pi : 0.0;
    };
    r.traits.reciprocal = false;
    r.sample = [](Vec3d, const PrimarySample& u) { return Draw{about(n, 1 - u[0], u[1]), 1 / (2 * pi), {}, {}}; };
    return r;
}

template <template <class> class A>
std::vector<CheckCase> on_light(const char* lighting, const char* arm, double theta) {
    const CaseSetup on = case_setup(LobeKind::none, true, lighting, 32);
    return {make_case_on(on, theta, 130, arm, std::make_shared<BuiltIn<A>>(on.surface, tilt(theta, 130), on.light))};
}

}  // namespace

std::vector<KnownSampler> small_fault_samplers() {
    KnownList list;
    list.right("cosine", cosine(), {0, 45, 89});
    list.wrong("weights 10 % too large", "identity", bright_weights());
    list.wrong("sun that pdf does not know", "density", hidden_sun(false), {0});
    list.wrong("sun that pdf does not know, with its own numbers", "density", hidden_sun(true), {0});
    list.wrong("number clamped at 0.999", "density",
        with_numbers(cosine(), [](PrimarySample& u) { u[0] = std::min(u[0], 0.999); }));
    list.wrong(
        "sliver of 1 degree never drawn", "", with_numbers(cosine(), [](PrimarySample& u) { u[1] *= 359.0 / 360; }));
    list.right("sky of bands", bands(1), {0});
    list.wrong("sky of bands short of 6 in 10 000", "", bands(0.9994), {0});
    list.wrong("part of p never drawn", "normalised", left_out());
    list.right("weights of three values", three_weights());
    for (const char* lighting : {"sphere", "disk + sphere + rectangle"})
        list.add(lighting, Known::not_wrong, "", on_light<LightSolidAngle>(lighting, "light-solid-angle", 45));
    for (double theta : {0.0, 45.0, 85.0})
        list.add("sphere by area", Known::not_wrong, "", on_light<LightArea>("sphere", "light-area", theta));
    return list.take();
}

}  // namespace crescent
