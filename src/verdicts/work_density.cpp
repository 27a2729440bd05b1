// Guides, densities and integrals of a trial: where its lobes stand, what mass each bin should hold, what arrives.
#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "simd/random.h"
#include "verdicts/mesh.h"
#include "verdicts/recorded.h"
#include "verdicts/work.h"

namespace crescent {

namespace {

constexpr std::size_t fixed_guides = 768;

/// Roberts' R2 sequence: even cover of the unit square, the same for every seed.
Vec2d r2(std::uint64_t i, Vec2d shift) {
    const double x = shift.x + 0.7548776662466927 * static_cast<double>(i + 1), y = shift.y + 0.5698402909980532 * static_cast<double>(i + 1);
    const double top = 1 - 0x1p-24;
    return {std::min(x - std::floor(x), top), std::min(y - std::floor(y), top)};
}

/// The axis of the circle on which directions lie: the rim of a cone or a ring, whose jump is then a coordinate line.
std::optional<Vec3d> axis_of_circle(std::span<const Vec3d> rim) {
    const Vec3d p = rim[0], normal = cross(rim[rim.size() / 3] - p, rim[2 * rim.size() / 3] - p);
    if (!(dot(normal, normal) > 1e-12)) return {};
    const Vec3d axis = normalize(normal);
    for (Vec3d w : rim)
        if (std::fabs(dot(w - p, axis)) > 1e-7) return {};
    return axis;
}

}  // namespace

/// Where the sampler draws, by an even cover of u, and where a mirror lobe would be, at every scale.
void Work::find_guides() {
    for (int t = 0; t < subject.techniques(); ++t) {
        std::vector<Draw> pilot;
        if (subject.draws_at_will()) {
            std::vector<Vec2d> u;
            for (std::uint64_t i = 0; i < 2048; ++i) u.push_back(r2(i, {0.5, 0.5}));
            pilot.resize(u.size());
            subject.sample(t, trial.wo, u, pilot);
        } else {
            const auto& all = first_[0].draws;
            pilot.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(all.size(), 2048)));
        }
        for (const Draw& d : pilot)
            if (d.pdf > 0 && is_finite(d.wi)) guides_.push_back(d.wi);
        if (subject.draws_at_will()) find_rims(t);
    }
    // About the mirror, where lobes stand, and about w_o, where 1 / (w_o.h) has a pole for half vectors along the surface.
    for (const SphereMap& about : {SphereMap(mirror(trial.wo)), SphereMap(-trial.wo)})
        for (std::uint64_t i = 0; i < fixed_guides / 2; ++i) {
            const Vec2d v = r2(i, {0.1, 0.7});
            guides_.push_back(about.direction({0.5 * math::pow(10.0, -7 * v.x), v.y}));
        }
}

/// Where the sides of the unit square go: for most warps the rim of what is drawn, to the last digit.
void Work::find_rims(int technique) {
    constexpr int along = 32;
    std::vector<Vec2d> u;
    for (double side : {0.0, 1 - 0x1p-24})
        for (int i = 0; i < along; ++i) {
            const double v = (i + 0.5) / along;
            u.push_back({side, v});
            u.push_back({v, side});
        }
    std::vector<Draw> drawn(u.size());
    subject.sample(technique, trial.wo, u, drawn);
    for (const Draw& d : drawn)
        if (d.pdf > 0 && is_finite(d.wi)) rims_.push_back(d.wi);
    for (std::size_t side = 0; side < 4 && !circle_; ++side) {
        std::vector<Vec3d> rim;
        for (std::size_t i = 0; i < along; ++i) {
            const Draw& d = drawn[(side / 2) * 2 * along + 2 * i + side % 2];
            if (d.pdf > 0 && is_finite(d.wi)) rim.push_back(d.wi);
        }
        if (rim.size() == along) circle_ = axis_of_circle(rim);
    }
}

