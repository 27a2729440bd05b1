#include "verdicts/work.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "simd/random.h"
#include "verdicts/recorded.h"

namespace crescent {

namespace {

/// Roberts' R2 sequence: even cover of the unit square, the same for every seed.
Vec2d r2(std::uint64_t i, Vec2d shift) {
    const double x = shift.x + 0.7548776662466927 * static_cast<double>(i + 1), y = shift.y + 0.5698402909980532 * static_cast<double>(i + 1);
    const double top = 1 - 0x1p-24;
    return {std::min(x - std::floor(x), top), std::min(y - std::floor(y), top)};
}

bool multiples_of(std::span<const Draw> draws, double unit) {
    for (const Draw& d : draws)
        for (double v : {d.wi.x, d.wi.y, d.wi.z})
            if (std::fabs(v / unit - std::round(v / unit)) > 1e-6) return false;
    return true;
}

double grain_of(std::span<const Draw> all) {
    const std::span<const Draw> draws = all.first(std::min<std::size_t>(all.size(), 256));
    for (int digits = 3; digits <= 8; ++digits)
        if (multiples_of(draws, std::pow(10.0, -digits))) return 0.5 * std::pow(10.0, -digits);
    for (const Draw& d : draws)
        for (double v : {d.wi.x, d.wi.y, d.wi.z})
            if (static_cast<double>(static_cast<float>(v)) != v) {
                return std::fabs(v - static_cast<double>(static_cast<float>(v))) < 2e-9 * std::fabs(v) ? 0x1p-24 : 0x1p-50;
            }
    return 0x1p-24;
}

}  // namespace

Rigour Rigour::thorough() {
    Rigour r;
    r.full = true;
    r.draws = std::uint64_t{1} << 19;
    r.rings = 30;
    r.sectors = 32;
    r.evaluations = 1000000;
    return r;
}

void Rigour::share(std::uint64_t tests) {
    const double each = -std::expm1(std::log1p(-alpha) / static_cast<double>(std::max<std::uint64_t>(tests, 1)));
    screen = std::min(std::sqrt(10 * each), 0.05);
    confirm = std::min(each / screen, screen / 10);
}

Work::Work(const Trial& t, const Rigour& r, Tally& counts, std::uint32_t index) : trial(t), rigour(r), tally(counts), subject(*t.subject), index_(index), seed_(r.seed) {
    for (int k = 0; k < subject.techniques(); ++k) first_.push_back(draw(k, 0));
    grain_ = grain_of(first_[0].draws);
}

void Work::redraw(std::uint32_t seed) {
    seed_ = seed;
    for (std::size_t k = 0; k < first_.size(); ++k) first_[k] = draw(static_cast<int>(k), 0);
}

Batchful Work::draw(int technique, int round) const {
    Batchful b;
    if (const auto* tape = dynamic_cast<const RecordedSubject*>(&subject)) {
        tape->half(round, b.u, b.draws);
    } else {
        const std::uint64_t n = round == 0 ? rigour.draws : 4 * rigour.draws;
        const std::uint32_t seed = seed_of(seed_, static_cast<std::uint32_t>(round) * 7919u);
        b.u.resize(n);
        b.draws.resize(n);
        for (std::uint64_t i = 0; i < n; ++i) {
            const Vec2<float> u = crescent::draw(seed, index_, i, static_cast<std::uint32_t>(technique));
            b.u[i] = {u.x, u.y};
        }
        subject.sample(technique, trial.wo, b.u, b.draws);
    }
    b.pdf = pdf_of_drawn(technique, b.draws);
    for (std::size_t i = 0; i < b.draws.size(); ++i)
        if (is_nothing(b.draws[i], b.pdf[i])) ++b.nothing;
    return b;
}

/// A draw of nothing has no direction to ask about: 0.
std::vector<double> Work::pdf_of_drawn(int technique, std::span<const Draw> draws) const {
    std::vector<Vec3d> wi;
    for (const Draw& d : draws) wi.push_back(d.pdf > 0 ? d.wi : Vec3d{0, 0, 1});
    std::vector<double> p = pdf(technique, wi);
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!(draws[i].pdf > 0)) p[i] = 0;
    return p;
}

std::vector<double> Work::pdf(int technique, std::span<const Vec3d> wi, bool exact) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<double> out(wi.size());
    if (exact) subject.exact_pdf(technique, at, out);
    else subject.pdf(technique, at, out);
    return out;
}

