// Equations of refraction: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces".
#include "check/explain/factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/explain/constants.h"
#include "check/explain/domain_causes.h"
#include "math/functions.h"
#include "math/simd/frame.h"
#include "samplers/domains/sphere_chart.h"

namespace crescent::check {

namespace {

/// A boundary in the orientation of w_o; eta = index on the other side over the index on this side.
struct SeenBoundary {
    double below_over_above;
    double eta(Vec3d wo) const { return wo.z > 0 ? below_over_above : 1 / below_over_above; }
    Vec3d half_vector(Vec3d wo, Vec3d wi) const { return half_vector_of(wo, wi, eta(wo)); }
    static bool is_across(Vec3d wo, Vec3d wi) { return wo.z * wi.z < 0; }
    /// (22)
    double fresnel(double c, double n) const {
        const double g2 = n * n - 1 + c * c;
        if (g2 <= 0) return 1;
        const double g = std::sqrt(g2), ratio = (g - c) / (g + c), correction = (c * (g + c) - 1) / (c * (g - c) + 1);
        return 0.5 * ratio * ratio * (1 + correction * correction);
    }
    double fresnel(Vec3d wo, Vec3d wi) const { return fresnel(std::fabs(dot(wo, half_vector(wo, wi))), eta(wo)); }
    /// dm / dw_i of a refraction, (17).
    double refraction_jacobian(Vec3d wo, Vec3d wi) const {
        const Vec3d m = half_vector(wo, wi);
        const double n = eta(wo), om = dot(wo, m), im = dot(wi, m), sum = om + n * im;
        return n * n * std::fabs(im) / std::max(sum * sum, 1e-300);
    }
};

void add_of_boundary(std::vector<Factor>& out, double below_over_above) {
    const SeenBoundary b{below_over_above};
    const auto add = [&](const char* name, auto refraction, auto reflection) {
        out.push_back(
            {name, [=](Vec3d o, Vec3d i) { return b.is_across(o, i) ? refraction(o, i) : reflection(o, i); }});
    };
    const auto unity = [](Vec3d, Vec3d) { return 1.0; };
    const auto om = [b](Vec3d o, Vec3d i) { return std::fabs(dot(o, b.half_vector(o, i))); };
    const auto im = [b](Vec3d o, Vec3d i) { return std::fabs(dot(i, b.half_vector(o, i))); };
    const auto transmittance = [b](Vec3d o, Vec3d i) { return 1 - b.fresnel(o, i); };
    const auto reflectance = [b](Vec3d o, Vec3d i) { return b.fresnel(o, i); };
    const auto odds = [b](Vec3d o, Vec3d i) {
        const double f = b.fresnel(o, i);
        return f > 0 && f < 1 ? (1 - f) / f : 0;
    };
    add("eta^2 across the surface", [b](Vec3d o, Vec3d) { return b.eta(o) * b.eta(o); }, unity);
    add("Fresnel (1 - F across the surface)", transmittance, reflectance);
    add("1 - Fresnel of what is refracted", transmittance, unity);
    add("Fresnel of what is reflected", unity, reflectance);
    add(
        "Fresnel exchanged with 1 - Fresnel",
        [odds](Vec3d o, Vec3d i) {
            const double v = odds(o, i);
            return v > 0 ? 1 / v : 0;
        },
        odds);
    add("the Jacobian of refraction", [b](Vec3d o, Vec3d i) { return b.refraction_jacobian(o, i); }, unity);
    add(
        "the Jacobian of refraction for that of reflection",
        [b, om](Vec3d o, Vec3d i) { return 4 * om(o, i) * b.refraction_jacobian(o, i); }, unity);
    add(
        "(w_i.m) / (w_o.m) of what is refracted",
        [om, im](Vec3d o, Vec3d i) { return im(o, i) / std::max(om(o, i), 1e-12); }, unity);
    add("w_i.m of what is refracted", im, unity);
    add("cos theta_i of what is refracted", [](Vec3d, Vec3d i) { return std::fabs(i.z); }, unity);
}

void add_of_light(std::vector<Factor>& out, const CaseLighting& light) {
    if (light.disks.size() != 1 || !light.area_lights.empty()) return;
    const CaseDiskLight disk = light.disks[0];
    out.push_back({"cosine at the light", [disk](Vec3d, Vec3d i) { return std::max(-dot(i, disk.normal), 0.0); }});
    out.push_back({"distance^2 / cosine at the light", [disk](Vec3d, Vec3d i) {
                       const std::optional<double> d = disk.distance(i);
                       return d ? *d * *d / -dot(i, disk.normal) : 0;
                   }});
}

}  // namespace

Vec3d half_vector_of(Vec3d wo, Vec3d wi, double eta) {
    const Vec3d sum = wo.z * wi.z < 0 ? wo + wi * eta : wo + wi;
    const double size = std::sqrt(dot(sum, sum));
    return size > 1e-12 ? sum * (1 / size) : Vec3d{0, 0, 1};
}

std::vector<Factor> factors_for(const Traits& traits, const CaseLighting& light) {
    if (traits.domain) return domain_factors(traits.domain);
    const bool has_one_index = traits.eta && traits.eta->x == traits.eta->z;
    const double eta = has_one_index ? traits.eta->x : 1;
    const auto half_vector = [eta](Vec3d o, Vec3d i) { return half_vector_of(o, i, o.z > 0 ? eta : 1 / eta); };
    const auto om = [half_vector](Vec3d o, Vec3d i) { return std::fabs(dot(o, half_vector(o, i))); };
    const auto nm = [half_vector](Vec3d o, Vec3d i) { return std::fabs(half_vector(o, i).z); };
    std::vector<Factor> out = {{"cos theta_i", [](Vec3d, Vec3d i) { return std::fabs(i.z); }},
        {"sin theta_i", [](Vec3d, Vec3d i) { return std::sqrt(i.x * i.x + i.y * i.y); }}};
    if (traits.wo != Traits::WoDomain::none) {
        out.push_back({"a constant across the surface",
            [](Vec3d o, Vec3d i) { return o.z * i.z < 0 ? math::exp(1.0) : 1.0; }, 1, true});
        out.push_back({"w_o.m", om, 4});
        out.push_back({"n.m", nm});
        out.push_back({"(n.m) / (w_o.m)", [=](Vec3d o, Vec3d i) { return nm(o, i) / std::max(om(o, i), 1e-12); }});
        out.push_back({"w_i.R", [](Vec3d o, Vec3d i) { return std::max(dot(i, mirror(o)), 0.0); }});
    }
    if (has_one_index) add_of_boundary(out, eta);
    add_of_light(out, light);
    return out;
}

std::string number_name(double value, double precision, const Traits& traits) {
    constexpr double pi = two_pi / 2;
    std::vector<std::pair<std::string, double>> constants = {
        {"2", 2}, {"4", 4}, {"pi", pi}, {"2 pi", 2 * pi}, {"4 pi", 4 * pi}, {"pi/2", pi / 2}, {"2 pi^2", 2 * pi * pi}};
    if (traits.eta && traits.eta->x == traits.eta->z) constants.push_back({"eta^2", traits.eta->x * traits.eta->x});
    for (const auto& [name, number] : constants) {
        if (std::fabs(number - 1) < 10 * precision) continue;
        if (std::fabs(value / number - 1) < precision) return name;
        if (name == "pi/2" && std::fabs(value * number - 1) < precision) return "2/pi";
        if (std::fabs(value * number - 1) < precision)
            return name.find_first_of(" /") == std::string::npos ? "1/" + name : "1/(" + name + ")";
    }
    return "";
}

// ---- The exponent is fitted by least squares of logarithms without the tenth with the largest residuals; the
// criterion is the share of ratios that agree with the nearest simple exponent.

namespace {

double median(std::vector<double> v) {
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
}

/// The slope of y over x after removing, twice, the tenth with the largest residuals.
double slope_of(std::vector<std::pair<double, double>> points) {
    double slope = 0;
    for (int round = 0; round < 3; ++round) {
        const double n = static_cast<double>(points.size());
        double x = 0, y = 0, xx = 0, xy = 0;
        for (const auto& [a, b] : points) {
            x += a / n;
            y += b / n;
        }
        for (const auto& [a, b] : points) {
            xx += (a - x) * (a - x);
            xy += (a - x) * (b - y);
        }
        if (!(xx > 1e-6 * n)) return 0;
        slope = xy / xx;
        const auto residual = [&](const auto& p) { return std::fabs(p.second - y - slope * (p.first - x)); };
        std::ranges::sort(points, {}, residual);
        points.resize(points.size() * 9 / 10);
    }
    return slope;
}

/// Fits ln ratio = ln constant + exponent x: the constant, and the share of ratios that agree.
RatioCause fit_constant(const std::vector<double>& logs, const std::vector<double>& x, double exponent,
    double tolerance, std::span<const KnownRatio> ratios) {
    std::vector<double> residuals;
    for (std::size_t i = 0; i < logs.size(); ++i) residuals.push_back(logs[i] - exponent * x[i]);
    double middle = median(residuals), agreements = 0;
    if (std::fabs(middle) < tolerance / 2) middle = 0;
    for (std::size_t i = 0; i < residuals.size(); ++i)
        agreements += std::fabs(residuals[i] - middle) < tolerance + 2 * ratios[i].error;
    return {.name = "",
        .exponent = exponent,
        .constant = math::exp(middle),
        .explained_share = agreements / static_cast<double>(residuals.size())};
}

}  // namespace

std::optional<RatioCause> explain_ratios(std::span<const KnownRatio> ratios, std::span<const Factor> factors) {
    std::vector<double> logs;
    for (const KnownRatio& r : ratios) logs.push_back(r.value > 0 && std::isfinite(r.value) ? math::log(r.value) : 1e3);
    if (logs.size() < fewest_ratios) return {};
    if (2 * std::ranges::count_if(logs, [](double v) { return std::fabs(v) < same_number; }) >
        static_cast<std::ptrdiff_t>(logs.size()))
        return {};
    std::vector<double> sizes;
    for (double v : logs) sizes.push_back(std::fabs(v));
    const double tolerance = std::min(agreement, part_that_agrees * median(sizes));
    RatioCause best = fit_constant(logs, logs, 0, tolerance, ratios);
    best.name = "constant";
    if (best.explained_share >= share_in_agreement) return best;
    bool is_ambiguous = false;
    for (const Factor& f : factors) {
        std::vector<double> x;
        std::vector<std::pair<double, double>> points;
        for (std::size_t i = 0; i < ratios.size(); ++i) {
            const double g = f.value(ratios[i].wo, ratios[i].wi);
            x.push_back(g > 0 ? math::log(g) : 1e3);
            if (g > 0 && logs[i] < 100) points.emplace_back(x[i], logs[i]);
        }
        if (points.size() < fewest_ratios) continue;
        const double b = slope_of(std::move(points)), simple_exponent = std::round(2 * b) / 2;
        if (simple_exponent == 0 || std::fabs(b - simple_exponent) > half_tolerance) continue;
        RatioCause cause = fit_constant(logs, x, simple_exponent, tolerance, ratios);
        if (cause.explained_share < share_in_agreement) continue;
        cause.name = f.name;
        is_ambiguous =
            best.explained_share >= share_in_agreement && cause.explained_share > best.explained_share - better_share;
        if (cause.explained_share > best.explained_share + better_share || best.explained_share < share_in_agreement)
            best = cause;
    }
    return best.explained_share >= share_in_agreement && !is_ambiguous ? std::optional(best) : std::nullopt;
}

}  // namespace crescent::check
