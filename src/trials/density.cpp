// Densities of a trial: what mass each bin should hold.
#include <algorithm>
#include <cmath>

#include "cubature/mesh.h"
#include "math/functions.h"
#include "trials/caps.h"
#include "trials/densities.h"

namespace crescent::inline trials {

namespace {

constexpr Vec3d normal{0, 0, 1};

struct OutOfQuestions {};

void sort_edges(std::vector<double>& rings) {
    std::sort(rings.begin(), rings.end());
    rings.erase(std::unique(rings.begin(), rings.end(), [](double x, double y) { return y - x < 1e-12; }), rings.end());
}

/// A sky whose texels are summed: its mass is known to that, its bins to what the cubature says of them.
bool measure_by_texels(const Questions& work, int t, Density& d) {
    if (work.traits.wo != Traits::Asked::none || !(d.mass.error > work.enough())) return false;
    const std::size_t most = work.subject.limited() && !work.settings.full ? work.affordable(200000) : 10000000;
    const auto p = [&](std::span<const Vec3d> at, std::span<double> out) {
        std::ranges::copy(work.pdf(t, at, true), out.begin());
    };
    const std::optional<Integral> sum = integrate_texels(p, most);
    if (!sum) return false;
    d.mass.value = d.mass.second = sum->value;
    d.mass.error = sum->error;
    d.mass.second_se = 0;
    d.mass.settled = true;
    d.mass.evaluations += sum->evaluations;
    return true;
}

}  // namespace

void Densities::measure_density() {
    find_pilot_directions();
    if (!traits.has_pdf) {  // bins alone
        density_.push_back(bins_about({0, 0, 1}, true));
        density_.back().mass.bins.assign(
            (density_.back().rings.size() - 1) * static_cast<std::size_t>(settings.sectors), 0.0);
        return;
    }
    for (int t = 0; t < subject.techniques(); ++t) density_.push_back(density_of(t));
}

/// Where the draws of a technique go.
struct Densities::Lobe {
    Vec3d mean{}, peak{0, 0, 1};  // mean: of a sharp one; peak: where p is highest
    bool sharp = false;           // they crowd about the mean
};

Densities::Lobe Densities::lobe_of(const SampleBatch& b) {
    Lobe out;
    Vec3d sum{};
    double highest = 0, count = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(b.draws.size(), 4096); ++i) {
        const Draw& d = b.draws[i];
        if (!(d.pdf > 0)) continue;
        sum = sum + d.wi;
        ++count;
        if (d.pdf > highest) {
            highest = d.pdf;
            out.peak = d.wi;
        }
    }
    out.sharp = count > 0 && length(sum) / count > 0.9;
    if (out.sharp) out.mean = normalize(sum);
    return out;
}

Density Densities::density_of(int t) {
    const Lobe lobe = lobe_of(first(t));
    if (scatter().pdf()) return density_of_estimates(t, lobe.sharp ? lobe.mean : normal);
    if (std::optional<Density> table = table_density(t)) return std::move(*table);
    const Vec3d axis = banded_.value_or(normal);
    Density d = lobe.sharp ? density_about(t, lobe.mean, false, settings.evaluations)
                           : density_about(t, axis, axis.z == 1, settings.evaluations);
    const bool capped = measure_by_caps(t, d);
    const bool texels = measure_by_texels(*this, t, d);
    if (!texels) measure_about_others(t, lobe, d);
    share_nothing(t, d);
    // A failure needs a second quadrature that confirms it; a sum over bands in which p is constant does not.
    const bool summed = texels || (banded_ && d.mass.error < 1e-6 && d.mass.second_se < 1e-6);
    if (!summed && std::fabs(d.mass.value + d.nothing - 1) > 5e-5 + 2 * d.nothing_se) {
        const Vec3d other = d.about_n ? normalize(lobe.peak) : normal;
        d.second = capped ? mass_by_caps(t, bins_about(other, !d.about_n)) : second_mass(t, other, !d.about_n);
    }
    return d;
}

/// In other coordinates. Cutting far along many rims asks more than a cubature is told to: a limited sampler is asked
/// for that once the rims were cut as everywhere, and while questions are left; what it answered before costs nothing
/// then.
Integral Densities::second_mass(int t, Vec3d axis, bool about_n) const {
    const std::size_t wanted = 6 * settings.evaluations;
    constexpr double far = 2e-5;
    if (!subject.limited()) return density_about(t, axis, about_n, wanted, far).mass;
    Integral out = density_about(t, axis, about_n, wanted).mass;
    try {
        Integral better = density_about(t, axis, about_n, wanted, far, out.evaluations).mass;
        if (better.error < out.error) out = std::move(better);
    } catch (const OutOfQuestions&) {}
    return out;
}

