// A scene as plain data: made in code, or read from an experiment file. Lengths in m, radiance in W/(sr m^2), angles in
// degrees, albedos in [0, 1]; y is up; the camera space is right-handed.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "base/vec.h"
#include "scene/lights/all.h"
#include "scene/lobes/lobe.h"
#include "scene/mesh/rays.h"
#include "scene/shapes/all.h"
#include "scene/sky.h"
#include "scene/texture.h"

namespace crescent {

// ---- The reflection of a surface: f = rho_d/pi + rho_s * lobe(s or alpha), albedos in [0, 1], f in 1/sr.

/// A material as given. A Lambert surface has rho_s = 0; its s only affects the samplers.
struct Material {
    Rgb rho_d{};
    double rho_s = 0;  // of the lobe; for a coloured lobe, its luminance
    LobeKind brdf{0};
    std::optional<double> s;        // Phong exponent
    std::optional<double> alpha;    // GGX roughness, (0, 1], no remapping
    bool inherits_s = false;        // s is not the shape's own but the scene's
    std::optional<Rgb> specular{};  // albedo of a coloured lobe, rho_s being its luminance

    /// Sets a coloured albedo of the lobe; a grey one is a number.
    void set_specular(const Rgb& color);
};

/// A material with every default filled in.
struct Surface {
    Rgb rho_d{};
    double rho_s = 0;
    LobeKind brdf{0};
    double s = 0, alpha = 0;
    Rgb tint = {1, 1, 1};  // the lobe's albedo is rho_s * tint

    /// Returns Y of what the lobe reflects of light of this colour, over rho_s.
    double tinted(const Rgb& light) const {
        return luminance(Rgb{light[0] * tint[0], light[1] * tint[1], light[2] * tint[2]});
    }
};

/// Returns a material's surface in a scene whose common exponent is s. The default alpha is sqrt(2/(s+2)), as wide as a
/// Blinn-Phong lobe of exponent s (Walter et al. 2007), so that a GGX sampler works on any surface.
Surface surface_of(const Material& material, double common_s);

// ---- Lights: radiance in W/(sr m^2), lengths in m; only sampled rays see them.

inline constexpr std::size_t most_lights = 64;  // in one scene

struct Light {
    std::string name;
    LightKinds::Any form;  // one of the kinds of lights/all.h
    Rgb radiance{};
    SourceLocation location;
    std::string_view kind() const { return LightKinds::names[form.index()]; }

