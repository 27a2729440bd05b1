// Right samplers of kinds that renderers use, written after the engine and used for no choice in it: lights and sky
// maps by discrete choices, lights by solid angle, coats and panes with delta parts, samplers that return only weights,
// one-sample MIS, rough glass, bounded visible normals, stretched and singular densities.
#include <fmt/format.h>

#include "tests/calibration/axial.h"
#include "tests/calibration/cases.h"
#include "tests/calibration/microfacets.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;

template <class F> Sampler sampler_with(std::string text, int numbers, Wo wo, Functions<F> functions) {
    Sampler s;
    s.parameters = std::move(text);
    s.numbers = numbers;
    s.wo = wo;
    s.functions = std::move(functions);
    return s;
}

/// A sampler whose draws have a weight, and perhaps no pdf, or delta parts. Vectors and numbers are of type F.
template <class F> Sampler weighted(std::string text, Traits traits, std::function<Draw(Vec3<F> wo, const F* u)> sample,
    std::function<F(Vec3<F> wo, Vec3<F> wi)> pdf, std::function<F(Vec3<F> wo, Vec3<F> wi)> f) {
    Sampler s = sampler_with<F>(text, traits.numbers, traits.wo, Functions<F>{});
    traits.bits = sizeof(F) == 4 ? 24 : 53;
    SyntheticSampler recipe;
    recipe.parameters = std::move(text);
    recipe.traits = traits;
    recipe.sample = [sample](Vec3d wo, const PrimarySample& u) {
        F numbers[PrimarySample::most_numbers];
        for (int k = 0; k < PrimarySample::most_numbers; ++k) numbers[k] = static_cast<F>(u[k]);
        return sample(cast<F>(wo), numbers);
    };
    recipe.pdf = [pdf](Vec3d wo, Vec3d wi) { return pdf ? double(pdf(cast<F>(wo), cast<F>(wi))) : 0; };
    recipe.f = [f](Vec3d wo, Vec3d wi) { return double(f(cast<F>(wo), cast<F>(wi))); };
    s.given = make_adapter(std::move(recipe));
    return s;
}

// ---- Discrete choices.

/// The method of Vose 1991.
struct AliasTable {
    std::vector<double> keep;
    std::vector<std::size_t> other;
    explicit AliasTable(const std::vector<double>& mass) : keep(mass.size(), 1), other(mass.size()) {
        double sum = 0;
        for (double m : mass) sum += m;
        std::vector<std::size_t> small, large;
        for (std::size_t k = 0; k < mass.size(); ++k) {
            keep[k] = mass[k] / sum * double(mass.size());
            other[k] = k;
            (keep[k] < 1 ? small : large).push_back(k);
        }
        while (!small.empty() && !large.empty()) {
            const std::size_t s = small.back(), l = large.back();
            small.pop_back();
            other[s] = l;
            if ((keep[l] -= 1 - keep[s]) < 1) {
                large.pop_back();
                small.push_back(l);
            }
        }
        for (std::size_t k : small) keep[k] = 1;
        for (std::size_t k : large) keep[k] = 1;
    }
    /// With a number of its own for the decision to keep an entry.
    std::size_t choice(double u, double v) const {
        const std::size_t k = std::min(std::size_t(u * double(keep.size())), keep.size() - 1);
        return v < keep[k] ? k : other[k];
    }
    /// By one number.
    std::size_t choice(double u) const {
        const double at = u * double(keep.size());
        return choice(u, at - std::floor(at));
    }
};

std::vector<double> cumulative(const std::vector<double>& mass) {
    std::vector<double> out = {0};
    for (double m : mass) out.push_back(out.back() + m);
    for (double& v : out) v /= out.back();
    return out;
}
/// The entry that contains u, and u rescaled within it.
std::pair<std::size_t, double> entry_of(const std::vector<double>& sums, double u) {
    const auto k = std::size_t(std::clamp<std::ptrdiff_t>(
        std::upper_bound(sums.begin(), sums.end(), u) - sums.begin() - 1, 0, std::ptrdiff_t(sums.size()) - 2));
    return {k, std::clamp((u - sums[k]) / (sums[k + 1] - sums[k]), 0.0, 1 - 1e-7)};
}