std::optional<Integral> Densities::mass_by_caps(int t, const Density& bins) const {
    const std::size_t evaluations = affordable(settings.evaluations, for_later());
    return integrate_caps(*this, t, bins, refined_at_pilots(cells_of(bins), bins.map, pilot_directions_),
        {tolerance(), evaluations, 5e-5});
}

/// Where the mass is far from known: many rims. Returns whether caps alone make it known.
bool Densities::measure_by_caps(int t, Density& d) const {
    if (!(d.mass.error > 10 * enough()) || pole_) return false;
    std::optional<Integral> mass = mass_by_caps(t, d);
    if (!mass || !(mass->error < d.mass.error)) return false;
    d.mass = std::move(*mass);
    return d.mass.error <= enough();
}

/// Until the mass is known well enough: about the axis of a circular rim, about the normal or the peak, and with more
/// evaluations. What is known best stays.
void Densities::measure_about_others(int t, const Lobe& lobe, Density& d) const {
    const auto keep_better = [&d](Density other) {
        if (other.mass.error < d.mass.error) d = std::move(other);
    };
    const std::size_t look = thrifty() ? settings.evaluations / 3 : settings.evaluations;
    const bool nearly = thrifty() && d.mass.error < 3e-4;  // it is finer cells that are missing
    if (d.mass.error > enough() && circle_ && !nearly) keep_better(density_about(t, *circle_, false, look));
    if (!(d.mass.error > enough())) return;
    if (!nearly)
        keep_better(
            lobe.sharp ? density_about(t, normal, true, look) : density_about(t, normalize(lobe.peak), false, look));
    if (d.mass.error > 1e-4) measure_further(t, d);
    if (d.mass.error > 1e-4 && !thrifty())  // built-in arms answer at once: finer along jumps
        keep_better(density_about(t, d.map.frame.n, d.about_n, 6 * settings.evaluations, 2e-5));
}

Batch Densities::while_affordable(Batch ask) const {
    return [this, ask = std::move(ask)](std::span<const Vec2d> at, std::span<double> out) {
        if (affordable(at.size() + 2000, for_later()) < at.size() + 2000) throw OutOfQuestions{};
        ask(at, out);
    };
}

/// In the same cells for as long as questions are left. A program answered for most of them, which cost nothing now.
void Densities::measure_further(int t, Density& d) const {
    const std::size_t known = thrifty() ? d.mass.evaluations : 0;
    const SamplesPerBin seen = samples_per_bin_of(t, d);
    try {
        Integral mass = integrate(refined_at_pilots(cells_of(d), d.map, pilot_directions_),
            static_cast<int>(d.mass.bins.size()), while_affordable(batch_of(t, d.map)),
            {tolerance(), affordable(6 * settings.evaluations, for_later()) + known, thrifty() ? 4e-4 : 1e-4}, &seen);
        if (mass.error < d.mass.error) d.mass = std::move(mass);
    } catch (const OutOfQuestions&) {}  // what is known so far stays
}

/// p that is a random estimate, by points at random; a second time about other coordinates where it does not come to
/// one.
Density Densities::density_of_estimates(int t, Vec3d axis) {
    const auto about = [&](Vec3d to) {
        return density_about(t, to, to.z == 1, (thrifty() ? 2 : 4) * settings.evaluations);
    };
    Density d = about(axis);
    share_nothing(t, d);
    if (std::fabs(d.mass.value + d.nothing - 1) > d.mass.error + 2 * d.nothing_se)
        d.second = about(axis.z == 1 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}).mass;
    return d;
}

/// 2 pi p over coordinates about an axis.
Batch Densities::batch_of(int technique, const SphereMap& map) const {
    return [this, technique, map](std::span<const Vec2d> at, std::span<double> out) {
        std::vector<Vec3d> wi;
        for (Vec2d v : at) wi.push_back(map.direction(v));
        const std::vector<double> p = pdf(technique, wi, true);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = 2 * pi * p[i];
    };
}

SamplesPerBin Densities::samples_per_bin_of(int technique, const Density& d) const {
    SamplesPerBin out;
    const SampleBatch& b = first(technique);
    out.bins.resize((d.rings.size() - 1) * static_cast<std::size_t>(d.sectors));
    out.total = static_cast<double>(b.draws.size());
    const std::vector<Vec2d>& at = coordinates_of(b, d.map);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        subject.make_way(1);
        if (!is_null_sample(b.draws[i], b.pdf[i])) out.bins[d.bin_of(at[i])].push_back({at[i], 2 * pi * b.pdf[i]});
    }
    return out;
}

