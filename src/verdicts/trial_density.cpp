// Densities of a trial: what mass each bin should hold.
#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "verdicts/caps.h"
#include "verdicts/trial_context.h"

namespace crescent::inline verdicts {

namespace {

struct OutOfQuestions {};

void sort_edges(std::vector<double>& rings) {
    std::sort(rings.begin(), rings.end());
    rings.erase(std::unique(rings.begin(), rings.end(), [](double x, double y) { return y - x < 1e-12; }), rings.end());
}

}  // namespace

void TrialContext::measure_density() {
    find_guides();
    if (!traits.has_pdf) {  // bins alone
        density_.push_back(bins_about({0, 0, 1}, true));
        density_.back().mass.bins.assign(
            (density_.back().rings.size() - 1) * static_cast<std::size_t>(settings.sectors), 0.0);
        return;
    }
    for (int t = 0; t < subject.techniques(); ++t) {
        const SampleBatch& b = first(t);
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
        if (scatter_.pdf()) {
            density_.push_back(density_of_estimates(t, sharp ? normalize(mean) : n));
            continue;
        }
        if (std::optional<Density> table = table_density(t)) {
            density_.push_back(std::move(*table));
            continue;
        }
        const Vec3d axis = banded_.value_or(n);
        Density d = sharp ? density_about(t, normalize(mean), false, settings.evaluations)
                          : density_about(t, axis, axis.z == 1, settings.evaluations);
        const double enough = thrifty() ? 8e-5 : 5e-5;
        const auto by_caps = [&](const Density& bins) {
            const std::size_t evaluations = affordable(settings.evaluations, for_later());
            return integrate_caps(
                *this, t, bins, guided(cells_of(bins), bins.map, guides_), {tolerance(), evaluations, 5e-5});
        };
        bool capped = false;
        if (d.mass.error > 10 * enough && !pole_)  // far from it: many rims
            if (std::optional<Integral> mass = by_caps(d); mass && mass->error < d.mass.error)
                d.mass = std::move(*mass), capped = d.mass.error <= enough;
        const std::size_t look = thrifty() ? settings.evaluations / 3 : settings.evaluations;  // at other coordinates
        const bool nearly = thrifty() && d.mass.error < 3e-4;  // it is finer cells that are missing
        if (d.mass.error > enough && circle_ && !nearly) {
            Density other = density_about(t, *circle_, false, look);
            if (other.mass.error < d.mass.error) d = std::move(other);
        }
        if (d.mass.error > enough) {
            Density other = nearly ? d
                : sharp            ? density_about(t, n, true, look)
                                   : density_about(t, normalize(peak), false, look);
            if (other.mass.error < d.mass.error) d = std::move(other);
            if (d.mass.error > 1e-4) {
                // A program answered for most of the cells so far, which cost nothing now.
                const std::size_t known = thrifty() ? d.mass.evaluations : 0;
                const Batch ask = batch_of(t, d.map);
                const auto while_affordable = [&](std::span<const Vec2d> at, std::span<double> out) {
                    if (affordable(at.size() + 2000, for_later()) < at.size() + 2000) throw OutOfQuestions{};
                    ask(at, out);
                };
                other = d;
                const SamplesPerBin seen = witnesses_of(t, d);
                try {
                    other.mass = integrate(guided(cells_of(d), d.map, guides_), static_cast<int>(d.mass.bins.size()),
                        while_affordable,
                        {tolerance(), affordable(6 * settings.evaluations, for_later()) + known,
                            thrifty() ? 5e-5 : 1e-4},
                        &seen);
                    if (other.mass.error < d.mass.error) d = std::move(other);
                } catch (const OutOfQuestions&) {}  // what is known so far stays
            }
            if (d.mass.error > 1e-4 && !thrifty()) {  // built-in arms answer at once: finer along jumps
                other = density_about(t, d.map.frame.n, d.about_n, 6 * settings.evaluations, 2e-5);
                if (other.mass.error < d.mass.error) d = std::move(other);
            }
        }
        share_nothing(t, d);
        // A failure needs a second quadrature that confirms it; a sum over bands in which p is constant does not.
        const bool summed = banded_ && d.mass.error < 1e-6 && d.mass.second_se < 1e-6;
        if (!summed && std::fabs(d.mass.value + d.nothing - 1) > 5e-5 + 2 * d.nothing_se)
            d.second = capped
                ? by_caps(bins_about(d.about_n ? normalize(peak) : n, !d.about_n))
                : density_about(t, d.about_n ? normalize(peak) : n, !d.about_n, 6 * settings.evaluations, 2e-5).mass;
        density_.push_back(std::move(d));
    }
}

/// p that is a random estimate, by points at random; a second time about other coordinates where it does not come to
/// one.
Density TrialContext::density_of_estimates(int t, Vec3d axis) {
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
Batch TrialContext::batch_of(int technique, const SphereMap& map) const {
    return [this, technique, map](std::span<const Vec2d> at, std::span<double> out) {
        std::vector<Vec3d> wi;
        for (Vec2d v : at) wi.push_back(map.direction(v));
        const std::vector<double> p = pdf(technique, wi, true);
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = 2 * pi * p[i];
    };
}

SamplesPerBin TrialContext::witnesses_of(int technique, const Density& d) const {
    SamplesPerBin out;
    const SampleBatch& b = first(technique);
    out.bins.resize((d.rings.size() - 1) * static_cast<std::size_t>(d.sectors));
    out.total = static_cast<double>(b.draws.size());
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        subject.make_way(1);
        if (is_null_sample(b.draws[i], b.pdf[i])) continue;
        const Vec2d at = d.map.coordinates(b.draws[i].wi);
        out.bins[d.bin_of(at)].push_back({at, 2 * pi * b.pdf[i]});
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
void TrialContext::add_rims(Density& d) const {
    if (rims_.empty()) return;
    double least = 2, most = 0;
    for (Vec3d w : rims_) {
        const double a = d.map.coordinates(w).x;
        least = std::min(least, a);
        most = std::max(most, a);
    }
    // Rounding takes draws beyond a rim at which p has a pole, where many of them fall.
    if (pole_ && circle_ && length(d.map.frame.n - *circle_) < 1e-12) {
        const double rounding = 8 * std::max(grain_, 0x1p-24) * std::sqrt(2 * *pole_);
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
Density TrialContext::bins_about(Vec3d axis, bool about_n) const {
    Density d;
    d.map = SphereMap(axis);
    d.about_n = about_n;
    d.sectors = settings.sectors;
    std::vector<double> a;
    for (Vec3d w : std::span(guides_).first(drawn_guides_)) a.push_back(d.map.coordinates(w).x);
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
    add_rims(d);
    return d;
}

std::vector<Rect> TrialContext::cells_of(const Density& d) const {
    std::vector<Rect> cells;
    const int rings = static_cast<int>(d.rings.size()) - 1;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < d.sectors; ++k)
            cells.push_back({d.rings[static_cast<std::size_t>(i)], d.rings[static_cast<std::size_t>(i) + 1],
                double(k) / d.sectors, double(k + 1) / d.sectors, i * d.sectors + k});
    return cells;
}

Density TrialContext::density_about(
    int technique, Vec3d axis, bool about_n, std::size_t wanted, double edge_mass) const {
    const std::size_t evaluations = affordable(wanted, for_later());
    Density d = bins_about(axis, about_n);
    const int rings = static_cast<int>(d.rings.size()) - 1;
    if (pole_ && circle_ && length(axis - *circle_) < 1e-12) {
        d.mass = mass_inside_pole(technique, d, guided(cells_of(d), d.map, guides_),
            {std::max(edge_mass / 20, tolerance()), evaluations, edge_mass});
        grant_doubts(technique, d);
        return d;
    }
    const SamplesPerBin witnesses = witnesses_of(technique, d);
    d.mass = integral_of(guided(cells_of(d), d.map, guides_), rings * d.sectors, batch_of(technique, d.map),
        {std::max(edge_mass / 20, tolerance()), evaluations, edge_mass}, scatter_.pdf(), &witnesses);
    grant_doubts(technique, d);
    return d;
}

}  // namespace crescent::inline verdicts