void Work::measure_density() {
    find_guides();
    for (int t = 0; t < subject.techniques(); ++t) {
        const Batchful& b = first(t);
        Vec3d mean{};
        Vec3d peak{0, 0, 1};
        double highest = 0, count = 0;
        for (std::size_t i = 0; i < std::min<std::size_t>(b.draws.size(), 4096); ++i) {
            const Draw& d = b.draws[i];
            if (!(d.pdf > 0)) continue;
            mean = mean + d.wi;
            ++count;
            if (d.pdf > highest) {
                highest = d.pdf;
                peak = d.wi;
            }
        }
        const bool sharp = count > 0 && length(mean) / count > 0.9;
        const Vec3d n{0, 0, 1};
        const Batch about_n = batch_of(t, SphereMap(n));
        const std::optional<Mesh> mesh = find_mesh(about_n);
        if (mesh && mesh->cells() <= (subject.serial() ? 200000u : 10000000u)) {
            Density d = bins_about(n, true);
            const Witnesses seen = witnesses_of(t, d);
            const Prepare crowd = [&](std::vector<Rect> cells) { return guided(std::move(cells), d.map, guides_); };
            const Effort effort{2.5e-6, 6 * rigour.evaluations, 5e-5};
            if (std::optional<Integral> mass = integrate_mesh(*mesh, d.rings, d.sectors, about_n, effort, crowd, &seen)) {
                d.mass = std::move(*mass);
                grant_doubts(t, d);
                share_nothing(t, d);
                density_.push_back(std::move(d));
                continue;
            }
        }
        Density d = sharp ? density_about(t, normalize(mean), false, rigour.evaluations) : density_about(t, n, true, rigour.evaluations);
        if (d.mass.error > 5e-5 && circle_) {
            Density other = density_about(t, *circle_, false, rigour.evaluations);
            if (other.mass.error < d.mass.error) d = std::move(other);
        }
        if (d.mass.error > 5e-5) {
            Density other = sharp ? density_about(t, n, true, rigour.evaluations) : density_about(t, normalize(peak), false, rigour.evaluations);
            if (other.mass.error < d.mass.error) d = std::move(other);
            if (d.mass.error > 1e-4) d = density_about(t, d.map.frame.n, d.about_n, 6 * rigour.evaluations);
        }
        share_nothing(t, d);
        if (std::fabs(d.mass.value + d.nothing - 1) > 5e-5)  // a failure needs a second quadrature that confirms it
            d.second = density_about(t, d.about_n ? normalize(peak) : n, !d.about_n, 6 * rigour.evaluations, 2e-5).mass;
        density_.push_back(std::move(d));
    }
}

void Work::share_nothing(int technique, Density& d) const {
    const Batchful& b = first(technique);
    if (b.nothing > 0 && subject.draws_at_will()) find_nothing(technique, d, rigour.full ? 16384 : 2048);
    else d.nothing = static_cast<double>(b.nothing) / static_cast<double>(b.draws.size());
    // Too rare to have been met: half a million draws show a share of 5e-5 twenty times over.
    if (std::fabs(d.mass.value + d.nothing - 1) > 5e-5 && d.mass.value < 1 && subject.draws_at_will()) find_nothing(technique, d, 32768);
}

/// 2 pi p over coordinates about an axis.
Batch Work::batch_of(int technique, const SphereMap& map) const {
    return [this, technique, map](std::span<const Vec2d> at, std::span<double> out) {
        std::vector<Vec3d> wi;
        for (Vec2d v : at) wi.push_back(map.direction(v));
        const std::vector<double> p = pdf(technique, wi, true);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = 2 * pi * p[i];
    };
}

void Work::grant_doubts(int technique, Density& d) const {
    for (const Doubt& doubt : subject.doubts()) {
        d.doubt.resize(d.mass.bins.size());
        d.doubt[d.bin_of(d.map.coordinates(doubt.at))] += doubt.mass;
        d.doubts += doubt.mass;
    }
    if (!d.doubt.empty()) sharpen(technique, d);
}

Witnesses Work::witnesses_of(int technique, const Density& d) const {
    Witnesses out;
    const Batchful& b = first(technique);
    out.bins.resize((d.rings.size() - 1) * static_cast<std::size_t>(d.sectors));
    const std::size_t n = std::min<std::size_t>(b.draws.size(), 32768);
    out.total = static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) {
        if (is_nothing(b.draws[i], b.pdf[i])) continue;
        const Vec2d at = d.map.coordinates(b.draws[i].wi);
        out.bins[d.bin_of(at)].push_back({at, 2 * pi * b.pdf[i]});
    }
    return out;
}

std::size_t Density::bin_of(Vec2d at) const {
    const auto edge = std::upper_bound(rings.begin(), rings.end(), at.x);
    const auto ring = std::clamp<std::ptrdiff_t>(edge - rings.begin() - 1, 0, static_cast<std::ptrdiff_t>(rings.size()) - 2);
    const int sector = at.y > 0 ? std::min(static_cast<int>(at.y * sectors), sectors - 1) : 0;
    return static_cast<std::size_t>(ring * sectors + sector);
}

/// Draws know their p where the table only nearly does: over those in a bin, table / p comes to the table's integral / p's. The bin is
/// set right by that, as far as its doubt reaches, and is then known to the spread of table / p: twice the standard error of its
/// mean, and a tenth for draws that do not follow p.
void Work::sharpen(int technique, Density& d) const {
    struct Ratio {
        double n = 0, sum = 0, squares = 0;
    };
    std::vector<Ratio> ratio(d.doubt.size());
    const Batchful& b = first(technique);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        if (is_nothing(b.draws[i], b.pdf[i])) continue;
        Ratio& r = ratio[d.bin_of(d.map.coordinates(b.draws[i].wi))];
        const double v = b.pdf[i] / b.draws[i].pdf;
        ++r.n;
        r.sum += v;
        r.squares += v * v;
    }
    for (std::size_t k = 0; k < d.doubt.size(); ++k) {
        const Ratio& r = ratio[k];
        if (r.n < 8 || !(d.mass.bins[k] > 0)) continue;
        const double mean = r.sum / r.n, sd = std::sqrt(std::max(r.squares / r.n - mean * mean, 0.0)), reach = d.doubt[k] / d.mass.bins[k];
        const double right = d.mass.bins[k] / std::clamp(mean, std::max(1 - reach, 0.1), 1 + reach);
        d.mass.value += right - d.mass.bins[k];
        d.mass.bins[k] = right;
        d.doubt[k] = std::min(d.doubt[k], right * sd * (2 / std::sqrt(r.n) + 0.1));
    }
}