std::vector<double> Work::any_pdf(std::span<const Vec3d> wi) const {
    std::vector<double> sum(wi.size());
    for (int t = 0; t < subject.techniques(); ++t) {
        const std::vector<double> p = pdf(t, wi, true);
        for (std::size_t i = 0; i < p.size(); ++i) sum[i] += p[i];
    }
    return sum;
}

std::vector<double> Work::f(std::span<const Vec3d> wi, bool truth) const {
    std::vector<Pair> at(wi.size());
    for (std::size_t i = 0; i < wi.size(); ++i) at[i] = {trial.wo, wi[i]};
    std::vector<double> out(wi.size());
    if (truth) subject.true_f(at, out);
    else subject.f(at, out);
    return out;
}

std::vector<double> Work::weights(std::span<const Batchful> techniques, bool even) const {
    std::vector<double> x(techniques[0].draws.size());
    for (std::size_t t = 0; t < techniques.size(); ++t) {
        const Batchful& b = techniques[t];
        std::vector<Pair> at;
        std::vector<Vec3d> wi;
        for (const Draw& d : b.draws) {
            wi.push_back(d.pdf > 0 && d.wi.z > 0 ? d.wi : Vec3d{0, 0, 1});
            at.push_back({trial.wo, wi.back()});
        }
        std::vector<double> mis(at.size());
        subject.mis_weight(static_cast<int>(t), at, mis);
        const std::vector<double> value = f(wi);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Draw& d = b.draws[i];
            if (!(d.pdf > 0) || d.wi.z <= 0) continue;
            const double of_one = d.weight ? *d.weight : value[i] * d.wi.z / d.pdf;
            x[i] += mis[i] * of_one * (even ? 1 : trial.light(d.wi));
        }
    }
    return x;
}

Verdict Work::verdict(std::string_view name, State state, std::string say) const {
    Verdict v;
    v.arm = trial.arm;
    v.trial = trial.text();
    v.name = name;
    v.state = state;
    v.say = std::move(say);
    return v;
}

double chi_squared_p(double statistic, double degrees) {
    if (!(degrees > 0)) return 1;
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(degrees), std::max(statistic, 0.0)));
}
double normal_p(double z) { return std::isfinite(z) ? std::erfc(std::fabs(z) / std::sqrt(2.0)) : 0.0; }
double student_p(double t, double degrees) {
    if (!std::isfinite(t)) return 0;
    return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(degrees), std::fabs(t)));
}

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
            if (d.pdf > 0) guides_.push_back(d.wi);
    }
    const SphereMap about(mirror(trial.wo));
    for (std::uint64_t i = 0; i < 384; ++i) {
        const Vec2d v = r2(i, {0.1, 0.7});
        guides_.push_back(about.direction({0.5 * std::pow(10.0, -7 * v.x), v.y}));
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
        Density d = sharp ? density_about(t, normalize(mean), false, rigour.evaluations) : density_about(t, n, true, rigour.evaluations);
        if (d.mass.error > 5e-5) {
            Density other = sharp ? density_about(t, n, true, rigour.evaluations) : density_about(t, normalize(peak), false, rigour.evaluations);
            if (other.mass.error < d.mass.error) d = std::move(other);
            if (d.mass.error > 1e-4) d = density_about(t, d.map.frame.n, d.about_n, 6 * rigour.evaluations);
        }
        if (b.nothing > 0 && subject.draws_at_will()) find_nothing(t, d, rigour.full ? 16384 : 2048);
        else d.nothing = static_cast<double>(b.nothing) / static_cast<double>(b.draws.size());
        // Too rare to have been met: half a million draws show a share of 5e-5 twenty times over.
        if (std::fabs(d.mass.value + d.nothing - 1) > 5e-5 && d.mass.value < 1 && subject.draws_at_will()) find_nothing(t, d, 32768);
        if (std::fabs(d.mass.value + d.nothing - 1) > 5e-5)  // nobody is accused on one quadrature's word
            d.second = density_about(t, d.about_n ? normalize(peak) : n, !d.about_n, 6 * rigour.evaluations, 2e-5).mass;
        density_.push_back(std::move(d));
    }
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
        out.bins[d.bin_of(at)].push_back(at);
    }
    return out;
}

std::size_t Density::bin_of(Vec2d at) const {
    const auto edge = std::upper_bound(rings.begin(), rings.end(), at.x);
    const auto ring = std::clamp<std::ptrdiff_t>(edge - rings.begin() - 1, 0, static_cast<std::ptrdiff_t>(rings.size()) - 2);
    const int sector = std::clamp(static_cast<int>(at.y * sectors), 0, sectors - 1);
    return static_cast<std::size_t>(ring * sectors + sector);
}