/// Spherical lights in all directions, each by the cone that it fills; they may overlap.
enum class Choosing { alias, alias_by_one_number, search, search_and_reuse };
template <class F, Choosing how> Sampler lights_by_cone(Rng& d) {
    const int n = d.whole(0, 1) ? d.whole(2, 8) : d.whole(9, 96);
    std::vector<Lobe<F>> all;
    std::vector<double> power;
    for (int k = 0; k < n; ++k) {
        power.push_back(d.log(0.01, 1));
        const Vec3d axis = d.direction(-1, 1);
        all.push_back({F(0), fixed<F>(axis), cone_profile<F>(F(d.log(1e-4, 0.4)))});
    }
    double sum = 0;
    for (double p : power) sum += p;
    for (std::size_t k = 0; k < all.size(); ++k) all[k].weight = F(power[k] / sum);
    Functions<F> out;
    out.pdf = [all](Vec3<F> o, Vec3<F> w) {
        F p = 0;
        for (const Lobe<F>& l : all) p += l.weight * l.profile.density(versine(l.axis(o), w));
        return p;
    };
    out.sample = [all, alias = AliasTable(power), sums = cumulative(power), pdf = out.pdf](Vec3<F> o, const F* u) {
        std::size_t k = 0;
        F across = u[0];
        if (how == Choosing::alias) k = alias.choice(double(u[2]), double(u[3]));
        else if (how == Choosing::alias_by_one_number) k = alias.choice(double(u[2]));
        else if (how == Choosing::search) k = entry_of(sums, double(u[2])).first;
        else {
            const auto [entry, rest] = entry_of(sums, double(u[0]));
            k = entry;
            across = F(rest);
        }
        const Vec3<F> w = off_axis(all[k].axis(o), all[k].profile.t(across), u[1]);
        return Drawn<F>{w, pdf(o, w)};
    };
    constexpr int numbers = how == Choosing::alias ? 4 : how == Choosing::search_and_reuse ? 2 : 3;
    return sampler_with<F>(fmt::format("{} lights", n), numbers, Wo::none, out);
}

/// The equal-area map of Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD".
template <class F> Vec3<F> sphere_of_square(F x, F y) {
    const F u = 2 * x - 1, v = 2 * y - 1, a = std::fabs(u), b = std::fabs(v), d = 1 - (a + b), r = 1 - std::fabs(d);
    const F phi = (r == 0 ? 1 : (b - a) / r + 1) * pi_of<F> / 4, s = r * std::sqrt(2 - r * r);
    return {std::copysign(std::cos(phi), u) * s, std::copysign(std::sin(phi), v) * s, std::copysign(1 - r * r, d)};
}
template <class F> std::pair<F, F> square_of_sphere(Vec3<F> w) {
    const F x = std::fabs(w.x), y = std::fabs(w.y), r = std::sqrt(std::max(1 - std::fabs(w.z), F(0)));
    const F phi = std::atan2(y, x) * 2 / pi_of<F>;
    F v = phi * r, u = r - v;
    if (w.z < 0) {
        std::swap(u, v);
        u = 1 - u;
        v = 1 - v;
    }
    return {(std::copysign(u, w.x) + 1) / 2, (std::copysign(v, w.y) + 1) / 2};
}
/// A sky on that map. Most cells are empty; u[0] selects the row and u[1] the column, or an alias table selects a cell.
template <class F, bool by_alias> Sampler sparse_sky(Rng& d) {
    const int n = 1 << d.whole(3, 6);
    const double empty = d.uniform(0.5, 0.95), contrast = d.log(1.5, 100);
    std::vector<double> mass;
    for (int k = 0; k < n * n; ++k) mass.push_back(d.uniform(0, 1) < empty ? 0 : d.log(1, contrast));
    mass[std::size_t(d.whole(0, n * n - 1))] = contrast;
    double sum = 0;
    for (double m : mass) sum += m;
    std::vector<double> of_rows;
    std::vector<std::vector<double>> columns;
    for (int i = 0; i < n; ++i) {
        const std::vector<double> row(mass.begin() + i * n, mass.begin() + (i + 1) * n);
        columns.push_back(cumulative(row));
        of_rows.push_back(0);
        for (double m : row) of_rows.back() += m;
    }
    Functions<F> out;
    out.pdf = [mass, n, per_sr = n * n / (sum * 4 * pi_of<double>)](Vec3<F>, Vec3<F> w) {
        const auto [x, y] = square_of_sphere(w);
        const int i = std::clamp(int(y * F(n)), 0, n - 1), j = std::clamp(int(x * F(n)), 0, n - 1);
        return F(mass[std::size_t(i * n + j)] * per_sr);
    };
    out.sample = [=, alias = AliasTable(mass), rows = cumulative(of_rows), pdf = out.pdf](Vec3<F> o, const F* u) {
        F y = 0, x = 0;
        if (by_alias) {
            const auto k = int(alias.choice(double(u[2]), double(u[3])));
            y = F(k / n) + u[0];
            x = F(k % n) + u[1];
        } else {
            const auto [i, dy] = entry_of(rows, double(u[0]));
            const auto [j, dx] = entry_of(columns[i], double(u[1]));
            y = F(i) + F(dy);
            x = F(j) + F(dx);
        }
        const Vec3<F> w = sphere_of_square(x / F(n), y / F(n));
        return Drawn<F>{w, pdf(o, w)};
    };
    return sampler_with<F>(fmt::format("{0} x {0} cells, {1:.2f} empty", n, empty), by_alias ? 4 : 2, Wo::none, out);
}

