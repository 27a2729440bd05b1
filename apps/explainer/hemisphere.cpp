// Directions are rotated about n, then projected along (0, -cos e, sin e), e the elevation; field() inverts this at the
// middle of every pixel. Paths are drawn where they face the viewer, grid lines with a point every 1.5 or 3 degrees.
#include "hemisphere.h"

#include <cmath>

#include "drawing.h"

namespace crescent::explainer {

namespace {

constexpr double degree = pi / 180;
constexpr Colour thin{1, 1, 1, 0.28};

}  // namespace

Vec3d direction(double theta_deg, double phi_deg) {
    const double theta = theta_deg * degree, phi = phi_deg * degree;
    return {math::sin(theta) * math::cos(phi), math::sin(theta) * math::sin(phi), math::cos(theta)};
}

Hemisphere::Hemisphere(Point centre, double radius, double elevation_deg, Vec3d right)
    : centre_(centre),
      radius_(radius),
      sin_elevation_(math::sin(elevation_deg * degree)),
      cos_elevation_(math::cos(elevation_deg * degree)) {
    const double length = math::hypot(right.x, right.y);
    if (length > 1e-9) {
        cos_ = right.x / length;
        sin_ = right.y / length;
    }
}

Vec3d Hemisphere::turned(Vec3d w) const { return {cos_ * w.x + sin_ * w.y, cos_ * w.y - sin_ * w.x, w.z}; }
Vec3d Hemisphere::unturned(Vec3d w) const { return {cos_ * w.x - sin_ * w.y, sin_ * w.x + cos_ * w.y, w.z}; }

Point Hemisphere::at(Vec3d w, double reach) const {
    const Vec3d d = turned(w);
    return {
        centre_.x + reach * radius_ * d.x, centre_.y - reach * radius_ * (d.z * cos_elevation_ + d.y * sin_elevation_)};
}

Point Hemisphere::rim(double turns) const { return at(unturned(direction(90, 360 * turns))); }

bool Hemisphere::visible(Vec3d w) const {
    const Vec3d d = turned(w);
    return d.z * sin_elevation_ - d.y * cos_elevation_ >= -1e-9;
}

Point Hemisphere::corner() const { return {std::round(centre_.x - radius_), std::round(centre_.y - radius_)}; }

Block Hemisphere::field(const std::function<Srgb8(Vec3d)>& colour) const {
    const int r = static_cast<int>(std::lround(radius_));
    Block block(2 * r, static_cast<int>(std::ceil(r * (1 + sin_elevation_))));
    for (int j = 0; j < block.height; ++j) {
        for (int i = 0; i < block.width; ++i) {
            const double u = (i + 0.5) / r - 1, v = 1 - (j + 0.5) / r, w2 = 1 - u * u - v * v;
            const double w = w2 > 0 ? std::sqrt(w2) : 0;
            const Vec3d d{u, v * sin_elevation_ - w * cos_elevation_,
                v * cos_elevation_ + w * sin_elevation_};  // towards the viewer: (0, -away, up)
            block.set(i, j, w2 > 0 && d.z >= 0 ? colour(unturned(d)) : plates::ground_bytes);
        }
    }
    return block;
}

void Hemisphere::trace(Frame& f, const std::vector<Vec3d>& path, Colour ink, double line, double alpha) const {
    std::vector<Point> run;
    for (const Vec3d& w : path) {
        if (visible(w)) {
            run.push_back(at(w));
        } else {
            if (run.size() > 1) f.polyline(run, ink, line, alpha);
            run.clear();
        }
    }
    if (run.size() > 1) f.polyline(run, ink, line, alpha);
}

void Hemisphere::grid(Frame& f, double alpha) const {
    for (int theta = 30; theta <= 90; theta += 30) {
        std::vector<Vec3d> ring;
        for (int k = 0; k <= 120; ++k) ring.push_back(unturned(direction(theta, 3 * k)));
        trace(f, ring, theta == 90 ? muted : thin, theta == 90 ? 3 : 1.5, alpha);
    }
    for (int phi = 0; phi < 360; phi += 30) {
        std::vector<Vec3d> meridian;
        for (int k = 0; k <= 60; ++k) meridian.push_back(unturned(direction(1.5 * k, phi)));
        trace(f, meridian, thin, 1.5, alpha);
    }
    std::vector<Point> outline;
    for (int k = 0; k <= 180; ++k) {
        const double a = k * degree;
        outline.push_back({centre_.x + radius_ * math::cos(a), centre_.y - radius_ * math::sin(a)});
    }
    f.polyline(outline, muted, 3, alpha);
}

void Hemisphere::arrow(Frame& f, Vec3d w, double reach, const Words& words, Colour ink, double alpha) const {
    const Point tip = at(w, reach);
    f.arrow(at(w), tip, ink, 4, alpha);
    const Text style = with(with(label_text, ink), Align::centre);
    const Rect size = f.measure(words, style);
    f.text({tip.x - size.w / 2 - 2, tip.y - size.h - 4, size.w + 4, size.h}, words, style, alpha);
}

}  // namespace crescent::explainer
