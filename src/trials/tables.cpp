// Densities that are tables: cells summed one by one, and what is granted where p was tabulated.
#include <algorithm>
#include <cmath>

#include "cubature/mesh.h"
#include "trials/densities.h"

namespace crescent::inline trials {

/// A density that jumps along heights and azimuths about an axis: the normal, or for a sky any axis of the frame. Its
/// cells are summed, or sampled where a program would be asked too often. Where it jumps at heights alone, they become
/// edges of rings.
std::optional<Density> Densities::table_density(int t) {
    constexpr std::size_t most_heights = 64;
    banded_.reset();
    std::vector<Vec3d> axes = {{0, 0, 1}};
    if (traits.wo == Traits::Asked::none) axes.insert(axes.end(), {{0, 1, 0}, {1, 0, 0}});
    for (Vec3d axis : axes) {
        Density d = bins_about(axis, axis.z == 1);
        const Batch g = batch_of(t, d.map);
        const Jumps jumps = find_jumps(g);
        const std::optional<Mesh> mesh = mesh_of(jumps);
        if (std::vector<double> heights = heights_of(jumps);
            !mesh && !banded_ && !heights.empty() && heights.size() <= most_heights)
            banded_ = axis, heights_ = std::move(heights);
        if (!mesh) continue;
        const SamplesPerBin seen = samples_per_bin_of(t, d);
        const Prepare crowd = [&](std::vector<Rect> cells) {
            return refined_at_pilots(std::move(cells), d.map, pilot_directions_);
        };
        const std::size_t most = subject.limited() && !settings.full ? affordable(400000, for_later()) / 2 : 10000000;
        std::optional<Integral> mass;
        if (mesh->cells() <= most)
            mass = integrate_mesh(*mesh, d.rings, d.sectors, g,
                {2.5e-6, affordable(6 * settings.evaluations, for_later()), 5e-5}, direction_resolution(), crowd,
                &seen);
        else
            mass = integrate_by_points(crowd(cells_of(d)), static_cast<int>((d.rings.size() - 1)) * d.sectors, g,
                affordable(4 * settings.evaluations, for_later()));
        if (!mass) continue;
        d.mass = std::move(*mass);
        grant_tabulation_error(t, d);
        share_nothing(t, d);
        return d;
    }
    return {};
}

void Densities::grant_tabulation_error(int technique, Density& d) const {
    for (const TabulationError& part : subject.tabulation_errors()) {
        d.tabulation_errors.resize(d.mass.bins.size());
        d.tabulation_errors[d.bin_of(d.map.coordinates(part.at))] += part.mass;
        d.tabulation_error += part.mass;
    }
    if (!d.tabulation_errors.empty()) refine_table(technique, d);
}

/// Draws know their p where the table only nearly does: over those in a bin, table / p comes to the table's integral /
/// p's. The bin is set right by that, as far as its doubt reaches, and is then known to the spread of table / p: twice
/// the standard error of its mean, and a tenth for draws that do not follow p.
void Densities::refine_table(int technique, Density& d) const {
    struct Ratio {
        double n = 0, sum = 0, squares = 0;
    };
    std::vector<Ratio> ratio(d.tabulation_errors.size());
    const SampleBatch& b = first(technique);
    const std::vector<Vec2d>& at = coordinates_of(b, d.map);
    for (std::size_t i = 0; i < b.draws.size(); ++i) {
        if (is_null_sample(b.draws[i], b.pdf[i])) continue;
        Ratio& r = ratio[d.bin_of(at[i])];
        const double v = b.pdf[i] / b.draws[i].pdf;
        ++r.n;
        r.sum += v;
        r.squares += v * v;
    }
    for (std::size_t k = 0; k < d.tabulation_errors.size(); ++k) {
        const Ratio& r = ratio[k];
        if (r.n < 8 || !(d.mass.bins[k] > 0)) continue;
        const double mean = r.sum / r.n, sd = std::sqrt(std::max(r.squares / r.n - mean * mean, 0.0)),
                     reach = d.tabulation_errors[k] / d.mass.bins[k];
        const double right = d.mass.bins[k] / std::clamp(mean, std::max(1 - reach, 0.1), 1 + reach);
        d.mass.value += right - d.mass.bins[k];
        d.mass.bins[k] = right;
        d.tabulation_errors[k] = std::min(d.tabulation_errors[k], right * sd * (2 / std::sqrt(r.n) + 0.1));
    }
}

}  // namespace crescent::inline trials