    /// Returns the body with which it hides the lights behind it.
    Bodies::Any body() const {
        return std::visit([](const auto& f) -> Bodies::Any { return f.body(); }, form);
    }
    /// Returns whether an emitting side faces x.
    bool shines_on(Vec3d x) const {
        return std::visit([&](const auto& f) { return f.shines_on(x); }, form);
    }
    /// Returns the figure whose directions it covers as seen from x.
    Figure seen_from(Vec3d x) const {
        return std::visit([&](const auto& f) { return f.seen_from(x); }, form);
    }
    /// Returns the weight in the choice among lights: Y(L) times its largest projected area, over pi.
    double power() const {
        return luminance(radiance) * std::visit([](const auto& f) { return f.disk_area(); }, form);
    }
    bool is_disk() const { return form.index() == 0; }
};

/// A disk that emits `radiance` from the side its normal points to (or both): the light of [disks.NAME].
struct DiskLight {
    std::string name;
    Vec3d center{}, normal{};
    double radius = 0;
    Rgb radiance{};
    bool two_sided = false;
    SourceLocation location;
    Light light() const {
        return {.name = name,
            .form = lights::Disk{.center = center, .normal = normal, .radius = radius, .two_sided = two_sided},
            .radiance = radiance,
            .location = location};
    }
};

// ---- Shapes and camera. Lengths in m.

/// One shape: its geometry and its reflection.
struct Shape {
    std::string name;
    Shapes::Any form;  // one of the kinds of shapes/all.h
    Material material;
    bool occludes = false;  // whether it hides lights
    SourceLocation location;
    std::string_view kind() const { return Shapes::names[form.index()]; }
};

/// A convex body that can lie between a surface and a light. A shape that is not convex consists of several.
struct Occluder {
    Bodies::Any body;
    int shape = -1;  // this shape is never shadowed by it
};

/// Returns where the ray x + t d first meets the shape.
Intersection intersect(const Shape& shape, Vec3d x, Vec3d d);

/// Adds the bodies with which it hides lights, as shape `index`.
void add_occluders(const Shape& shape, int index, std::vector<Occluder>& out);

/// Returns the diffuse albedo of the sides of a recess, if the shape has one and states it.
std::optional<Rgb> albedo_of_reveal(const Shape& shape);

// ---- Triangle meshes, from files. Lengths in m, angles in degrees, radiance in W/(sr m^2).

/// Where a mesh is placed: scaled, rotated about the axes x, y, z in this order, moved. Or by a matrix, row by row: the
/// images of the axes and of the origin are its columns.
struct Placement {
    Vec3d translate{}, rotate{}, scale{1, 1, 1};
    std::optional<std::array<double, 12>> matrix;
    Affine transform() const;
};

/// A mesh with its material. Its triangles reflect from both sides.
struct MeshObject {
    std::string name;
    std::string file;                      // its .mesh file, relative to the experiment's
    std::shared_ptr<const MeshPack> pack;  // its content, once read
    Placement placement;
    std::vector<Placement> instances;  // placed after `placement`; empty: once
    Material material;
    Texture rho_d_texture, alpha_texture;  // factors of the material's rho_d and alpha
    std::optional<std::string> content;    // 16 hexadecimal digits of content_of(); none: not known
    Rgb emission{};                        // radiance of its front sides
    bool two_sided = false;                // whether it emits from the back too
    SourceLocation location;

