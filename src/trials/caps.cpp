// A pdf of many spherical caps, each with one step at its rim: rays from draws find the first jump, three rims make a
// circle, and the step is measured all round it. What the caps leave goes to the cubature; a cap's own mass is 2 pi a
// step, a = 1 - cos of its half angle.
#include "trials/caps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/functions.h"
#include "stats/quantiles.h"

namespace crescent::inline trials {

namespace {

constexpr int rays = 8, around = 16, bisections = 44;
constexpr double least_jump = 0.15;     // of p, from one step along a ray to the next
constexpr double largest = 0.02;        // 1 - cos: 11 deg; the cells of a larger one are few
constexpr std::size_t many = 8;         // fewer are left to the cubature
constexpr double rounding_of_p = 1e-6;  // of p: what caps leave there is rounding

/// A great circle from a draw, as far as p first jumps.
struct Ray {
    std::size_t draw = 0;
    Vec3d from, along;
    double t0 = 0, t1 = 0, p0 = 0, p1 = 0;  // angles before and after the jump, and p there
    bool jumped = false;
    Vec3d at(double t) const {
        const auto [sin, cos] = math::sincos(t);
        return normalize(from * cos + along * sin);
    }
};

/// Ever longer steps along each ray until p jumps.
void march(const Draws& work, int technique, std::vector<Ray>& all) {
    constexpr double first = 1e-5, longer = 1.5, last = 1.5;
    std::vector<Vec3d> where;
    for (double t = first; t < last; t *= longer) {
        std::vector<Ray*> open;
        where.clear();
        for (Ray& r : all)
            if (!r.jumped) open.push_back(&r), where.push_back(r.at(t));
        if (open.empty()) return;
        const std::vector<double> p = work.pdf(technique, where, true);
        for (std::size_t i = 0; i < open.size(); ++i) {
            Ray& r = *open[i];
            r.jumped = std::fabs(p[i] - r.p0) > least_jump * std::max(p[i], r.p0);
            if (r.jumped) r.t1 = t, r.p1 = p[i];
            else r.t0 = t, r.p0 = p[i];
        }
    }
    std::erase_if(all, [](const Ray& r) { return !r.jumped; });
}

void close_in(const Draws& work, int technique, std::vector<Ray>& all) {
    std::vector<Vec3d> where(all.size());
    for (int k = 0; k < bisections; ++k) {
        for (std::size_t i = 0; i < all.size(); ++i) where[i] = all[i].at(0.5 * (all[i].t0 + all[i].t1));
        const std::vector<double> p = work.pdf(technique, where, true);
        for (std::size_t i = 0; i < all.size(); ++i) {
            Ray& r = all[i];
            const double mid = 0.5 * (r.t0 + r.t1);
            if (std::fabs(p[i] - r.p0) > std::fabs(p[i] - r.p1)) r.t1 = mid, r.p1 = p[i];
            else r.t0 = mid, r.p0 = p[i];
        }
    }
}

/// The circle through three rims that holds `inside`.
std::optional<Cap> through(const Ray& x, const Ray& y, const Ray& z) {
    const Vec3d p = x.at(x.t0), normal = cross(y.at(y.t0) - p, z.at(z.t0) - p);
    const double size = length(normal);
    if (!(size > 1e-20)) return {};
    Vec3d axis = normal * (1 / size);
    if (dot(axis, x.from) < dot(axis, p)) axis = -axis;
    const double a = 0.5 * dot(p - axis, p - axis);
    return a > 1e-14 && a < largest ? std::optional(Cap{axis, a, x.p0 - x.p1}) : std::nullopt;
}

/// Sets the step of those that have the same all round; takes out the others.
void look_round(const Draws& work, int technique, std::vector<Cap>& caps) {
    std::vector<Vec3d> where;
    for (const Cap& c : caps) {
        const SphereMap map(c.axis);
        const double near = 1e-6 * c.a + 8 * work.direction_resolution() * std::sqrt(2 * c.a);
        for (int k = 0; k < around; ++k)
            for (double a : {c.a - near, c.a + near}) where.push_back(map.direction({a, (k + 0.31) / around}));
    }
    const std::vector<double> p = work.pdf(technique, where, true);
    std::vector<Cap> kept;
    for (std::size_t i = 0; i < caps.size(); ++i) {
        std::array<double, around> steps{};
        for (std::size_t k = 0; k < around; ++k) steps[k] = p[2 * (i * around + k)] - p[2 * (i * around + k) + 1];
        const double step = median_of({steps.begin(), steps.end()});
        const auto same = std::count_if(
            steps.begin(), steps.end(), [step](double s) { return std::fabs(s - step) <= 1e-4 * std::fabs(step); });
        if (step > 0 && same >= around - 3) kept.push_back({caps[i].axis, caps[i].a, step});  // other rims cross it
    }
    caps = std::move(kept);
}

double left_by(std::span<const Cap> caps, Vec3d w, double p) {
    double left = p;
    for (const Cap& c : caps) left -= c.holds(w) ? c.step : 0;
    return std::fabs(left) <= rounding_of_p * p ? 0 : left;
}

/// The rays of a draw, of which three neighbours often meet one rim, also where caps overlap.
std::vector<Cap> candidates(const std::vector<Ray>& all, std::size_t from, std::size_t to) {
    std::vector<Cap> out;
    const std::size_t n = to - from;
    for (std::size_t k = 0; k < n && n >= 3; ++k)
        for (const std::size_t apart : {std::size_t{1}, n / 3})
            if (const std::optional<Cap> c =
                    through(all[from + k], all[from + (k + apart) % n], all[from + (k + 2 * apart) % n]);
                c && apart > 0)
                out.push_back(*c);
    return out;
}

bool same(const Cap& x, const Cap& y) {
    return length(x.axis - y.axis) < 1e-6 * std::sqrt(2 * x.a) && std::fabs(x.a - y.a) < 1e-5 * x.a;
}

/// Caps about these draws that are not known yet.
std::vector<Cap> caps_about(const Draws& work, int technique, std::span<const Vec3d> draws) {
    const std::vector<double> p = work.pdf(technique, draws, true);
    std::vector<Ray> all;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        const Frame<double> frame = frame_about(normalize(draws[i]));
        for (int k = 0; k < rays; ++k) {
            const auto [sin, cos] = math::sincos(2 * pi * (k + 0.17) / rays);
            all.push_back({i, frame.n, frame.t * cos + frame.b * sin, 0, 0, p[i], 0, false});
        }
    }
    march(work, technique, all);
    close_in(work, technique, all);
    std::vector<Cap> found;
    for (std::size_t i = 0, next = 0; i < all.size(); i = next) {
        while (next < all.size() && all[next].draw == all[i].draw) ++next;
        for (const Cap& c : candidates(all, i, next))
            if (std::none_of(found.begin(), found.end(), [&](const Cap& known) { return same(known, c); }))
                found.push_back(c);
    }
    look_round(work, technique, found);
    return found;
}

/// Of each cap the share in each bin, by points even over it; what is left open is what a rim of points may hold.
void share_out(const Density& d, std::span<const Cap> caps, Integral& out) {
    constexpr int side = 64;
    std::vector<double> here(out.bins.size());
    for (const Cap& c : caps) {
        const SphereMap map(c.axis);
        const double mass = 2 * pi * c.a * c.step;
        std::fill(here.begin(), here.end(), 0.0);
        for (int i = 0; i < side; ++i)
            for (int k = 0; k < side; ++k)
                ++here[d.bin_of(
                    d.map.coordinates(map.direction({c.a * (i + 0.5) / side, (k + 0.5 * (i % 2)) / side})))];
        for (std::size_t b = 0; b < here.size(); ++b) {
            if (!(here[b] > 0)) continue;
            out.bins[b] += mass * here[b] / (side * side);
            if (here[b] < side * side) out.bin_errors[b] += mass / (side * std::sqrt(double(side)));
        }
        out.value += mass;
        out.second += mass;
    }
}

}  // namespace