// ---- Lights by solid angle. Computed in double; in single precision directions and densities are rounded.

template <class F> Functions<F> in_precision(Functions<double> exact) {
    if constexpr (sizeof(F) == 8) return exact;
    else return rounded(std::move(exact));
}
/// Uniform over the directions w with n . w >= 0 for all `sides` n of a spherical polygon.
template <class F> Sampler polygon_light(
    std::string text, double solid_angle, std::vector<Vec3d> sides, std::function<Vec3d(const double* u)> direction) {
    const double margin = sizeof(F) == 4 ? 2e-7 : 1e-13;
    Functions<double> out;
    out.pdf = [=](Vec3d, Vec3d w) {
        for (Vec3d n : sides)
            if (dot(n, w) < -margin) return 0.0;
        return 1 / solid_angle;
    };
    out.sample = [=](Vec3d, const double* u) { return Drawn<double>{direction(u), 1 / solid_angle}; };
    return sampler_with<F>(std::move(text), 2, Wo::none, in_precision<F>(out));
}
double angle_between(Vec3d a, Vec3d b) { return std::acos(std::clamp(dot(a, b), -1.0, 1.0)); }

/// Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles".
template <class F> Sampler rectangle_by_solid_angle(Rng& d) {
    const Frame<double> frame = frame_about(d.direction(-1, 1));
    const double height = d.log(0.2, 2), wide = d.log(0.1, 3), deep = d.log(0.1, 3), x0 = d.uniform(-2, 1),
                 y0 = d.uniform(-2, 1), x1 = x0 + wide, y1 = y0 + deep, z0 = -height;
    const Vec3d v00{x0, y0, z0}, v01{x0, y1, z0}, v10{x1, y0, z0}, v11{x1, y1, z0};
    const Vec3d n0 = unit(cross(v00, v10)), n1 = unit(cross(v10, v11)), n2 = unit(cross(v11, v01)),
                n3 = unit(cross(v01, v00));
    const double g0 = angle_between(-n0, n1), g1 = angle_between(-n1, n2), g2 = angle_between(-n2, n3),
                 g3 = angle_between(-n3, n0), pi = pi_of<double>, solid_angle = g0 + g1 + g2 + g3 - 2 * pi;
    const Vec3d middle = unit(v00 + v01 + v10 + v11);
    std::vector<Vec3d> sides;
    for (Vec3d n : {n0, n1, n2, n3}) sides.push_back(frame.to_world(n * (dot(n, middle) > 0 ? 1.0 : -1.0)));
    const auto direction = [=](const double* u) {
        const double b0 = n0.z, b1 = n2.z, au = u[0] * (g0 + g1 - 2 * pi) + (u[0] - 1) * (g2 + g3);
        const double fu = (std::cos(au) * b0 - b1) / std::sin(au);
        const double cu = std::clamp(std::copysign(1 / std::sqrt(fu * fu + b0 * b0), fu), -1.0, 1.0);
        const double x = std::clamp(-(cu * z0) / std::sqrt(std::max(1 - cu * cu, 1e-300)), x0, x1);
        const double dd = std::hypot(x, z0), h0 = y0 / std::hypot(dd, y0), h1 = y1 / std::hypot(dd, y1);
        const double h = h0 + u[1] * (h1 - h0), y = h * h < 1 - 1e-12 ? h * dd / std::sqrt(1 - h * h) : y1;
        return frame.to_world(unit(Vec3d{x, y, z0}));
    };
    return polygon_light<F>(
        fmt::format("{:.2f} x {:.2f} at {:.2f} m", wide, deep, height), solid_angle, sides, direction);
}

