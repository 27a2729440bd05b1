// Lights seen from the origin, drawn by area (density r^2 / (A cos), for both sides of a surface) or by solid angle.
// p_area is per m^2, p per sr.
#include <fmt/format.h>

#include "tests/calibration/axial.h"

namespace crescent::calibration {

namespace {

using Wo = Traits::WoDomain;

/// A point of a flat light: centre + x a + y b.
struct Plane {
    Vec3d centre, a, b;  // half sides or edges
    double area;
    static Plane rectangle(Rng& d) {
        const Vec3d n = d.direction(-1, 1), c = d.direction(-0.3, 1) * d.log(0.4, 3);
        const Frame<double> f = frame_about(n);
        Plane p{c, f.t * d.log(0.05, 1.5), f.b * d.log(0.05, 1.5), 0};
        // The plane of the light does not contain the origin: a light seen edge-on has an unbounded density.
        const double gap = dot(c, n), least = 0.15;
        if (std::fabs(gap) < least) p.centre = c + n * ((gap < 0 ? -least : least) - gap);
        return p;
    }
    Plane scaled(double by) const { return {centre, a * by, b * by, area}; }
};

/// p = r^2 / (A cos) at distance r, and the place on the light in units of a and b. Computed in double; in single
/// precision directions and densities are rounded at the end, and edges are widened by that rounding.
struct FlatLight {
    Vec3d c, a, b, n;
    double area, rounding;
    /// Beyond the whole light. Without it the widened edges contain all directions that are parallel to the plane but
    /// for their rounding, at distances of 10^7 m.
    double farthest;
    FlatLight(const Plane& p, double area_over_ab, double round)
        : c(p.centre),
          a(p.a),
          b(p.b),
          n(unit(cross(a, b))),
          area(area_over_ab * std::sqrt(dot(a, a) * dot(b, b))),
          rounding(round),
          farthest(2 * (std::sqrt(dot(c, c)) + std::sqrt(dot(a, a)) + std::sqrt(dot(b, b)))) {}
    /// x and y in units of a and b, and the distance; distance 0: no intersection.
    struct Met {
        double x, y, r;
    };
    Met met(Vec3d w) const {
        const double t = dot(c, n) / dot(w, n);
        if (!(t > 0 && t < farthest)) return {0, 0, 0};
        const Vec3d off = w * t - c;
        return {dot(off, a) / dot(a, a), dot(off, b) / dot(b, b), t};
    }
    double density(Vec3d w, double r) const { return r * r / (area * std::fabs(dot(w, n))); }
    /// The widening of an edge at 1.
    double edge(double r, Vec3d w) const {
        return rounding * r / (std::sqrt(std::min(dot(a, a), dot(b, b))) * std::fabs(dot(w, n)));
    }
    Drawn<double> at(double x, double y) const {
        const Vec3d point = c + a * x + b * y;
        const double r = std::sqrt(dot(point, point));
        const Vec3d w = point * (1 / r);
        return {w, density(w, r)};
    }
};

/// A flat light of a shape: whether (x, y) is inside, with a tolerance e at edges, and the place of u.
template <class F> Functions<F> flat(const Plane& plane, double area_over_ab,
    bool (*inside)(double x, double y, double e), std::pair<double, double> (*place)(const double* u)) {
    // Each coordinate of a direction in single precision has a rounding error of at most 2^-25.
    const FlatLight light(plane, area_over_ab, sizeof(F) == 4 ? 0x1p-24 : 1e-14);
    Functions<double> out;
    out.pdf = [light, inside](Vec3d, Vec3d w) {
        const auto [x, y, r] = light.met(w);
        return r > 0 && inside(x, y, light.edge(r, w)) ? light.density(w, r) : 0.0;
    };
    out.sample = [light, place](Vec3d, const double* u) {
        const auto [x, y] = place(u);
        return light.at(x, y);
    };
    if constexpr (sizeof(F) == 8) return out;
    else return rounded(std::move(out));
}

struct Rectangle {
    static constexpr auto name = "rectangle light by area", parameter = "size";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    Plane plane;
    static Rectangle drawn(Rng& d) { return {Plane::rectangle(d)}; }
    std::string text() const {
        return fmt::format("{:.3f} x {:.3f} at {:.3f} m", 2 * std::sqrt(dot(plane.a, plane.a)),
            2 * std::sqrt(dot(plane.b, plane.b)), std::sqrt(dot(plane.centre, plane.centre)));
    }
    Rectangle stretched(double by) const { return {plane.scaled(by)}; }
    template <class F> Functions<F> in(Broken) const {
        return flat<F>(
            plane, 4, [](double x, double y, double e) { return std::fabs(x) <= 1 + e && std::fabs(y) <= 1 + e; },
            [](const double* u) { return std::pair{2 * u[0] - 1, 2 * u[1] - 1}; });
    }
};

struct Disk {
    static constexpr auto name = "disk light by area", parameter = "size";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    Plane plane;
    static Disk drawn(Rng& d) {
        Plane p = Plane::rectangle(d);
        p.b = p.b * std::sqrt(dot(p.a, p.a) / dot(p.b, p.b));
        return {p};
    }
    std::string text() const { return fmt::format("radius {:.3f}", std::sqrt(dot(plane.a, plane.a))); }
    Disk stretched(double by) const { return {plane.scaled(by)}; }
    template <class F> Functions<F> in(Broken) const {
        return flat<F>(
            plane, pi_of<double>, [](double x, double y, double e) { return x * x + y * y <= sqr(1 + e); },
            [](const double* u) {
                const double r = std::sqrt(u[0]), phi = 2 * pi_of<double> * u[1];
                return std::pair{r * std::cos(phi), r * std::sin(phi)};
            });
    }
};

/// Edges a and b from the centre; barycentric coordinates by the square root.
struct Triangle {
    static constexpr auto name = "triangle light by area", parameter = "size";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    Plane plane;
    static Triangle drawn(Rng& d) { return {Plane::rectangle(d)}; }
    std::string text() const {
        return fmt::format("edges {:.3f}, {:.3f}", std::sqrt(dot(plane.a, plane.a)), std::sqrt(dot(plane.b, plane.b)));
    }
    Triangle stretched(double by) const { return {plane.scaled(by)}; }
    template <class F> Functions<F> in(Broken) const {
        return flat<F>(
            plane, 0.5, [](double x, double y, double e) { return x >= -e && y >= -e && x + y <= 1 + 1.5 * e; },
            [](const double* u) {
                const double s = std::sqrt(u[0]);
                return std::pair{1 - s, u[1] * s};
            });
    }
};

/// The cone that a sphere subtends.
struct SphereByAngle {
    static constexpr auto name = "sphere light by solid angle", parameter = "radius";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    Vec3d axis;
    double ratio;  // radius over distance
    static SphereByAngle drawn(Rng& d) {
        const Vec3d axis = d.direction(-0.3, 1);
        return {axis, d.log(0.02, 0.95)};
    }
    std::string text() const { return fmt::format("radius / distance {:.4g}", ratio); }
    SphereByAngle stretched(double by) const { return {axis, std::min(ratio * by, 0.9999)}; }
    template <class F> Functions<F> in(Broken) const {
        const F s2 = sqr(F(ratio));
        return single<F>(fixed<F>(axis), cone_profile<F>(s2 / (1 + std::sqrt(1 - s2))));
    }
};

/// The whole surface, front and back: p is the sum over both intersections of w.
struct SphereByArea {
    static constexpr auto name = "sphere light by area", parameter = "radius";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    Vec3d centre;
    double radius;
    static SphereByArea drawn(Rng& d) {
        const Vec3d c = d.direction(-0.3, 1) * d.log(0.5, 3);
        return {c, std::sqrt(dot(c, c)) * d.uniform(0.05, 0.8)};
    }
    std::string text() const { return fmt::format("radius {:.3f}", radius); }
    SphereByArea stretched(double by) const { return {centre, radius * by}; }
    template <class F> Functions<F> in(Broken) const {
        Functions<F> out;
        const Vec3<F> c = cast<F>(centre);
        const F r = F(radius), area = 4 * pi_of<F> * r * r;
        out.pdf = [c, r, area](Vec3<F>, Vec3<F> w) {
            const F b = dot(w, c);
            const Vec3<F> off = c - w * b;  // to the line
            const F h2 = r * r - dot(off, off);
            if (!(b > 0) || !(h2 > 0)) return F(0);
            const F h = std::sqrt(h2), cos = h / r;
            return (sqr(b - h) + sqr(b + h)) / (area * cos);
        };
        out.sample = [c, r, pdf = out.pdf](Vec3<F> o, const F* u) {
            const F z = 1 - 2 * u[0], s = 2 * std::sqrt(std::max(u[0] * (1 - u[0]), F(0))), phi = 2 * pi_of<F> * u[1];
            const Vec3<F> w = unit(c + Vec3<F>{s * std::cos(phi), s * std::sin(phi), z} * r);
            return Drawn<F>{w, pdf(o, w)};
        };
        return out;
    }
};

/// Arvo 1995, "Stratified Sampling of Spherical Triangles".
struct TriangleByAngle {
    static constexpr auto name = "triangle light by solid angle", parameter = "size";
    static constexpr Wo wo = Wo::none;
    static constexpr Domain domain = Domain::sphere;
    Vec3d centre, a, b;
    static TriangleByAngle drawn(Rng& d) {
        const Plane p = Plane::rectangle(d);
        return {p.centre, p.a, p.b};
    }
    std::string text() const { return fmt::format("edges {:.3f}, {:.3f}", std::sqrt(dot(a, a)), std::sqrt(dot(b, b))); }
    TriangleByAngle stretched(double by) const { return {centre, a * by, b * by}; }
    Functions<double> exact() const {
        const Vec3d A = unit(centre), B = unit(centre + a), C = unit(centre + b);
        const Vec3d ab = unit(cross(A, B)), bc = unit(cross(B, C)), ca = unit(cross(C, A));
        const double alpha = std::acos(std::clamp(-dot(ab, ca), -1.0, 1.0)),
                     beta = std::acos(std::clamp(-dot(ab, bc), -1.0, 1.0)),
                     gamma = std::acos(std::clamp(-dot(bc, ca), -1.0, 1.0));
        const double angle = alpha + beta + gamma - pi_of<double>, c = dot(A, B);
        const double side = dot(ab, C) > 0 ? 1 : -1;
        Functions<double> out;
        out.pdf = [=](Vec3d, Vec3d w) {
            const double e = -1e-12;
            const bool inside = side * dot(ab, w) >= e && side * dot(bc, w) >= e && side * dot(ca, w) >= e;
            return inside ? 1 / angle : 0.0;
        };
        out.sample = [=](Vec3d, const double* u) {
            const double part = u[0] * angle, s = std::sin(part - alpha), t = std::cos(part - alpha);
            const double p = t - std::cos(alpha), q = s + std::sin(alpha) * c;
            const double z =
                std::clamp(((q * t - p * s) * std::cos(alpha) - q) / ((q * s + p * t) * std::sin(alpha)), -1.0, 1.0);
            const Vec3d on = unit(C - A * dot(C, A)), far = A * z + on * std::sqrt(std::max(1 - z * z, 0.0));
            const double t2 = (1 - dot(far, B)) * u[1];  // 1 - cos along the arc from B
            const Vec3d w = unit(B * (1 - t2) + unit(far - B * dot(far, B)) * std::sqrt(std::max(t2 * (2 - t2), 0.0)));
            return Drawn<double>{w, 1 / angle};
        };
        return out;
    }
    template <class F> Functions<F> in(Broken) const {
        if constexpr (sizeof(F) == 8) return exact();
        else return rounded(exact());
    }
};

}  // namespace

std::vector<Family> light_families() {
    return {family_of<Rectangle>(), family_of<Disk>(), family_of<Triangle>(), family_of<SphereByAngle>(),
        family_of<SphereByArea>(), family_of<TriangleByAngle>()};
}

}  // namespace crescent::calibration