std::vector<Cap> find_caps(const Draws& work, int technique) {
    constexpr std::size_t most = 4096, waves = 24;
    const SampleBatch& b = work.first(technique);
    std::vector<Cap> caps;
    std::size_t next = 0;
    for (std::size_t wave = 0; wave < waves; ++wave) {
        std::vector<Vec3d> open;
        for (const std::size_t room = wave == 0 ? 8 : 48; next < b.draws.size() && open.size() < room; ++next)
            if (b.draws[next].pdf > 0 && left_by(caps, b.draws[next].wi, b.pdf[next]) > 1e-3 * b.pdf[next])
                open.push_back(b.draws[next].wi);
        if (open.empty()) break;
        const std::size_t before = caps.size();
        for (const Cap& c : caps_about(work, technique, open))
            if (std::none_of(caps.begin(), caps.end(), [&](const Cap& known) { return same(known, c); }))
                caps.push_back(c);
        if (caps.size() == before || caps.size() > most) break;
    }
    return caps;
}

std::optional<Integral> integrate_caps(
    const Draws& work, int technique, const Density& d, std::vector<Rect> cells, const Effort& effort) {
    const std::vector<Cap> caps = find_caps(work, technique);
    if (caps.size() < many) return {};
    const auto left = [&](std::span<const Vec2d> at, std::span<double> out) {
        std::vector<Vec3d> wi;
        for (Vec2d v : at) wi.push_back(d.map.direction(v));
        const std::vector<double> p = work.pdf(technique, wi, true);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = 2 * pi * left_by(caps, wi[i], p[i]);
    };
    Integral out = integrate(std::move(cells), static_cast<int>(d.rings.size() - 1) * d.sectors, left, effort);
    share_out(d, caps, out);
    return out;
}

}  // namespace crescent::inline trials
