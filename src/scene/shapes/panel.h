// panel: a recess. A ray enters through the opening, a parallelogram, and meets the back or one of the four sides.
#pragma once

#include "scene/shapes/quad.h"

namespace crescent::shapes {

struct Panel {
    static constexpr std::string_view name = "panel";
    static constexpr std::string_view summary = "a recess behind an opening, with a back and four sides";
    Vec3d corner{}, edge_u{}, edge_v{};  // of the opening; its outward normal is edge_u x edge_v
    double depth = 0;                    // how far it is set back, against the normal
    std::optional<Rgb> reveal_rho_d;     // the four sides of the recess

    static constexpr auto parameters() {
        return std::array{parameter::place("corner", &Panel::corner, "A corner of the opening."),
            parameter::place("edge_u", &Panel::edge_u, "First edge from the corner."),
            parameter::place("edge_v", &Panel::edge_v, "Second edge; the opening faces along edge_u x edge_v."),
            parameter::length("depth", &Panel::depth, "How far the panel is set back behind its opening."),
            parameter::albedo(
                "reveal_rho_d", &Panel::reveal_rho_d, "rho_d", "Diffuse albedo of the four sides of the recess.")};
    }
    std::optional<Mistake> mistake() const { return mistake_of_edges(edge_u, edge_v); }

    Intersection intersect(Vec3d x, Vec3d d) const {
        const Vec3d n = normalize(cross(edge_u, edge_v));
        const double opening = parallelogram_t(corner, edge_u, edge_v, x, d);
        if (opening == never || dot(n, d) >= 0) return {};
        const Vec3d depth_edge = -depth * n;
        Intersection best = crossing_at(parallelogram_t(corner + depth_edge, edge_u, edge_v, x, d), n);
        const auto side = [&](Vec3d from, Vec3d edge) {
            const double t = parallelogram_t(from, edge, depth_edge, x, d);
            if (t >= opening && t < best.t)
                best = {.t = t, .order = t, .n = normalize(cross(edge, depth_edge)), .reveal = true};
        };
        side(corner, edge_u);
        side(corner, edge_v);
        side(corner + edge_v, edge_u);
        side(corner + edge_u, edge_v);
        best.order = opening * (1 - 1e-9);  // before the surface that contains it
        return best;
    }

    /// Returns the bodies that hide a light: the back and the four sides.
    std::array<Quad, 5> bodies() const {
        const Vec3d depth_edge = -depth * normalize(cross(edge_u, edge_v));
        return {Quad{corner + depth_edge, edge_u, edge_v}, {corner, edge_u, depth_edge}, {corner, edge_v, depth_edge},
            {corner + edge_v, edge_u, depth_edge}, {corner + edge_u, edge_v, depth_edge}};
    }
};

}  // namespace crescent::shapes
