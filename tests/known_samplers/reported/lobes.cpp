// Lobes that are mixed, rarely drawn, or cut; cones, tables and windows with discontinuous densities.
#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/reported/known.h"

namespace crescent {

namespace {

constexpr Vec3d n{0, 0, 1};

SyntheticSampler recipe(const char* name, int numbers = 2) {
    SyntheticSampler r{name, "", {}, {}, {}};
    r.traits.numbers = numbers;
    return r;
}
double power_density(Vec3d axis, Vec3d i, double s) {
    return (s + 1) / (2 * pi) * math::exp(s * math::log(std::max(dot(i, axis), 1e-300)));
}

/// The cosine, drawn with probability `drawn`, and cos^5 about n rotated to x, drawn otherwise; pdf(w) has `claimed` of
/// the cosine. The third number selects, or the first, which is then stretched.
SyntheticSampler mixture(double drawn, double claimed, bool of_two_numbers) {
    SyntheticSampler r = recipe("mixture", of_two_numbers ? 2 : 3);
    const Vec3d axis = tilt(20, 0);
    r.pdf = [=](Vec3d, Vec3d i) {
        return i.z > 0 ? claimed * i.z / pi + (1 - claimed) * power_density(axis, i, 5) : 0.0;
    };
    r.sample = [=, p = r.pdf](Vec3d o, const PrimarySample& u) {
        const double choice = of_two_numbers ? u.x : u[2];
        const bool cosine = choice < drawn;
        const double x = !of_two_numbers ? u.x : cosine ? u.x / drawn : (u.x - drawn) / (1 - drawn);
        const Vec3d i = about(cosine ? n : axis, math::exp(math::log(1 - x) / (cosine ? 2 : 6)), u.y);
        return Draw{i, i.z > 0 ? p(o, i) : 0.0, {}, {}};
    };
    return r;
}

/// Lambert and a lobe cos^50 about the mirror direction, which the first number selects with probability `choice`; p
/// assumes one half.
SyntheticSampler two_lobes(double choice) {
    SyntheticSampler r = recipe("two lobes");
    const auto mirrored = [](Vec3d wo) { return Vec3d{-wo.x, -wo.y, wo.z}; };
    r.pdf = [=](Vec3d wo, Vec3d wi) {
        return 0.5 * std::max(wi.z, 0.0) / pi + 0.5 * power_density(mirrored(wo), wi, 50);
    };
    r.sample = [choice, mirrored, p = r.pdf](Vec3d wo, const PrimarySample& u) {
        const bool lobe = u[0] < choice;
        const double v = lobe ? u[0] / choice : (u[0] - choice) / (1 - choice);
        const Vec3d wi =
            lobe ? about(mirrored(wo), math::exp(math::log(v) / 51), u[1]) : about(n, std::sqrt(1 - v), u[1]);
        return Draw{wi, p(wo, wi)};
    };
    return r;
}

/// A share of cosine, drawn with that probability; f of albedo 0.5.
SyntheticSampler seldom(double share) {
    SyntheticSampler r = recipe("seldom", 3);
    r.pdf = [share](Vec3d, Vec3d i) { return share * std::max(i.z, 0.0) / pi; };
    r.f = [](Vec3d, Vec3d i) { return i.z > 0 ? 0.5 / pi : 0; };
    r.sample = [share](Vec3d, const PrimarySample& u) {
        const Vec3d wi = about(n, std::sqrt(1 - u[0]), u[1]);
        return Draw{wi, u[2] < share ? share * wi.z / pi : 0};
    };
    return r;
}
SyntheticSampler never_drawn(SyntheticSampler r) {
    r.sample = [](Vec3d, const PrimarySample& u) { return Draw{about(n, std::sqrt(1 - u[0]), u[1]), 0}; };
    return r;
}
SyntheticSampler black(SyntheticSampler r) {
    r.pdf = [](Vec3d, Vec3d) { return 0.0; };
    return r;
}
/// One draw in 1500 goes to a clamped direction.
SyntheticSampler atom() {
    SyntheticSampler r = seldom(1);
    r.sample = [](Vec3d, const PrimarySample& u) {
        const Vec3d wi = u[2] < 1 / 1500.0 ? tilt(40, 20) : about(n, std::sqrt(1 - u[0]), u[1]);
        return Draw{wi, wi.z / pi};
    };
    return r;
}

/// One number selects among `count` cones, whose axes are random over the upper half; p is the sum over those that
/// contain w, times `claimed`.
SyntheticSampler cones(int count, double half_angle, double claimed = 1) {
    std::vector<Vec3d> axes;
    Rng dice(static_cast<std::uint64_t>(count));
    while (static_cast<int>(axes.size()) < count) axes.push_back(dice.direction(0.2, 0.98));
    const double a = 1 - math::cos(half_angle);
    SyntheticSampler r = recipe("cones", 3);
    r.pdf = [=](Vec3d, Vec3d wi) {
        double p = 0;
        for (Vec3d axis : axes) p += dot(axis, wi) >= 1 - a;
        return claimed * p / (2 * pi * a * count);
    };
    r.sample = [=, p = r.pdf](Vec3d o, const PrimarySample& u) {
        const Vec3d wi = about(axes[static_cast<std::size_t>(u[2] * count)], 1 - a * u[0], u[1]);
        return Draw{wi, p(o, wi), {}, {}};
    };
    return r;
}

/// A band of cos theta with constant density.
SyntheticSampler band(double low, double high) {
    SyntheticSampler r = recipe("band");
    r.pdf = [=](Vec3d, Vec3d wi) { return wi.z >= low && wi.z <= high ? 1 / (2 * pi * (high - low)) : 0; };
    r.sample = [=](Vec3d, const PrimarySample& u) {
        return Draw{about(n, low + (high - low) * u[0], u[1]), 1 / (2 * pi * (high - low)), {}, {}};
    };
    return r;
}

/// 8 x 16 cells of the hemisphere, one of them forty times as bright.
SyntheticSampler cells() {
    std::vector<double> sums = {0};
    for (int k = 0; k < 128; ++k)
        sums.push_back(sums.back() + 0.1 + (k / 16 * 7 + k % 16 * 13) % 11 * 0.35 + (k == 3 * 16 + 5 ? 40 : 0));
    SyntheticSampler r = recipe("cells");
    r.pdf = [=](Vec3d, Vec3d wi) {
        const double turns = math::atan2(wi.y, wi.x) / (2 * pi);
        const int k = std::min(7, int(wi.z * 8)) * 16 + std::min(15, int((turns < 0 ? turns + 1 : turns) * 16));
        return wi.z <= 0 ? 0.0 : (sums[std::size_t(k) + 1] - sums[std::size_t(k)]) / sums.back() * 128 / (2 * pi);
    };
    r.sample = [=, p = r.pdf](Vec3d o, const PrimarySample& u) {
        const double x = u[0] * sums.back();
        const auto k = std::min<std::size_t>(std::size_t(std::ranges::upper_bound(sums, x) - sums.begin()) - 1, 127);
        const double v = std::min((x - sums[k]) / (sums[k + 1] - sums[k]), 1 - 1e-9);
        const Vec3d wi = about(n, (double(k / 16) + u[1]) / 8, (double(k % 16) + v) / 16);
        return Draw{wi, p(o, wi), {}, {}};
    };
    return r;
}

/// A window of 24 x 24 cells at distance 1, cell (i, k) selected with (1 + (7 i + 5 k) mod 11), a point of it by area;
/// `beside`: p on a patch of the plane outside of it, where nothing is drawn.
SyntheticSampler window(double beside = 0) {
    constexpr int side = 24;
    constexpr double width = 2.6, height = 2.2;
    std::vector<double> cdf = {0};
    for (int i = 0; i < side * side; ++i) cdf.push_back(cdf.back() + 1 + (7 * (i / side) + 5 * (i % side)) % 11);
    for (double& v : cdf) v /= cdf.back();
    cdf.back() = 1;
    const Vec3d to = tilt(20, 40), t = normalize(cross(to, {1, 0, 0})), b = cross(to, t);
    SyntheticSampler r = recipe("window");
    r.traits.wo = Traits::WoDomain::none;
    r.pdf = [=](Vec3d, Vec3d w) {
        const double z = dot(w, to);
        if (!(z > 0)) return 0.0;
        const double x = dot(w, t) / z / width + 0.5, y = dot(w, b) / z / height + 0.5, per_area = 1 / (z * z * z);
        if (std::fabs(x - 1.1) < 0.05 && std::fabs(y - 0.5) < 0.2) return beside * per_area;
        if (x < 0 || x >= 1 || y < 0 || y >= 1) return 0.0;
        const std::size_t cell = static_cast<std::size_t>(x * side) * side + static_cast<std::size_t>(y * side);
        return (cdf[cell + 1] - cdf[cell]) * side * side / (width * height) * per_area;
    };
    r.sample = [=, pdf = r.pdf](Vec3d, const PrimarySample& u) {
        const auto at = std::upper_bound(cdf.begin(), cdf.end() - 1, u.x) - cdf.begin() - 1;
        const auto k = static_cast<std::size_t>(at);
        const double along = (u.x - cdf[k]) / (cdf[k + 1] - cdf[k]);
        const double x = (static_cast<double>(at / side) + std::min(along, 1 - 1e-12)) / side,
                     y = (static_cast<double>(at % side) + u.y) / side;
        const Vec3d w = normalize(to + t * ((x - 0.5) * width) + b * ((y - 0.5) * height));
        return Draw{w, pdf({}, w), {}};
    };
    return r;
}

/// Half vectors of a measured table are at theta = u^2 pi / 2: p has a pole at its axis.
SyntheticSampler pole() {
    const auto density = [](double theta) {
        return 1 / std::max(2 * pi * pi * std::sqrt(2 * theta / pi) * math::sin(theta), 1e-300);
    };
    SyntheticSampler r = recipe("theta = u^2 pi / 2");
    r.sample = [density](Vec3d, const PrimarySample& u) {
        const double theta = 0.5 * pi * u[0] * u[0];
        return Draw{math::spherical(math::cos(theta), 2 * pi * u[1]), density(theta)};
    };
    r.pdf = [density](Vec3d, Vec3d w) { return w.z > 0 ? density(math::acos(std::min(w.z, 1.0))) : 0.0; };
    return r;
}

/// A sky of 512 x 256 texels by an alias table; `off`: each texel uses the alias of its neighbour.
SyntheticSampler alias_sky(bool off) {
    Rng dice(3);
    Sky sky = *sky_with_sun(dice, 256, 512, 0.02, true);
    if (off)
        for (int& other : sky.other) other = (other + 1) % (256 * 512);
    return recipe_of(std::make_shared<const Sky>(sky));
}
SyntheticSampler alias_sky_of(int rows, double sun) {
    Rng dice(static_cast<std::uint64_t>(rows));
    return recipe_of(sky_with_sun(dice, rows, 2 * rows, sun, true));
}

}  // namespace

std::vector<KnownSampler> lobe_samplers() {
    KnownList list;
    for (bool of_two : {false, true}) {
        for (double drawn : {0.2, 0.5}) list.right("mixture", mixture(drawn, drawn, of_two));
        for (double drawn : {0.3, 0.5})
            list.wrong("mixture drawn 0.5 % too often", "", mixture(drawn, drawn + 0.005, of_two));
    }
    list.right("two lobes", two_lobes(0.5), {0, 45, 75});
    list.wrong("lobe chosen 0.5 % too often", "", two_lobes(0.505), {45});
    for (double share : {0.01, 0.003, 0.0001}) list.not_wrong("seldom drawn", seldom(share), {0, 45});
    list.wrong("never drawn though p is not 0", "normalised", never_drawn(seldom(0.003)), {30});
    list.wrong("never drawn and p is 0 though f is not", "", black(never_drawn(seldom(0.003))), {30});
    list.wrong("one direction again and again", "identity", atom(), {30});
    list.right("64 cones", cones(64, 0.01));
    list.right("100 cones that overlap", cones(100, 0.05));
    list.wrong("64 cones that integrate to 1.005", "", cones(64, 0.01, 1.005));
    list.missed("64 cones that integrate to 1.001", cones(64, 0.01, 1.001));  // an integral of 1.0024 would be found
    list.right("cone", band(0.8, 1));
    list.right("thin band", band(math::cos(0.735), math::cos(0.70)));
    list.right("cells", cells(), {0});
    list.right("window", window(), {0});
    list.wrong("window with p beside it", "", window(0.012), {0});
    list.not_wrong("pole", pole(), {0});
    list.right("sky by an alias table", alias_sky(false), {0});
    list.wrong("alias table off by one", "density", alias_sky(true), {0});
    for (int rows : {30, 45, 63}) list.right("sky of " + std::to_string(rows) + " rows", alias_sky_of(rows, 0.5), {0});
    for (double alpha : {0.02, 0.005}) list.right("sharp lobe", ggx_visible_at(alpha, alpha * 3), {0, 30, 75});
    list.right("anisotropic lobe", ggx_visible_at(0.1, 0.4), {0, 60, 85});
    return list.take();
}

}  // namespace crescent
