// The shape that s belongs to: the one named by s_of, else the first with a lobe, else the first that states an s.
#include "scene/scene_data.h"

#include <algorithm>
#include <cmath>

namespace crescent {

// ---- rho_s is the luminance of a coloured lobe and its tint is the colour over that, so that grey lobes keep their
// bits; the default alpha is sqrt(2 / (s + 2)) (Walter et al. 2007).

void Material::set_specular(const Rgb& color) {
    const double y = luminance(color);
    const bool grey = color[0] == color[1] && color[1] == color[2];
    rho_s = grey ? color[0] : y;
    specular = grey ? std::nullopt : std::optional<Rgb>(color);
}

Surface surface_of(const Material& m, double common_s) {
    const double s = m.s.value_or(common_s);
    Surface out = {
        .rho_d = m.rho_d, .rho_s = m.rho_s, .brdf = m.brdf, .s = s, .alpha = m.alpha.value_or(std::sqrt(2 / (s + 2)))};
    for (std::size_t c = 0; m.specular && m.rho_s > 0 && c < 3; ++c) out.tint[c] = (*m.specular)[c] / m.rho_s;
    return out;
}

// ---- Calls the functions of each kind of shape; a shape that consists of several bodies, such as a panel, adds all of
// them.

Intersection intersect(const Shape& shape, Vec3d x, Vec3d d) {
    return std::visit([&](const auto& form) { return form.intersect(x, d); }, shape.form);
}

void add_occluders(const Shape& shape, int index, std::vector<Occluder>& out) {
    std::visit(
        [&](const auto& form) {
            if constexpr (Body<std::remove_cvref_t<decltype(form)>>) out.push_back({form, index});
            else
                for (const auto& body : form.bodies()) out.push_back({body, index});
        },
        shape.form);
}

std::optional<Rgb> albedo_of_reveal(const Shape& shape) {
    return std::visit(
        [](const auto& form) -> std::optional<Rgb> {
            if constexpr (requires { form.reveal_rho_d; }) return form.reveal_rho_d;
            else return {};
        },
        shape.form);
}

// ---- The segment in which a plane through the viewpoint, with normal k, cuts a disk or a quad; positions in m from
// the viewpoint.

std::optional<Line> cut(const shapes::Disk& disk, Vec3d center, Vec3d k) {
    const Vec3d tangent = k - dot(k, disk.normal) * disk.normal;
    const double size2 = dot(tangent, tangent), distance = dot(k, center);
    if (!(size2 * sqr(disk.radius) > sqr(distance))) return {};
    const double half = std::sqrt(sqr(disk.radius) - sqr(distance) / size2);
    const Vec3d foot = center - (distance / size2) * tangent,
                half_chord = (half / std::sqrt(size2)) * cross(disk.normal, tangent);
    return Line{foot - half_chord, foot + half_chord};
}

std::optional<Line> cut(const shapes::Quad& quad, Vec3d corner, Vec3d k) {
    const std::array corners = {corner, corner + quad.edge_u, corner + quad.edge_u + quad.edge_v, corner + quad.edge_v};
    std::array<Vec3d, 2> ends{};
    std::size_t end_count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d p = corners[i], q = corners[(i + 1) % 4];
        const double hp = dot(k, p), hq = dot(k, q);
        if ((hp >= 0) == (hq >= 0) || end_count == 2) continue;
        ends[end_count++] = p + (hp / (hp - hq)) * (q - p);
    }
    if (end_count < 2) return {};
    return Line{ends[0], ends[1]};
}

const std::string& SceneData::surface_name(std::size_t surface) const {
    return surface < shapes.size() ? shapes[surface].name : meshes[surface - shapes.size()].name;
}
const Material& SceneData::material(std::size_t surface) const {
    return surface < shapes.size() ? shapes[surface].material : meshes[surface - shapes.size()].material;
}
Material& SceneData::material(std::size_t surface) {
    return surface < shapes.size() ? shapes[surface].material : meshes[surface - shapes.size()].material;
}

std::vector<std::string> SceneData::surface_names() const {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < surface_count(); ++k) names.push_back(surface_name(k));
    return names;
}

std::optional<std::size_t> SceneData::find_surface(std::string_view name) const {
    for (std::size_t k = 0; k < surface_count(); ++k)
        if (surface_name(k) == name) return k;
    return {};
}

std::optional<std::size_t> SceneData::surface_of_s() const {
    const auto first = [&](auto holds) -> std::optional<std::size_t> {
        for (std::size_t k = 0; k < surface_count(); ++k)
            if (material(k).s && !material(k).inherits_s && holds(k)) return k;
        return {};
    };
    if (!s_of.empty())
        if (const auto match = first([&](std::size_t k) { return surface_name(k) == s_of; })) return match;
    if (const auto lobe = first([&](std::size_t k) { return material(k).rho_s > 0; })) return lobe;
    return first([](std::size_t) { return true; });
}

double SceneData::s() const {
    const std::optional<std::size_t> surface = surface_of_s();
    return surface ? *material(*surface).s : 0;
}

// ---- Meshes.

Affine Placement::transform() const {
    if (matrix) {
        const auto column = [&](std::size_t k) { return Vec3d{(*matrix)[k], (*matrix)[4 + k], (*matrix)[8 + k]}; };
        return {.x = column(0), .y = column(1), .z = column(2), .shift = column(3)};
    }
    return translation(translate).after(rotation(rotate).after(scaling(scale)));
}

const Shape* SceneData::find_shape(std::string_view name) const {
    const auto it = std::find_if(shapes.begin(), shapes.end(), [&](const Shape& shape) { return shape.name == name; });
    return it == shapes.end() ? nullptr : &*it;
}

}  // namespace crescent
