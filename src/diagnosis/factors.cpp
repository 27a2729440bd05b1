// The factors that people forget, double or exchange, at one w_o. m is the half vector, R the mirror direction.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "diagnosis/diagnosis.h"
#include "lobes/all.h"
#include "math/functions.h"

namespace crescent::inline diagnosis {

namespace {

std::optional<double> parameter(const TrialContext& work, std::string_view name) {
    for (const auto& [key, value] : work.trial.parameters)
        if (key == name) return value;
    return {};
}

/// "(s+1)", but not "(n.m) / (w_o.m)".
bool in_brackets(const std::string& s) { return s.front() == '(' && s.find(')') == s.size() - 1; }

/// "1 / n.m", "1 / (cos theta_i)"; of "(n.m) / (w_o.m)" it is "(w_o.m) / (n.m)".
std::string one_over(const std::string& name) {
    if (const std::size_t slash = name.find(") / ("); slash != std::string::npos)
        return name.substr(slash + 4) + " / " + name.substr(0, slash + 1);
    return "1 / " + (name.find(' ') == std::string::npos || in_brackets(name) ? name : "(" + name + ")");
}

/// A factor and its inverse: forgotten, or counted once too often.
void add(std::vector<Factor>& out, const std::string& name, std::function<double(Vec3d)> g) {
    out.push_back({name, g});
    out.push_back({one_over(name), [g](Vec3d w) {
                       const double v = g(w);
                       return v > 0 ? 1 / v : 0;
                   }});
}

/// Reflection and refraction at a boundary whose index is told. Walter et al. 2007, (13), (14), (16), (17), (22).
struct Boundary {
    Vec3d wo;
    double eta;  // beyond over here
    bool across(Vec3d wi) const { return wo.z * wi.z < 0; }
    Vec3d half(Vec3d wi) const { return half_vector(wo, wi, eta); }
    double fresnel(Vec3d wi) const {
        const double c = std::fabs(dot(wo, half(wi))), g2 = eta * eta - 1 + c * c;
        if (g2 <= 0) return 1;
        const double g = std::sqrt(g2), one = (g - c) / (g + c), two = (c * (g + c) - 1) / (c * (g - c) + 1);
        return 0.5 * one * one * (1 + two * two);
    }
    double refracted(Vec3d wi) const {
        const Vec3d m = half(wi);
        const double om = dot(wo, m), im = dot(wi, m);
        return eta * eta * std::fabs(im) / std::max(sqr(om + eta * im), 1e-300);
    }
};

std::optional<Boundary> boundary_of(const TrialContext& work) {
    if (!work.traits.eta || work.traits.eta->x != work.traits.eta->z) return {};
    const double eta = work.traits.eta->x;
    return Boundary{work.trial.wo, work.trial.wo.z > 0 ? eta : 1 / eta};
}

void add_microfacets(std::vector<Factor>& out, const TrialContext& work) {
    const Vec3d wo = work.trial.wo, r = mirror(wo);
    // Of index 1 where none is told: then m across the surface is not known, and on one side it is as with any.
    const auto half = [b = boundary_of(work), wo](Vec3d wi) { return b ? b->half(wi) : Boundary{wo, 1}.half(wi); };
    add(out, "4 (w_o.m)", [=](Vec3d wi) { return 4 * std::fabs(dot(wo, half(wi))); });
    add(out, "(n.m) / (w_o.m)",
        [=](Vec3d wi) { return std::fabs(half(wi).z) / std::max(std::fabs(dot(wo, half(wi))), 1e-12); });
    add(out, "n.m", [=](Vec3d wi) { return std::fabs(half(wi).z); });
    add(out, "w_i.R", [=](Vec3d wi) { return dot(wi, r); });
    std::vector<double> alphas = {0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1};
    if (const std::optional<double> alpha = parameter(work, "alpha")) alphas = {*alpha};
    for (double alpha : alphas)
        add(out, "G1(w_i)", [alpha](Vec3d wi) { return wi.z > 0 ? Ggx<double>{alpha}.G1(wi) : 0; });
}

void add_light(std::vector<Factor>& out, const TrialContext& work) {
    if (work.trial.light.disks.size() != 1 || !work.trial.light.lamps.empty()) return;
    const TrialDisk disk = work.trial.light.disks[0];
    add(out, "cosine at the light", [disk](Vec3d wi) { return -dot(wi, disk.normal); });
    add(out, "distance^2 / cosine at the light", [disk](Vec3d wi) {
        const std::optional<double> d = disk.distance(wi);
        return d ? *d * *d / -dot(wi, disk.normal) : 0;
    });
}

}  // namespace

Vec3d half_vector(Vec3d wo, Vec3d wi, double eta) {
    const Vec3d sum = wo.z * wi.z < 0 ? wo + wi * eta : wo + wi;
    const double size = length(sum);
    return size > 1e-12 ? sum * (1 / size) : Vec3d{0, 0, 1};
}

std::vector<Factor> factors_of_side(const TrialContext& work, bool across) {
    std::vector<Factor> out = {{"a constant", [](Vec3d) { return 1.0; }}};
    const std::optional<Boundary> b = boundary_of(work);
    if (!b) return out;
    const auto om = [b = *b](Vec3d w) { return std::fabs(dot(b.wo, b.half(w))); };
    add(out, "Fresnel", [b = *b](Vec3d w) { return b.fresnel(w); });
    add(out, "cos theta_i", [](Vec3d w) { return std::fabs(w.z); });
    add(out, "1 - Fresnel", [b = *b](Vec3d w) { return 1 - b.fresnel(w); });
    const auto nm = [b = *b](Vec3d w) { return std::fabs(b.half(w).z); };
    if (!across) {
        add(out, "4 (w_o.m)", [om](Vec3d w) { return 4 * om(w); });
        add(out, "n.m", nm);
        return out;
    }
    add(out, "(w_o.m) / (w_i.m)",
        [b = *b, om](Vec3d w) { return om(w) / std::max(std::fabs(dot(w, b.half(w))), 1e-12); });
    add(out, "the Jacobian of refraction", [b = *b](Vec3d w) { return b.refracted(w); });
    add(out, "the Jacobian of refraction for that of reflection",
        [b = *b, om](Vec3d w) { return 4 * om(w) * b.refracted(w); });
    add(out, "w_i.m", [b = *b](Vec3d w) { return std::fabs(dot(w, b.half(w))); });
    add(out, "n.m", nm);
    return out;
}

std::vector<Factor> usual_factors(const TrialContext& work) {
    std::vector<Factor> out = {{"a constant", [](Vec3d) { return 1.0; }}};
    const auto sin = [](Vec3d w) { return std::sqrt(std::max(1 - w.z * w.z, 0.0)); };
    add(out, "cos theta_i", [](Vec3d w) { return std::fabs(w.z); });
    add(out, "sin theta_i", sin);
    const double cos_o = std::fabs(work.trial.wo.z);
    add(out, "cos theta_i / cos theta_o", [=](Vec3d w) { return std::fabs(w.z) / cos_o; });
    add_microfacets(out, work);
    add_light(out, work);
    const std::optional<Boundary> b = boundary_of(work);
    if (!b) return out;
    add(out, "Fresnel", [b = *b](Vec3d w) { return b.across(w) ? 1 - b.fresnel(w) : b.fresnel(w); });
    out.push_back({"the chooser's 1 - Fresnel for Fresnel",
        [b = *b](Vec3d w) {
            const double f = b.fresnel(w), mirrored = f > 0 ? (1 - f) / f : 0;
            return !b.across(w) ? mirrored : mirrored > 0 ? 1 / mirrored : 0;
        },
        true});
    return out;
}

namespace {

/// "1/pi", "1/(2 pi)", "(s+1)/(s+2)" for (s+2)/(s+1), "cos theta_o" for 1/(cos theta_o).
std::string inverse_of(const std::string& name) {
    const auto bare = [](const std::string& s) { return in_brackets(s) ? s.substr(1, s.size() - 2) : s; };
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) return "1/" + (name.find(' ') == std::string::npos ? name : "(" + name + ")");
    const std::string over = name.substr(0, slash), under = name.substr(slash + 1);
    return over == "1" ? bare(under) : under + "/" + over;
}

/// What is not drawn as a density is taken for part of it, or taken off twice. The bins know a constant to 0.3 %.
std::string name_of_share(const Density& d, double c) {
    constexpr double close = 3e-3;
    const double above = 1 - d.nothing;
    const char* share = d.delta == 0 ? "the share of draws that are not nothing"
        : d.delta == d.nothing       ? "the share of draws that are of no delta part"
                                     : "the share of draws that are neither nothing nor of a delta part";
    if (!(above > 0.02 && above < 0.98)) return "";
    if (std::fabs(c * above - 1) < close) return std::string("1 / ") + share;
    return std::fabs(c / above - 1) < close ? share : "";
}

}  // namespace

