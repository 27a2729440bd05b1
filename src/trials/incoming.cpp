// What arrives: int f L cos over the hemisphere, or where p is (not) positive, by cubature.
#include <algorithm>
#include <cmath>
#include <functional>

#include "math/functions.h"
#include "trials/integrals.h"

namespace crescent::inline trials {

void Integrals::redraw(std::uint32_t seed) {
    unmet_ = {};
    Draws::redraw(seed);
}

const Integral& Integrals::incoming(Where where, bool even) const {
    even = even && (!trial.light.even() || trial.light.fill != 1);  // the light may be even already
    auto& kept = incoming_[2 * static_cast<std::size_t>(where) + (even ? 1 : 0)];
    if (!kept)
        kept = where == Where::reached && (scatter().pdf() || incoming(Where::lost, even).value == 0)
            ? incoming(Where::everywhere, even)
            : integrate_incoming(where, even);
    return *kept;
}

namespace {

using OfLight = Integrals::OfLight;
constexpr std::size_t for_confirmation = 90000;  // questions: 30,000 fresh draws with p and f at each

/// Another light stands before that one, which lies at y or where wi meets it.
template <class Light> bool hidden(const TrialLight& light, const Light& own, Vec3d y) {
    const double far = length(y);
    const Vec3d wi = y * (1 / far);
    const double here = own.distance(wi).value_or(far);
    const auto before = [&](const auto& lights) {
        return std::ranges::any_of(lights, [&](const auto& other) {
            const std::optional<double> d = other.distance(wi);
            return static_cast<const void*>(&other) != &own && d && *d < here;
        });
    };
    return before(light.disks) || before(light.lamps);
}

/// The flat figure in whose directions a light is seen, over the unit square: y(a, b), and dA = area da db, m^2.
struct Sheet {
    Vec3d normal{};
    double area = 0;
    std::function<Vec3d(Vec2d)> at;
};
Sheet sheet_of(const shapes::Disk& disk) {
    const Frame<double> frame = frame_about(disk.normal);  // a = (r/R)^2, b = turns
    return {disk.normal, pi * sqr(disk.radius), [disk, frame](Vec2d v) {
                const double r = disk.radius * std::sqrt(v.x);
                const auto [sin, cos] = math::sincos(2 * pi * v.y);
                return disk.center + frame.t * (r * cos) + frame.b * (r * sin);
            }};
}
Sheet sheet_of(const shapes::Quad& quad) {
    const Vec3d across = cross(quad.edge_u, quad.edge_v);
    return {normalize(across), length(across),
        [quad](Vec2d v) { return quad.corner + quad.edge_u * v.x + quad.edge_v * v.y; }};
}
Sheet sheet_of(const TrialDisk& disk) { return sheet_of(shapes::Disk{disk.center, disk.normal, disk.radius}); }
Sheet sheet_of(const TrialLamp& lamp) {
    const Figure seen = std::visit([](const auto& light) { return light.seen_from({}); }, lamp.form);
    return std::visit([](const auto& figure) { return sheet_of(figure); }, seen);
}

/// Adds int f L cos over what a light shows, above the fill that it hides; of_light: f cos where it counts.
template <class Light> void add_light(Integral& total, const Draws& work, const Light& own, const OfLight& of_light,
    double tolerance, std::size_t evaluations) {
    const TrialLight& light = work.trial.light;
    const Sheet sheet = sheet_of(own);
    std::vector<Rect> cells;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 8; ++k) cells.push_back({i / 4.0, (i + 1) / 4.0, k / 8.0, (k + 1) / 8.0, 0});
    const double strength = sheet.area * (own.radiance - light.fill);
    const Integral of_own = integral_of(
        cells, 1,
        [&](std::span<const Vec2d> at, std::span<double> out) {
            std::vector<Vec3d> wi;
            std::vector<double> per_area;
            for (Vec2d v : at) {
                const Vec3d y = sheet.at(v);
                wi.push_back(normalize(y));
                per_area.push_back(
                    hidden(light, own, y) ? 0 : std::max(-dot(wi.back(), sheet.normal), 0.0) / dot(y, y));
            }
            of_light(wi, out);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] *= per_area[i] * strength;
        },
        {tolerance, evaluations}, work.scatter().any());
    total.value += of_own.value;
    total.error += of_own.error;
    total.settled = total.settled && of_own.settled;
}

}  // namespace

Integral Integrals::albedo_of(int channel) const { return integrate_incoming(Where::everywhere, true, channel); }

Integral Integrals::integrate_incoming(Where where, bool even, int channel) const {
    return integrate_light(
        [&](std::span<const Vec3d> wi, std::span<double> out) {
            const std::vector<double> value = channel < 0 ? f(wi, true) : f_of_channel(wi, channel);
            std::vector<double> p = where == Where::everywhere ? std::vector<double>(wi.size(), 1.0) : any_pdf(wi);
            if (scatter().pdf()) ask_again_at_zeros(wi, value, p);
            for (std::size_t i = 0; i < out.size(); ++i) {
                const bool counts = where == Where::everywhere || (p[i] > 0) == (where == Where::reached);
                out[i] = counts && this->counts(wi[i]) ? value[i] * std::fabs(wi[i].z) : 0.0;
            }
        },
        even);
}

Integral Integrals::integrate_light(const OfLight& of_light, bool even) const {
    const TrialLight& light = trial.light;
    const double fill = even ? 1 : light.fill;
    Integral total;
    if (fill > 0) {
        const SphereMap map(Vec3d{0, 0, 1});
        std::vector<Rect> cells = graded_cells(1);
        for (std::size_t i = 0, upper = cells.size(); whole() && i < upper; ++i)
            cells.push_back({2 - cells[i].a1, 2 - cells[i].a0, cells[i].b0, cells[i].b1, 1});
        total = integral_of(
            refined_at_pilots(std::move(cells), map, pilot_directions_), whole() ? 2 : 1,
            [&](std::span<const Vec2d> at, std::span<double> out) {
                std::vector<Vec3d> wi;
                for (Vec2d v : at) wi.push_back(map.direction(v));
                of_light(wi, out);
                for (double& v : out) v *= 2 * pi * fill;
            },
            {tolerance(), affordable(2 * settings.evaluations, for_confirmation) / 2}, scatter().any());
    }
    const auto add = [&](const auto& own) {
        add_light(total, *this, own, of_light, tolerance(), affordable(settings.evaluations / 2, for_confirmation) / 2);
    };
    if (even) return total;
    std::ranges::for_each(light.disks, add);
    std::ranges::for_each(light.lamps, add);
    return total;
}

}  // namespace crescent::inline trials