/// Arvo 1995, "Stratified Sampling of Spherical Triangles".
template <class F> Sampler triangle_by_solid_angle(Rng& d) {
    const Vec3d middle = d.direction(-1, 1);
    const double spread = d.log(0.1, 1);
    Vec3d a, b, c;
    double solid_angle = 0, alpha = 0;
    do {
        a = unit(middle + d.direction(-1, 1) * spread);
        b = unit(middle + d.direction(-1, 1) * spread);
        c = unit(middle + d.direction(-1, 1) * spread);
        if (dot(cross(a, b), c) < 0) std::swap(b, c);
        const Vec3d ab = unit(cross(a, b)), bc = unit(cross(b, c)), ca = unit(cross(c, a));
        alpha = angle_between(ab, -ca);
        solid_angle = alpha + angle_between(bc, -ab) + angle_between(ca, -bc) - pi_of<double>;
    } while (!(solid_angle > 2e-3));
    const auto towards = [](Vec3d v, Vec3d from) { return unit(v - from * dot(v, from)); };
    const auto direction = [=](const double* u) {
        const double area = pi_of<double> + u[0] * solid_angle, ca = std::cos(alpha), sa = std::sin(alpha);
        const double sin = std::sin(area) * ca - std::cos(area) * sa, cos = std::cos(area) * ca + std::sin(area) * sa;
        const double k1 = cos + ca, k2 = sin - sa * dot(a, b);
        const double cb = std::clamp((k2 + (k2 * cos - k1 * sin) * ca) / ((k2 * sin + k1 * cos) * sa), -1.0, 1.0);
        const Vec3d on_side = a * cb + towards(c, a) * std::sqrt(1 - cb * cb);
        const double z = 1 - u[1] * (1 - dot(on_side, b));
        return unit(b * z + towards(on_side, b) * std::sqrt(std::max(0.0, 1 - z * z)));
    };
    return polygon_light<F>(fmt::format("{:.3f} sr", solid_angle), solid_angle,
        {unit(cross(a, b)), unit(cross(b, c)), unit(cross(c, a))}, direction);
}

// ---- Delta parts.

/// The reflected share at an interface of index eta, from above. c: cosine of incidence.
template <class F> F fresnel(F c, F eta) {
    const F s2 = (1 - c * c) / (eta * eta);
    if (s2 >= 1) return 1;
    const F t = std::sqrt(1 - s2), parallel = (eta * c - t) / (eta * c + t), across = (c - eta * t) / (c + eta * t);
    return (parallel * parallel + across * across) / 2;
}