Density Work::density_about(int technique, Vec3d axis, bool about_n, std::size_t evaluations, double edge_mass) const {
    Density d;
    d.map = SphereMap(axis);
    d.about_n = about_n;
    d.sectors = rigour.sectors;
    std::vector<double> a;
    for (Vec3d w : std::span(guides_).first(guides_.size() - 384)) a.push_back(d.map.coordinates(w).x);
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
    std::vector<Rect> cells;
    const int rings = static_cast<int>(d.rings.size()) - 1;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < d.sectors; ++k)
            cells.push_back({d.rings[static_cast<std::size_t>(i)], d.rings[static_cast<std::size_t>(i) + 1], double(k) / d.sectors, double(k + 1) / d.sectors,
                             i * d.sectors + k});
    const SphereMap map = d.map;
    const Witnesses witnesses = witnesses_of(technique, d);
    d.mass = integrate(guided(std::move(cells), map, guides_), rings * d.sectors,
                       [&](std::span<const Vec2d> at, std::span<double> out) {
                           std::vector<Vec3d> wi;
                           for (Vec2d v : at) wi.push_back(map.direction(v));
                           const std::vector<double> p = pdf(technique, wi, true);
                           for (std::size_t i = 0; i < out.size(); ++i) out[i] = 2 * pi * p[i];
                       },
                       {edge_mass / 20, evaluations, edge_mass}, &witnesses);
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

const Integral& Work::incoming(Where where, bool even) const {
    auto& kept = incoming_[2 * static_cast<std::size_t>(where) + (even ? 1 : 0)];
    if (!kept) kept = where == Where::reached && incoming(Where::lost, even).value == 0 ? incoming(Where::everywhere, even) : integrate_incoming(where, even);
    return *kept;
}

Integral Work::integrate_incoming(Where where, bool even) const {
    const auto of_light = [&](std::span<const Vec3d> wi, std::span<double> out) {
        const std::vector<double> value = f(wi, true);
        const std::vector<double> p = where == Where::everywhere ? std::vector<double>(wi.size(), 1.0) : any_pdf(wi);
        for (std::size_t i = 0; i < out.size(); ++i) {
            const bool counts = where == Where::everywhere || (p[i] > 0) == (where == Where::reached);
            out[i] = counts && wi[i].z > 0 ? value[i] * wi[i].z : 0.0;
        }
    };
    const TrialLight& light = trial.light;
    const double fill = even ? 1 : light.fill;
    Integral total;
    if (fill > 0) {
        const SphereMap map(Vec3d{0, 0, 1});
        total = integrate(guided(graded_cells(1), map, guides_), 1,
                          [&](std::span<const Vec2d> at, std::span<double> out) {
                              std::vector<Vec3d> wi;
                              for (Vec2d v : at) wi.push_back(map.direction(v));
                              of_light(wi, out);
                              for (double& v : out) v *= 2 * pi * fill;
                          },
                          {5e-6, rigour.evaluations});
    }
    if (!even && light.has_disk()) {
        const Frame<double> frame = frame_about(light.normal);
        std::vector<Rect> cells;  // a = (r/R)^2, b = turns: dA = pi R^2 da db
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 8; ++k) cells.push_back({i / 4.0, (i + 1) / 4.0, k / 8.0, (k + 1) / 8.0, 0});
        const Integral disk = integrate(cells, 1,
                                        [&](std::span<const Vec2d> at, std::span<double> out) {
                                            std::vector<Vec3d> wi;
                                            std::vector<double> per_area;
                                            for (Vec2d v : at) {
                                                const double r = light.radius * std::sqrt(v.x), phi = 2 * pi * v.y;
                                                const Vec3d y = light.center + frame.t * (r * std::cos(phi)) + frame.b * (r * std::sin(phi));
                                                wi.push_back(normalize(y));
                                                per_area.push_back(std::max(-dot(wi.back(), light.normal), 0.0) / dot(y, y));
                                            }
                                            of_light(wi, out);
                                            for (std::size_t i = 0; i < out.size(); ++i)
                                                out[i] *= per_area[i] * pi * sqr(light.radius) * (light.radiance - fill);
                                        },
                                        {5e-6, rigour.evaluations / 4});
        total.value += disk.value;
        total.error += disk.error;
        total.settled = total.settled && disk.settled;
    }
    return total;
}

}  // namespace crescent