std::size_t Density::bin_of(Vec2d at) const {
    const auto edge = std::upper_bound(rings.begin(), rings.end(), at.x);
    const auto ring =
        std::clamp<std::ptrdiff_t>(edge - rings.begin() - 1, 0, static_cast<std::ptrdiff_t>(rings.size()) - 2);
    const int sector = at.y > 0 ? std::min(static_cast<int>(at.y * sectors), sectors - 1) : 0;
    return static_cast<std::size_t>(ring * sectors + sector);
}

/// An edge at the nearest and the farthest rim, and one farther out, since a rim is known at a few places: what lies
/// beyond expects nothing.
void Densities::add_edges_of_support(Density& d) const {
    if (support_boundary_.empty()) return;
    double least = 2, most = 0;
    for (Vec3d w : support_boundary_) {
        const double a = d.map.height(w);
        least = std::min(least, a);
        most = std::max(most, a);
    }
    // Rounding takes draws beyond a rim at which p has a pole, where many of them fall.
    if (pole_ && circle_ && length(d.map.frame.n - *circle_) < 1e-12) {
        const double rounding = 8 * std::max(direction_resolution(), 0x1p-24) * std::sqrt(2 * *pole_);
        std::erase_if(d.rings, [&](double edge) { return std::fabs(edge - *pole_) < rounding; });
        least = most = *pole_ + rounding;
    }
    for (double edge : {least, most, most + 0.1 * (most - least)})
        if (edge > 1e-12 && edge < 2 - 1e-9) d.rings.push_back(edge);
    std::sort(d.rings.begin(), d.rings.end());
    d.rings.erase(
        std::unique(d.rings.begin(), d.rings.end(), [](double x, double y) { return y - x < 1e-13; }), d.rings.end());
}

/// Rings and sectors about an axis, narrow where draws crowd and where samplers go wrong.
Density Densities::bins_about(Vec3d axis, bool about_n) const {
    Density d;
    d.map = SphereMap(axis);
    d.about_n = about_n;
    d.sectors = settings.sectors;
    std::vector<double> a;
    for (Vec3d w : std::span(pilot_directions_).first(drawn_pilots_)) a.push_back(d.map.height(w));
    std::sort(a.begin(), a.end());
    d.rings = {0};
    if (!a.empty()) {
        const double tails[] = {0.002, 0.01, 0.025};  // finer rings where samplers go wrong: at the axis and at the rim
        std::vector<double> q(std::begin(tails), std::end(tails));
        for (int i = 1; i < settings.rings; ++i) q.push_back(static_cast<double>(i) / settings.rings);
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
        sort_edges(d.rings);
    }
    if (banded_ && length(axis - *banded_) < 1e-12) {
        for (double height : heights_)
            if (height > 1e-12 && height < 2 - 1e-9) d.rings.push_back(height);
        sort_edges(d.rings);
    }
    for (double extra : {2 * d.rings.back(), 8 * d.rings.back(), 64 * d.rings.back()})
        if (!about_n && extra < 1.9) d.rings.push_back(extra);
    d.rings.push_back(2);
    add_edges_of_support(d);
    return d;
}

std::vector<Rect> Densities::cells_of(const Density& d) const {
    std::vector<Rect> cells;
    const int rings = static_cast<int>(d.rings.size()) - 1;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < d.sectors; ++k)
            cells.push_back({d.rings[static_cast<std::size_t>(i)], d.rings[static_cast<std::size_t>(i) + 1],
                double(k) / d.sectors, double(k + 1) / d.sectors, i * d.sectors + k});
    return cells;
}

Density Densities::density_about(int technique, Vec3d axis, bool about_n, std::size_t wanted, double edge_mass,
    std::optional<std::size_t> known) const {
    const std::size_t evaluations = affordable(wanted, for_later()) + known.value_or(0);
    Density d = bins_about(axis, about_n);
    const int rings = static_cast<int>(d.rings.size()) - 1;
    if (pole_ && circle_ && length(axis - *circle_) < 1e-12) {
        d.mass = mass_inside_pole(technique, d, refined_at_pilots(cells_of(d), d.map, pilot_directions_),
            {std::max(edge_mass / 20, tolerance()), evaluations, edge_mass});
        grant_tabulation_error(technique, d);
        return d;
    }
    const SamplesPerBin samples = samples_per_bin_of(technique, d);
    d.mass = integral_of(refined_at_pilots(cells_of(d), d.map, pilot_directions_), rings * d.sectors,
        known ? while_affordable(batch_of(technique, d.map)) : batch_of(technique, d.map),
        {std::max(edge_mass / 20, tolerance()), evaluations, edge_mass}, scatter().pdf(), &samples);
    grant_tabulation_error(technique, d);
    return d;
}

}  // namespace crescent::inline trials