/// A smooth coat over Lambert. u[2] selects the coat with probability F(w_o).
template <class F> Sampler coat(Rng& d) {
    const F eta = F(d.uniform(1.2, 1.9)), rho = F(d.uniform(0.1, 0.9));
    Traits t;
    t.numbers = 3;
    t.delta = true;
    const auto pdf = [eta](Vec3<F> o, Vec3<F> i) {
        return o.z > 0 && i.z > 0 ? (1 - fresnel(o.z, eta)) * i.z / pi_of<F> : F(0);
    };
    return weighted<F>(
        fmt::format("eta {:.3f}, albedo {:.3f}", double(eta), double(rho)), t,
        [=](Vec3<F> o, const F* u) {
            const F q = fresnel(o.z, eta);
            Draw out;
            if (u[2] < q) {
                out.wi = widened(Vec3<F>{-o.x, -o.y, o.z});
                out.delta = double(q);
                out.weight = 1;
                return out;
            }
            const Vec3<F> i = cosine_weighted(u[0], u[1]);
            out.wi = widened(i);
            out.pdf = double(pdf(o, i));
            out.weight = double(rho * (1 - fresnel(i.z, eta)));
            return out;
        },
        pdf,
        [=](Vec3<F> o, Vec3<F> i) {
            return o.z > 0 && i.z > 0 ? rho / pi_of<F> * (1 - fresnel(o.z, eta)) * (1 - fresnel(i.z, eta)) : F(0);
        });
}
/// A pane that reflects, transmits straight, and scatters the rest on the side of w_o.
template <class F> Sampler pane(Rng& d) {
    const F mirror = F(d.uniform(0.05, 0.4)), through = F(d.uniform(0.05, 0.5)), rho = F(d.uniform(0.1, 0.9));
    const F rest = 1 - mirror - through;
    Traits t;
    t.numbers = 3;
    t.delta = true;
    t.wo = Wo::both;
    const auto pdf = [rest](Vec3<F> o, Vec3<F> i) { return o.z * i.z > 0 ? rest * std::fabs(i.z) / pi_of<F> : F(0); };
    return weighted<F>(
        fmt::format("{:.3f}, {:.3f}", double(mirror), double(through)), t,
        [=](Vec3<F> o, const F* u) {
            Draw out;
            if (u[2] < mirror + through) {
                const bool reflects = u[2] < mirror;
                out.wi = reflects ? widened(Vec3<F>{-o.x, -o.y, o.z}) : widened(-o);
                out.delta = double(reflects ? mirror : through);
                out.weight = 1;
                return out;
            }
            Vec3<F> i = cosine_weighted(u[0], u[1]);
            if (o.z < 0) i.z = -i.z;
            out.wi = widened(i);
            out.pdf = double(pdf(o, i));
            out.weight = double(rho);
            return out;
        },
        pdf, [=](Vec3<F> o, Vec3<F> i) { return o.z * i.z > 0 ? rest * rho / pi_of<F> : F(0); });
}

// ---- Weights without a pdf.

enum class Method { cosine, uniform, visible_normals };
template <class F, Method method> Sampler only_weights(Rng& d) {
    const F rho = F(d.uniform(0.1, 0.9));
    const Ggx2<F> g{F(d.log(0.1, 1)), F(d.log(0.1, 1))};
    Traits t;
    t.has_pdf = false;
    const std::function<F(Vec3<F>, Vec3<F>)> f = [=](Vec3<F> o, Vec3<F> i) {
        if (!(o.z > 0 && i.z > 0)) return F(0);
        return method == Method::visible_normals ? g.f(o, i) : rho / pi_of<F>;
    };
    return weighted<F>(
        fmt::format("albedo {:.3f}, alpha {:.3f} / {:.3f}", double(rho), double(g.ax), double(g.ay)), t,
        [=](Vec3<F> o, const F* u) {
            Draw out;
            Vec3<F> i = cosine_weighted(u[0], u[1]);
            F weight = rho;
            if (method == Method::uniform) {
                i = off_axis(Vec3<F>{0, 0, 1}, u[0], u[1]);
                weight = 2 * rho * i.z;
            }
            if (method == Method::visible_normals) {
                i = reflected(o, g.visible_normal(o, u[0], u[1]));
                if (!(i.z > 0)) return out;
                weight = (1 + g.lambda(o)) / (1 + g.lambda(o) + g.lambda(i));
            }
            out.wi = widened(i);
            out.pdf = 1;
            out.weight = double(weight);
            return out;
        },
        nullptr, f);
}

// ---- Mixtures, glass, and other densities.

/// One-sample MIS of a light and a cosine lobe.
template <class F> Sampler one_sample_mis(Rng& d) {
    const F share = F(d.uniform(0.1, 0.9)), rho = F(d.uniform(0.1, 0.9));
    const Vec3<F> axis = cast<F>(d.direction(0.5, 1));
    const Profile<F> light = cone_profile<F>(F(d.log(1e-4, 0.1)));
    Functions<F> out;
    out.pdf = [=](Vec3<F>, Vec3<F> i) {
        return share * light.density(versine(axis, i)) + (1 - share) * std::max(i.z, F(0)) / pi_of<F>;
    };
    out.f = [rho](Vec3<F> o, Vec3<F> i) { return o.z > 0 && i.z > 0 ? rho / pi_of<F> : F(0); };
    out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
        const Vec3<F> i = u[2] < share ? off_axis(axis, light.t(u[0]), u[1]) : cosine_weighted(u[0], u[1]);
        return Drawn<F>{i, pdf(o, i)};
    };
    return sampler_with<F>(fmt::format("share of the light {:.3f}", double(share)), 3, Wo::upper, out);
}

