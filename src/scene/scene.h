// Shapes, lights and camera: what pixel (i, j) sees, and what hides a light.
// Double precision; lengths in m. Lights are seen by sampled rays only, never by the camera.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "math/simd/frame.h"
#include "scene/scene_data.h"

namespace crescent::inline scene {

/// What a primary ray met. The normal is unit and faces the camera.
struct Hit {
    int shape = -1;       // index into SceneData::shapes
    bool reveal = false;  // the side of a recessed panel
    Vec3d x{}, n{};
    Vec3d wo{};  // towards the camera, unit
};

/// What the camera sees of an experiment's shapes, and what lights them. Copies share the data; const members may be
/// called from any thread.
class Scene {
public:
    /// An experiment is such data too.
    explicit Scene(SceneData data);

    /// The ray through the centre of pixel (i, j), counted from the bottom-left.
    std::optional<Hit> primary(int i, int j) const;
    /// Traces every pixel once and remembers what it meets, for as long as the scene and its copies live: the whole hit
    /// where the image has at most whole_hits pixels, else the shape, 4 bytes a pixel, which primary() then asks alone.
    void remember_primaries();
    /// 84 MB. A hit that is computed again costs as much as ten samples of a pixel, a sixth of a film of 64.
    static constexpr std::size_t whole_hits = std::size_t{1} << 20;
    /// The same view with another exponent, on the shape whose s is the scene's and on all that inherit it. All but the
    /// exponent is shared.
    Scene with_s(double s) const;
    Surface surface(const Hit& hit) const;
    /// What is the same all over a shape, panel's reveal apart, whose lobe's parameters are the shape's too.
    Surface surface_of_shape(std::size_t shape) const;

    /// The scene's own exponent, or the other one that with_s() was given.
    double s() const { return s_; }
    /// Near what the camera sees: points are given from here where single precision has to hold them, so that a scene
    /// may stand anywhere. The nearest of some primary hits; the eye where these see nothing.
    Vec3d origin() const { return made_->origin; }
    const Image& image() const { return made_->data.image; }
    const Camera& camera() const { return made_->data.camera; }
    const std::vector<Shape>& shapes() const { return made_->data.shapes; }
    const std::vector<Occluder>& occluders() const { return made_->occluders; }
    /// Disks first, else in the order in which they are given.
    const std::vector<Light>& lights() const { return made_->lights; }
    std::size_t disk_count() const { return made_->disk_count; }
    const Rgb& fill() const { return made_->data.fill; }
    /// Made from one Scene by copies and with_s(), with the same exponent: all they say is the same.
    bool is_same_as(const Scene& other) const { return made_ == other.made_ && s_ == other.s_; }

private:
    /// What all exponents share.
    struct Made {
        SceneData data;
        Vec3d forward{}, right{}, up{};  // right and up scaled to one pixel
        Vec3d origin{};
        std::vector<Occluder> occluders;
        std::vector<Light> lights;
        std::size_t disk_count = 0;
        std::ptrdiff_t s_shape = -1;  // whose exponent is the scene's; -1: none has one

        explicit Made(SceneData from);
        Vec3d towards(int i, int j) const;  // pixel (i, j) from the eye, unit
        std::optional<Hit> trace(int i, int j) const;
        Hit hit(int shape, Vec3d d, const Intersection& met) const;
        Vec3d nearest_seen() const;
    };
    std::shared_ptr<const Made> made_;
    double s_ = 0;
    bool other_s_ = false;                                     // s_ is not what the data says
    std::shared_ptr<const std::vector<Hit>> hits_;             // a pixel's hit; shape -1: nothing met
    std::shared_ptr<const std::vector<std::int32_t>> shapes_;  // the same of a larger image
};

}  // namespace crescent::inline scene
