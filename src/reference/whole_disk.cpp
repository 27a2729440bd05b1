// Lambert's part in closed form. The lobe by polar rules of rising order, Gauss-Legendre in r^2 times even angles, from
// 3 points to 3840, until two of them agree to 1e-5 of the pixel.
#include "reference/whole_disk.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "math/gauss.h"

namespace crescent::inline reference {

namespace {

/// Gauss-Legendre in r^2, evenly spaced in angle: nodes on the unit disk, weights summing to pi.
struct PolarRule {
    struct Node {
        double x, y, weight;
    };
    std::vector<Node> nodes;

    template <unsigned radial> static PolarRule make(int angular) {
        PolarRule rule;
        using G = math::Gauss<radial>;
        const auto ring = [&](double abscissa, double weight) {
            const double r = std::sqrt(0.5 * (1 + abscissa));
            for (int k = 0; k < angular; ++k) {
                const double phi = 2 * pi * (k + 0.5) / angular;
                rule.nodes.push_back({r * math::cos(phi), r * math::sin(phi), 0.5 * weight * pi / angular});
            }
        };
        for (std::size_t k = 0; k < G::abscissa().size(); ++k) {
            ring(G::abscissa()[k], G::weights()[k]);
            if (G::abscissa()[k] != 0) ring(-G::abscissa()[k], G::weights()[k]);
        }
        return rule;
    }
};

const std::vector<PolarRule>& polar_rules() {
    static const std::vector<PolarRule> rules = {PolarRule::make<1>(3), PolarRule::make<2>(5), PolarRule::make<3>(7),
        PolarRule::make<5>(12), PolarRule::make<7>(17), PolarRule::make<10>(25), PolarRule::make<15>(36),
        PolarRule::make<25>(60), PolarRule::make<40>(96)};
    return rules;
}

/// The whole disk is above the horizon and open, Lambert: integral of cos(theta_i) dw / pi in closed form. The light's
/// vector irradiance has a part along the disk's axis and a part towards it (Howell's catalog of view factors, elements
/// parallel and perpendicular to a disk), written without cancellation.
double whole_disk_diffuse(const DiskPoint& point, const shapes::Disk& disk) {
    const Vec3d d = disk.center - point.x;
    const double along = dot(d, disk.normal), r2 = sqr(disk.radius), h = std::fabs(along);
    const Vec3d axis = along < 0 ? -disk.normal : disk.normal;
    const Vec3d aside = d - h * axis;
    const double p2 = dot(aside, aside), a = p2 + h * h + r2;
    const double root = std::sqrt(a * a - 4 * r2 * p2);
    const double parallel = r2 * (1 - 2 * p2 / (a + root)) / root;
    return dot(point.frame.n, axis) * parallel + dot(point.frame.n, aside) * (2 * h * r2 / (root * (a + root)));
}

}  // namespace

DiskIntegral whole_disk(const DiskPoint& point, const shapes::Disk& disk, const Frame<double>& frame) {
    DiskIntegral out;
    out.diffuse = whole_disk_diffuse(point, disk);
    if (!(point.surface.rho_s > 0)) return out;
    const auto apply = [&](const PolarRule& rule) {
        double sum = 0;
        for (const auto& n : rule.nodes)
            sum +=
                n.weight * point.lobe_at(disk.center + frame.t * (disk.radius * n.x) + frame.b * (disk.radius * n.y));
        return sum * sqr(disk.radius);
    };
    constexpr double good = 1e-5;  // relative, between two rules; the finer one, which is kept, is better by far
    const auto& rules = polar_rules();
    double coarse = apply(rules[0]);
    for (std::size_t k = 1; k < rules.size(); ++k) {
        out.lobe = apply(rules[k]);
        out.lobe_error = std::fabs(out.lobe - coarse);
        if (point.weigh({0, out.lobe_error}) <= good * point.weigh({out.diffuse, out.lobe})) break;
        coarse = out.lobe;
    }
    return out;
}

}  // namespace crescent::inline reference