std::string name_of_constant(const TrialContext& work, double c, double known_to) {
    std::vector<std::pair<std::string, double>> known = {
        {"2", 2}, {"4", 4}, {"pi", pi}, {"2 pi", 2 * pi}, {"4 pi", 4 * pi}, {"pi/2", pi / 2}, {"2 pi^2", 2 * pi * pi}};
    if (const std::optional<double> s = parameter(work, "s")) {
        known.push_back({"(s+2)/(s+1)", (*s + 2) / (*s + 1)});
        known.push_back({"(s+2)/(s+1)^2", (*s + 2) / sqr(*s + 1)});
    }
    if (const std::optional<double> alpha = parameter(work, "alpha"))
        known.push_back({"1/G1(w_o)", 1 / Ggx<double>{*alpha}.G1(work.trial.wo)});
    known.push_back({"1/(cos theta_o)", 1 / std::fabs(work.trial.wo.z)});
    for (const auto& [name, eta] :
        {std::pair("eta^2 with eta = 1.5", 1.5), {"eta^2 with eta = 1.33", 1.33}, {"eta^2 with eta = 1.8", 1.8}})
        known.push_back({name, eta * eta});
    for (int t = 0; t < work.subject.techniques(); ++t)
        if (const std::string share = name_of_share(work.density(t), c); !share.empty()) return share;
    for (const auto& [name, value] : known) {
        if (std::fabs(value - 1) < 1e-3) continue;
        if (std::fabs(c / value - 1) < known_to) return name;
        if (std::fabs(c * value - 1) < known_to) return inverse_of(name);
    }
    return "";
}

std::string factor_text(const TrialContext& work, const std::string& name, double constant) {
    const std::string known = name_of_constant(work, constant);
    const std::string figures = fmt::format("{:.5g}", constant),
                      number = figures + (known.empty() || known == figures ? "" : " = " + known);
    if (name == "a constant") return "a constant " + number;
    return std::fabs(constant - 1) < 2e-3 ? name : fmt::format("{} and a constant {}", name, number);
}

}  // namespace crescent::inline diagnosis