/// Walter et al. 2007 with visible normals; u[2] < F reflects.
template <class F> Sampler rough_glass(Rng& d) {
    const double alpha = d.log(0.05, 0.6), index = d.uniform(1.1, 2);
    const Ggx2<F> g{F(alpha), F(alpha)};
    // From above; below, everything is mirrored and the index inverted.
    const auto from_above = [g](Vec3<F> o, Vec3<F> i, F eta) {
        const bool reflects = i.z > 0;
        Vec3<F> m = unit(reflects ? o + i : o + i * eta);
        if (m.z < 0) m = -m;
        const F om = dot(o, m), im = dot(i, m);
        if (!(om > 0) || reflects != im > 0) return F(0);
        const F visible = g.D(m) * om / (1 + g.lambda(o)) / o.z, share = fresnel(om, eta);
        if (reflects) return share * visible / (4 * om);
        return (1 - share) * visible * eta * eta * std::fabs(im) / sqr(om + eta * im);
    };
    const F eta = F(index);
    const auto mirrored = [](Vec3<F> v) { return Vec3<F>{v.x, v.y, -v.z}; };
    Functions<F> out;
    out.pdf = [=](Vec3<F> o, Vec3<F> i) {
        if (o.z == 0 || i.z == 0) return F(0);
        return o.z > 0 ? from_above(o, i, eta) : from_above(mirrored(o), mirrored(i), 1 / eta);
    };
    out.sample = [=, pdf = out.pdf](Vec3<F> given, const F* u) {
        const bool below = given.z < 0;
        const Vec3<F> o = below ? mirrored(given) : given;
        const F n = below ? 1 / eta : eta;
        const Vec3<F> m = g.visible_normal(o, u[0], u[1]);
        const F om = dot(o, m);
        Vec3<F> i = reflected(o, m);
        const bool reflects = u[2] < fresnel(om, n);
        if (!reflects) {
            const F t2 = 1 - (1 - om * om) / (n * n);
            i = unit(m * (om / n - std::sqrt(std::max(t2, F(0)))) - o * (1 / n));
        }
        if (reflects != i.z > 0) return Drawn<F>{{0, 0, 1}, 0};
        if (below) i = mirrored(i);
        return Drawn<F>{i, pdf(given, i)};
    };
    Sampler s = sampler_with<F>(fmt::format("alpha {:.3f}, index {:.3f}", alpha, index), 3, Wo::both, out);
    s.eta = index;
    return s;
}

/// Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections"; draws below the surface are none.
template <class F> Sampler bounded_normals(Rng& d) {
    const double x = d.log(0.05, 1), y = d.whole(0, 1) ? x : d.log(0.05, 1);
    const Ggx2<F> g{F(x), F(y)};
    const auto bound = [g](Vec3<F> o) {
        const F a2 = sqr(std::min(g.ax, g.ay)), s2 = sqr(1 + std::hypot(o.x, o.y));
        return (1 - a2) * s2 / (s2 + a2 * o.z * o.z);
    };
    Functions<F> out;
    out.pdf = [=](Vec3<F> o, Vec3<F> i) {
        if (!(o.z > 0 && i.z > 0)) return F(0);
        const F t = std::sqrt(sqr(g.ax * o.x) + sqr(g.ay * o.y) + o.z * o.z);
        return g.D(unit(o + i)) / (2 * (bound(o) * o.z + t));
    };
    out.f = [g](Vec3<F> o, Vec3<F> i) { return g.f(o, i); };
    out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
        const Vec3<F> v = unit(Vec3<F>{g.ax * o.x, g.ay * o.y, o.z});
        const F b = bound(o) * v.z, z = (1 - u[1]) * (1 + b) - b, phi = 2 * pi_of<F> * u[0];
        const F s = std::sqrt(std::clamp(1 - z * z, F(0), F(1)));
        const Vec3<F> h = v + Vec3<F>{s * std::cos(phi), s * std::sin(phi), z};
        const Vec3<F> i = reflected(o, unit(Vec3<F>{g.ax * h.x, g.ay * h.y, h.z}));
        return i.z > 0 ? Drawn<F>{i, pdf(o, i)} : Drawn<F>{{0, 0, 1}, 0};
    };
    return sampler_with<F>(fmt::format("alpha {:.3f} / {:.3f}", x, y), 2, Wo::upper, out);
}