/// An edge at the nearest and the farthest rim: what lies beyond expects nothing.
void Work::add_rims(Density& d) const {
    if (rims_.empty()) return;
    double least = 2, most = 0;
    for (Vec3d w : rims_) {
        const double a = d.map.coordinates(w).x;
        least = std::min(least, a);
        most = std::max(most, a);
    }
    for (double edge : {least, most})
        if (edge > 1e-12 && edge < 2 - 1e-9) d.rings.push_back(edge);
    std::sort(d.rings.begin(), d.rings.end());
    d.rings.erase(std::unique(d.rings.begin(), d.rings.end(), [](double x, double y) { return y - x < 1e-13; }), d.rings.end());
}

/// Rings and sectors about an axis, narrow where draws crowd and where samplers go wrong.
Density Work::bins_about(Vec3d axis, bool about_n) const {
    Density d;
    d.map = SphereMap(axis);
    d.about_n = about_n;
    d.sectors = rigour.sectors;
    std::vector<double> a;
    for (Vec3d w : std::span(guides_).first(guides_.size() - fixed_guides)) a.push_back(d.map.coordinates(w).x);
    std::sort(a.begin(), a.end());
    d.rings = {0};
    if (!a.empty()) {
        const double tails[] = {0.002, 0.01, 0.025};  // finer rings where samplers go wrong: at the axis and at the rim
        std::vector<double> q(std::begin(tails), std::end(tails));
        for (int i = 1; i < rigour.rings; ++i) q.push_back(static_cast<double>(i) / rigour.rings);
        for (double v : tails) q.push_back(1 - v);
        q.push_back(1);
        std::sort(q.begin(), q.end());
        for (double v : q) {
            const double edge = a[static_cast<std::size_t>(v * static_cast<double>(a.size() - 1))];
            if (edge > d.rings.back() * (1 + 1e-9) + 1e-14) d.rings.push_back(edge);
        }
    }
    if (about_n) {
        for (double rim : {0.9, 0.95, 0.99, 1.0}) d.rings.push_back(rim);  // where n.w is small, samplers stop short
        std::sort(d.rings.begin(), d.rings.end());
        d.rings.erase(std::unique(d.rings.begin(), d.rings.end(), [](double x, double y) { return y - x < 1e-12; }), d.rings.end());
    }
    for (double extra : {2 * d.rings.back(), 8 * d.rings.back(), 64 * d.rings.back()})
        if (!about_n && extra < 1.9) d.rings.push_back(extra);
    d.rings.push_back(2);
    add_rims(d);
    return d;
}

Density Work::density_about(int technique, Vec3d axis, bool about_n, std::size_t evaluations, double edge_mass) const {
    Density d = bins_about(axis, about_n);
    std::vector<Rect> cells;
    const int rings = static_cast<int>(d.rings.size()) - 1;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < d.sectors; ++k)
            cells.push_back({d.rings[static_cast<std::size_t>(i)], d.rings[static_cast<std::size_t>(i) + 1], double(k) / d.sectors, double(k + 1) / d.sectors,
                             i * d.sectors + k});
    const Witnesses witnesses = witnesses_of(technique, d);
    d.mass = integrate(guided(std::move(cells), d.map, guides_), rings * d.sectors, batch_of(technique, d.map), {edge_mass / 20, evaluations, edge_mass}, &witnesses);
    grant_doubts(technique, d);
    return d;
}

/// Sixteen random shifts of an even cover give the share of u that draws nothing and its standard error.
void Work::find_nothing(int technique, Density& d, std::uint64_t n) const {
    constexpr int shifts = 16;
    double sum = 0, square = 0;
    std::vector<Vec2d> u(n);
    std::vector<Draw> draws(n);
    for (int k = 0; k < shifts; ++k) {
        const Vec2<float> shift = crescent::draw(seed_of(rigour.seed, 0x51f7u), index_, static_cast<std::uint64_t>(k), 8u + static_cast<std::uint32_t>(technique));
        for (std::uint64_t i = 0; i < n; ++i) u[i] = r2(i, {shift.x, shift.y});
        subject.sample(technique, trial.wo, u, draws);
        const std::vector<double> p = pdf_of_drawn(technique, draws);
        double none = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (is_nothing(draws[i], p[i])) ++none;
        sum += none / static_cast<double>(n);
        square += sqr(none / static_cast<double>(n));
    }
    d.nothing = sum / shifts;
    d.nothing_se = std::sqrt(std::max(square / shifts - sqr(d.nothing), 0.0) / (shifts - 1));
}

}  // namespace crescent
