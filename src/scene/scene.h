// Shapes, lights and camera: what pixel (i, j) sees, and what hides a light. Double precision; lengths in m. Lights are
// visible to sampled rays only, never to the camera.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "math/simd/frame.h"
#include "scene/scene_data.h"
#include "scene/surroundings.h"

namespace crescent {

/// The hit of a primary ray. The normal is unit and faces the camera.
struct Hit {
    int shape = -1;       // index of a surface: of SceneData::shapes, then of SceneData::meshes
    bool reveal = false;  // the side of a recessed panel
    Vec3d x{}, n{};
    Vec3d wo{};  // towards the camera, unit
    // Of a mesh only:
    Vec3d face{};  // normal of the triangle, unit, on the camera's side; n is the smooth normal on that side
    std::uint32_t instance = no_item, triangle = no_item;  // as in MeshHit
    double u = 0, v = 0;                                   // weights of the triangle's corners 1 and 2

    bool is_below = false;  // the camera is below the smooth surface: nothing is reflected, and n is the face
    /// Returns whether it is on a mesh.
    bool is_mesh() const { return instance != no_item; }
};

/// Factors of a material, from the textures of its mesh.
struct Texels {
    Rgb rho_d = {1, 1, 1};
    double alpha = 1;
    bool operator==(const Texels&) const = default;
};

/// What the camera sees of an experiment's shapes, and the lights. Copies share the data; const members may be called
/// from any thread.
class Scene {
public:
    /// An experiment is a SceneData too.
    explicit Scene(SceneData data);

    /// Traces the ray through the centre of pixel (i, j), counted from the bottom-left.
    std::optional<Hit> primary(int i, int j) const;
    /// Returns whether the camera sees a surface in pixel (i, j).
    bool sees_surface(int i, int j) const;
    /// Returns the radiance of the sky in the direction of pixel (i, j), as the camera sees it where no surface is; 0
    /// without a visible sky.
    Rgb background(int i, int j) const;
    /// Returns whether there is a sky that the camera sees.
    bool has_background() const { return content_->data.sky && content_->data.sky->visible; }
    /// Traces every pixel once and stores the hits for as long as the scene and its copies live: whole hits if the
    /// image has at most whole_hits pixels, else only the shape, 4 bytes per pixel, which primary() then tests alone.
    void remember_primaries();
    /// Stores only the shapes from now on. Copies made before keep what they have.
    void forget_hits();
    /// 84 MB. Computing a hit again costs as much as ten samples of a pixel, a sixth of a film of 64.
    static constexpr std::size_t whole_hits = std::size_t{1} << 20;
    /// Returns the same view with another exponent, for the shape whose s is the scene's and all that inherit it.
    /// Everything except the exponent is shared.
    Scene with_s(double s) const;
    Surface surface(const Hit& hit) const;
    /// Returns what the textures multiply the material of a hit by.
    Texels texels(const Hit& hit) const;
    /// Returns whether a mesh has a texture of alpha.
    bool has_alpha_textures() const;
    /// Returns where rays from a hit begin, relative to origin(): on a mesh a little above its triangle, so that the
    /// triangle does not shadow itself (Rays::offset).
    Vec3d ray_start(const Hit& hit) const;
    /// Returns the properties that are constant over a shape, without its textures. The sides of a panel share only the
    /// lobe's parameters.
    Surface surface_of_shape(std::size_t shape) const;

    /// Returns the scene's own exponent, or the one given to with_s().
    double s() const { return s_; }
    /// Returns a point near what the camera sees; positions in single precision are relative to it, so that a scene may
    /// be anywhere. It is the nearest of some primary hits, or the eye if these see nothing.
    Vec3d origin() const { return content_->origin; }
    const Image& image() const { return content_->data.image; }
    const Camera& camera() const { return content_->data.camera; }
    const std::vector<Shape>& shapes() const { return content_->data.shapes; }
    const std::vector<MeshObject>& meshes() const { return content_->data.meshes; }
    /// Returns the rays against all instances of the meshes; positions are relative to origin().
    const Rays& rays() const { return content_->rays; }
    bool has_meshes() const { return !content_->rays.empty(); }
    /// Returns the triangles that emit, in the order of instances and triangles, the back of two-sided ones as
    /// triangles of their own.
    const std::vector<TriangleLight>& triangle_lights() const { return content_->triangle_lights; }
    const std::vector<Occluder>& occluders() const { return content_->occluders; }
    /// Returns the lights: disks first, else in the order in which they are given.
    const std::vector<Light>& lights() const { return content_->lights; }
    std::size_t disk_count() const { return content_->disk_count; }
    const Rgb& fill() const { return content_->data.fill; }
    /// Returns the sky; null if the scene has none.
    const std::shared_ptr<const Surroundings>& surroundings() const { return content_->surroundings; }
    /// Returns whether both come from one Scene by copies and with_s(), with the same exponent, so all their values are
    /// equal.
    bool is_same_as(const Scene& other) const { return content_ == other.content_ && s_ == other.s_; }

private:
    std::size_t index_of(int i, int j) const;
    /// Shared by all exponents.
    struct Made {
        SceneData data;
        Vec3d forward{}, right{}, up{};  // right and up scaled to one pixel
        Vec3d origin{};
        std::vector<Occluder> occluders;
        std::vector<Light> lights;
        std::size_t disk_count = 0;
        Rays rays;
        std::vector<TriangleLight> triangle_lights;
        std::shared_ptr<const Surroundings> surroundings;  // null: nothing but bodies and lights
        std::ptrdiff_t s_shape = -1;                       // the surface whose exponent is the scene's; -1: none

        explicit Made(SceneData from);
        std::shared_ptr<const Surroundings> make_surroundings() const;
        Vec3d towards(int i, int j) const;  // direction from the eye to pixel (i, j), unit
        std::optional<Hit> trace(int i, int j) const;
        Hit hit(int shape, Vec3d d, const Intersection& crossing) const;
        Hit hit(const MeshHit& mesh_hit, Vec3d d) const;
        std::array<Vec3d, 3> corners(std::uint32_t instance, std::uint32_t triangle) const;
        std::vector<MeshInstance> instances() const;
        Vec3d nearest_seen() const;
    };
    std::shared_ptr<const Made> content_;
    double s_ = 0;
    bool other_s_ = false;                                     // s_ differs from the data
    std::shared_ptr<const std::vector<Hit>> hits_;             // hit for each pixel; shape -1: no hit
    std::shared_ptr<const std::vector<std::int32_t>> shapes_;  // the shapes only, for a larger image
};

}  // namespace crescent