/// GGX by D with the plain formulas of textbooks: theta from atan, D from cos^2.
template <class F> Sampler textbook_ggx(Rng& d) {
    const F a = F(d.log(0.05, 0.8));
    const auto D = [a](F c) { return a * a / (pi_of<F> * sqr(c * c * (a * a - 1) + 1)); };
    Functions<F> out;
    out.pdf = [D](Vec3<F> o, Vec3<F> i) {
        const Vec3<F> m = unit(o + i);
        return dot(o, m) > 0 && m.z > 0 ? D(m.z) * m.z / (4 * dot(o, m)) : F(0);
    };
    out.sample = [a, pdf = out.pdf](Vec3<F> o, const F* u) {
        const F theta = std::atan(a * std::sqrt(u[0] / (1 - u[0]))), phi = 2 * pi_of<F> * u[1], s = std::sin(theta);
        const Vec3<F> m{s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
        if (!(dot(o, m) > 0)) return Drawn<F>{{0, 0, 1}, 0};
        const Vec3<F> i = reflected(o, m);
        return Drawn<F>{i, pdf(o, i)};
    };
    return sampler_with<F>(fmt::format("alpha {:.3f}", double(a)), 2, Wo::upper, out);
}

/// Henyey-Greenstein and Rayleigh.
template <class F> Sampler haze(Rng& d) {
    const double side = d.whole(0, 1) ? 1 : -1, g = side * d.uniform(0.1, 0.9), share = d.uniform(0.1, 0.9);
    const Profile<F> rayleigh = {[](F u) {
                                     const F q = 4 * u - 2, a = std::cbrt(q + std::sqrt(q * q + 1));
                                     return std::clamp(1 - (a - 1 / a), F(0), F(2));
                                 },
        [](F t) { return 3 / (16 * pi_of<F>)*(1 + sqr(1 - t)); }};
    Functions<F> out = mixture<F>(
        {{F(share), forward<F>(), greenstein_profile<F>(F(g))}, {F(1 - share), forward<F>(), rayleigh}}, Broken::none);
    return sampler_with<F>(fmt::format("g {:.3f}, share {:.3f}", g, share), 3, Wo::both, out);
}

/// A uniform sphere stretched to an ellipsoid: p = 1 / (4 pi |det A| |A^-1 w|^3).
template <class F> Sampler ellipsoid(Rng& d) {
    const Frame<F> frame = frame_about(cast<F>(d.direction(-1, 1)));
    const F a = F(d.log(0.05, 1)), b = F(d.log(0.05, 1));
    Functions<F> out;
    out.pdf = [=](Vec3<F>, Vec3<F> world) {
        const Vec3<F> w = frame.to_local(world), v{w.x / a, w.y / b, w.z};
        const F r2 = dot(v, v);
        return 1 / (4 * pi_of<F> * a * b * r2 * std::sqrt(r2));
    };
    out.sample = [=, pdf = out.pdf](Vec3<F> o, const F* u) {
        const Vec3<F> v = off_axis(Vec3<F>{0, 0, 1}, 2 * u[0], u[1]);
        const Vec3<F> w = frame.to_world(unit(Vec3<F>{a * v.x, b * v.y, v.z}));
        return Drawn<F>{w, pdf(o, w)};
    };
    return sampler_with<F>(fmt::format("axes {:.3f}, {:.3f}", double(a), double(b)), 2, Wo::none, out);
}

/// p ~ t^-e about an axis, integrable; in double.
template <class> Sampler pole(Rng& d) {
    const double e = d.uniform(0.05, 0.5);
    const Profile<double> profile = {[e](double u) { return 2 * std::pow(u, 1 / (1 - e)); },
        [e](double t) {
            return (1 - e) * std::pow(std::max(t, 1e-300), -e) / (2 * pi_of<double> * std::pow(2, 1 - e));
        }};
    return sampler_with<double>(
        fmt::format("power {:.3f}", e), 2, Wo::none, single<double>(fixed<double>(d.direction(-1, 1)), profile));
}
/// (1 + t / b)^-g about an axis.
template <class F> Sampler long_tail(Rng& d) {
    const double g = d.uniform(1.5, 3), b = d.log(1e-3, 0.1), whole = -std::expm1((1 - g) * std::log1p(2 / b));
    const Profile<F> profile = {
        [=](F u) { return F(std::min(2.0, b * std::expm1(std::log1p(-double(u) * whole) / (1 - g)))); },
        [=](F t) { return F((g - 1) / b * std::pow(1 + double(t) / b, -g) / whole / (2 * pi_of<double>)); }};
    return sampler_with<F>(
        fmt::format("power {:.3f}, scale {:.2g}", g, b), 2, Wo::none, single<F>(fixed<F>(d.direction(-1, 1)), profile));
}

struct Fresh {
    const char* name;
    Sampler (*in_double)(Rng&);
    Sampler (*in_float)(Rng&);
};
constexpr Fresh all_fresh[] = {
    {"lights by an alias table", lights_by_cone<double, Choosing::alias>, lights_by_cone<float, Choosing::alias>},
    {"lights by an alias table with one number", lights_by_cone<double, Choosing::alias_by_one_number>,
        lights_by_cone<float, Choosing::alias_by_one_number>},
    {"lights by search", lights_by_cone<double, Choosing::search>, lights_by_cone<float, Choosing::search>},
    {"lights by search, number used again", lights_by_cone<double, Choosing::search_and_reuse>,
        lights_by_cone<float, Choosing::search_and_reuse>},
    {"sparse sky by rows and columns", sparse_sky<double, false>, sparse_sky<float, false>},
    {"sparse sky by alias table", sparse_sky<double, true>, sparse_sky<float, true>},
    {"rectangle by solid angle", rectangle_by_solid_angle<double>, rectangle_by_solid_angle<float>},
    {"triangle by solid angle", triangle_by_solid_angle<double>, triangle_by_solid_angle<float>},
    {"coat over Lambert", coat<double>, coat<float>},
    {"pane", pane<double>, pane<float>},
    {"weights only: cosine", only_weights<double, Method::cosine>, only_weights<float, Method::cosine>},
    {"weights only: uniform", only_weights<double, Method::uniform>, only_weights<float, Method::uniform>},
    {"weights only: visible normals", only_weights<double, Method::visible_normals>,
        only_weights<float, Method::visible_normals>},
    {"one-sample MIS", one_sample_mis<double>, one_sample_mis<float>},
    {"rough glass by visible normals", rough_glass<double>, rough_glass<float>},
    {"bounded visible normals", bounded_normals<double>, bounded_normals<float>},
    {"GGX of textbooks", textbook_ggx<double>, textbook_ggx<float>},
    {"haze", haze<double>, haze<float>},
    {"ellipsoid", ellipsoid<double>, ellipsoid<float>},
    {"pole of density", pole<double>, pole<double>},
    {"long tail", long_tail<double>, long_tail<float>},
};

}  // namespace

std::vector<std::string> fresh_names() {
    std::vector<std::string> out;
    for (const Fresh& f : all_fresh) out.emplace_back(f.name);
    return out;
}

Sampler fresh_sampler(std::size_t family, Real real, Rng& d) {
    const Fresh& f = all_fresh[family];
    Sampler s = (real == Real::f32 ? f.in_float : f.in_double)(d);
    s.family = f.name;
    return s;
}

Case make_fresh(const CaseKey& key) {
    constexpr std::size_t families = std::size(all_fresh);
    Rng d = rng_of({key.set, key.seed, key.index, "parameters"});
    return case_of(fresh_sampler(key.index % families, key.index / families % 2 ? Real::f32 : Real::f64, d), key,
        State::right, "right");
}

}  // namespace crescent::calibration