    bool emits() const { return emission[0] > 0 || emission[1] > 0 || emission[2] > 0; }
};

/// A triangle that emits light, in the scene.
struct TriangleLight {
    std::array<Vec3d, 3> corner;       // m; counterclockwise seen from the side that emits
    std::uint32_t instance, triangle;  // as in MeshHit
    int mesh;                          // index into SceneData::meshes
};

// ---- A pinhole camera and its grid of pixels. Lengths in m, angles in degrees; right-handed.

struct Image {
    int width = 0, height = 0;  // pixels
};

/// Inclusive pixel coordinates at the image's size, origin bottom-left.
struct Box {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
    bool operator==(const Box&) const = default;
};

inline constexpr int any_surface = -1;

/// The pixels of a box, or those of them in which the camera sees one surface.
struct Area {
    Box box{};
    int surface = any_surface;  // an index of a surface, as in Hit::shape
};

struct Camera {
    Vec3d eye{}, target{}, up{};
    double vfov_deg = 0;  // vertical field of view
};

// ---- The flat figure that covers the directions of a light as seen from a point: the domain of the reference's
// integral. Lengths in m.

/// Returns the normal of the side that a light's figure emits from.
inline Vec3d normal_of(const shapes::Disk& disk) { return disk.normal; }
inline Vec3d normal_of(const shapes::Quad& quad) { return normalize(cross(quad.edge_u, quad.edge_v)); }
inline Vec3d normal_of(const Figure& figure) {
    return std::visit([](const auto& f) { return normal_of(f); }, figure);
}
/// Returns the centre of a figure, m.
inline Vec3d middle_of(const Figure& figure) {
    return std::visit([](const auto& f) { return f.middle(); }, figure);
}
/// Returns how far a figure extends from its middle along an axis, m.
inline double half_extent_of(const Figure& figure, Vec3d axis) {
    return std::visit([&](const auto& f) { return f.half_extent(axis); }, figure);
}

/// Returns the radius of the disk around its middle that contains it, m.
inline double radius_of(const shapes::Disk& disk) { return disk.radius; }
inline double radius_of(const shapes::Quad& quad) {
    const Vec3d a = quad.edge_u + quad.edge_v, b = quad.edge_u - quad.edge_v;
    return 0.5 * std::sqrt(std::max(dot(a, a), dot(b, b)));
}
inline double radius_of(const Figure& figure) {
    return std::visit([](const auto& f) { return radius_of(f); }, figure);
}

/// Returns its area over pi, m^2.
inline double disk_area(const shapes::Disk& disk) { return sqr(disk.radius); }
inline double disk_area(const shapes::Quad& quad) {
    const Vec3d n = cross(quad.edge_u, quad.edge_v);
    return std::sqrt(dot(n, n)) / pi;
}
inline double disk_area(const Figure& figure) {
    return std::visit([](const auto& f) { return disk_area(f); }, figure);
}

/// Returns the corners of a parallelogram that contains it, in order.
inline std::array<Vec3d, 4> corners_about(const shapes::Disk& disk) {
    const Frame<double> frame = frame_about(disk.normal);
    const Vec3d side = disk.radius * frame.t, top = disk.center + disk.radius * frame.b,
                bottom = disk.center - disk.radius * frame.b;
    return {top - side, top + side, bottom + side, bottom - side};
}
/// Returns the corners in their order about the normal.
inline std::array<Vec3d, 4> corners_about(const shapes::Quad& quad) {
    return {quad.corner, quad.corner + quad.edge_u, quad.corner + quad.edge_u + quad.edge_v, quad.corner + quad.edge_v};
}
inline std::array<Vec3d, 4> corners_about(const Figure& figure) {
    return std::visit([](const auto& f) { return corners_about(f); }, figure);
}

/// Returns a disk of the same directions from x, `factor` times as far away.
inline shapes::Disk moved(const shapes::Disk& disk, Vec3d x, double factor) {
    return {x + factor * (disk.center - x), disk.normal, factor * disk.radius};
}
/// Returns the figure seen from x, lengths over `factor`.
inline shapes::Quad moved(const shapes::Quad& quad, Vec3d x, double factor) {
    return {x + factor * (quad.corner - x), factor * quad.edge_u, factor * quad.edge_v};
}
inline Figure moved(const Figure& figure, Vec3d x, double factor) {
    return std::visit([&](const auto& f) -> Figure { return moved(f, x, factor); }, figure);
}

/// Returns the figure as a body that hides others.
inline Bodies::Any body_of(const Figure& figure) {
    return std::visit([](const auto& f) -> Bodies::Any { return f; }, figure);
}

/// Two points of a figure's edge.
struct Line {
    Vec3d from, to;
};
/// Returns the segment in which the plane of normal k through the origin cuts a figure whose middle or corner is at
/// `point` from there.
std::optional<Line> cut(const shapes::Disk& disk, Vec3d point, Vec3d k);
std::optional<Line> cut(const shapes::Quad& quad, Vec3d point, Vec3d k);

struct SceneData {
    Image image;
    Camera camera;
    std::vector<Shape> shapes;
    std::vector<MeshObject> meshes;
    std::vector<DiskLight> disks;  // lights too, before the others
    std::vector<Light> lights;
    std::optional<SkyLight> sky;
    Rgb fill{};  // uniform over the hemisphere
    std::string
        s_of;  // the surface whose exponent is the scene's; empty: the first with a lobe, else the first with an s

    /// Shapes and meshes are surfaces: their index counts the shapes, then the meshes.
    std::size_t surface_count() const { return shapes.size() + meshes.size(); }
    const std::string& surface_name(std::size_t surface) const;
    const Material& material(std::size_t surface) const;
    Material& material(std::size_t surface);
    /// Returns the index of the surface of this name.
    std::optional<std::size_t> find_surface(std::string_view name) const;
    std::vector<std::string> surface_names() const;

    /// Returns the scene's own s, used by samplers on surfaces without a lobe: that of surface_of_s(); 0 if there is
    /// none.
    double s() const;
    /// Returns the surface whose exponent that is; empty if no surface has an exponent of its own.
    std::optional<std::size_t> surface_of_s() const;
    const Shape* find_shape(std::string_view name) const;
};

}  // namespace crescent
