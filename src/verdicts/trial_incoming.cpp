// What arrives: int f L cos over the hemisphere, or where p is (not) positive, by cubature.
#include <algorithm>
#include <cmath>
#include <functional>

#include "math/functions.h"
#include "verdicts/trial_context.h"

namespace crescent::inline verdicts {

const Integral& TrialContext::incoming(Where where, bool even) const {
    even = even && (!trial.light.disks.empty() || trial.light.fill != 1);  // the light may be even already
    auto& kept = incoming_[2 * static_cast<std::size_t>(where) + (even ? 1 : 0)];
    if (!kept)
        kept = where == Where::reached && incoming(Where::lost, even).value == 0 ? incoming(Where::everywhere, even)
                                                                                 : integrate_incoming(where, even);
    return *kept;
}

namespace {

using OfLight = TrialContext::OfLight;
constexpr std::size_t for_confirmation = 90000;  // questions: 30,000 fresh draws with p and f at each

/// Another disk stands before y.
bool hidden(const TrialLight& light, const TrialDisk& own, Vec3d y) {
    const double far = length(y);
    const Vec3d wi = y * (1 / far);
    for (const TrialDisk& other : light.disks)
        if (const std::optional<double> d = other.distance(wi); &other != &own && d && *d < far) return true;
    return false;
}

/// Adds int f L cos over what a disk shows, above the fill that it hides; of_light: f cos where it counts.
void add_disk(Integral& total, const TrialLight& light, const TrialDisk& disk, const OfLight& of_light,
    double tolerance, std::size_t evaluations) {
    const Frame<double> frame = frame_about(disk.normal);
    std::vector<Rect> cells;  // a = (r/R)^2, b = turns: dA = pi R^2 da db
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 8; ++k) cells.push_back({i / 4.0, (i + 1) / 4.0, k / 8.0, (k + 1) / 8.0, 0});
    const double strength = pi * sqr(disk.radius) * (disk.radiance - light.fill);
    const Integral of_disk = integrate(cells, 1,
        [&](std::span<const Vec2d> at, std::span<double> out) {
            std::vector<Vec3d> wi;
            std::vector<double> per_area;
            for (Vec2d v : at) {
                const double r = disk.radius * std::sqrt(v.x), phi = 2 * pi * v.y;
                const Vec3d y = disk.center + frame.t * (r * math::cos(phi)) + frame.b * (r * math::sin(phi));
                wi.push_back(normalize(y));
                per_area.push_back(
                    hidden(light, disk, y) ? 0 : std::max(-dot(wi.back(), disk.normal), 0.0) / dot(y, y));
            }
            of_light(wi, out);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] *= per_area[i] * strength;
        },
        {tolerance, evaluations});
    total.value += of_disk.value;
    total.error += of_disk.error;
    total.settled = total.settled && of_disk.settled;
}

}  // namespace

Integral TrialContext::albedo_of(int channel) const { return integrate_incoming(Where::everywhere, true, channel); }

Integral TrialContext::integrate_incoming(Where where, bool even, int channel) const {
    return integrate_light(
        [&](std::span<const Vec3d> wi, std::span<double> out) {
            const std::vector<double> value = channel < 0 ? f(wi, true) : f_of_channel(wi, channel);
            const std::vector<double> p =
                where == Where::everywhere ? std::vector<double>(wi.size(), 1.0) : any_pdf(wi);
            for (std::size_t i = 0; i < out.size(); ++i) {
                const bool counts = where == Where::everywhere || (p[i] > 0) == (where == Where::reached);
                out[i] = counts && this->counts(wi[i]) ? value[i] * std::fabs(wi[i].z) : 0.0;
            }
        },
        even);
}

Integral TrialContext::integrate_light(const OfLight& of_light, bool even) const {
    const TrialLight& light = trial.light;
    const double fill = even ? 1 : light.fill;
    Integral total;
    if (fill > 0) {
        const SphereMap map(Vec3d{0, 0, 1});
        std::vector<Rect> cells = graded_cells(1);
        for (std::size_t i = 0, upper = cells.size(); whole() && i < upper; ++i)
            cells.push_back({2 - cells[i].a1, 2 - cells[i].a0, cells[i].b0, cells[i].b1, 1});
        total = integrate(guided(std::move(cells), map, guides_), whole() ? 2 : 1,
            [&](std::span<const Vec2d> at, std::span<double> out) {
                std::vector<Vec3d> wi;
                for (Vec2d v : at) wi.push_back(map.direction(v));
                of_light(wi, out);
                for (double& v : out) v *= 2 * pi * fill;
            },
            {tolerance(), affordable(2 * rigour.evaluations, for_confirmation) / 2});
    }
    for (const TrialDisk& disk : light.disks)
        if (!even)
            add_disk(
                total, light, disk, of_light, tolerance(), affordable(rigour.evaluations / 2, for_confirmation) / 2);
    return total;
}

}  // namespace crescent::inline verdicts
