// Shapes, lights and camera: what pixel (i, j) sees, and what hides a light.
// Double precision; lengths in m. Lights are seen by sampled rays only, never by the camera.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "experiment/experiment.h"
#include "scene/frame.h"

namespace crescent {

/// What a primary ray met. The normal is unit and faces the camera.
struct Hit {
    int shape = -1;       // index into Experiment::shapes
    bool reveal = false;  // the side of a recessed panel
    Vec3d x{}, n{};
    Vec3d wo{};  // towards the camera, unit
};

/// A surface's BRDF with every default filled in.
struct Surface {
    Rgb rho_d{};
    double rho_s = 0;
    BrdfKind brdf = BrdfKind::phong;
    double s = 0, alpha = 0;
};

/// A material's surface in a scene whose common exponent is s. Where it states no alpha: sqrt(2/(s+2)), as wide as a
/// Blinn-Phong lobe of exponent s (Walter et al. 2007), so that a GGX arm has something to aim by on any surface.
Surface surface_of(const Material& material, double common_s);

/// A convex body that can stand between a surface and a light. Shapes that are not convex are made of several.
struct Occluder {
    enum class Kind { sphere, box, quad, disk, plane } kind = Kind::sphere;
    int shape = -1;       // its own surface is never shadowed by it
    Vec3d a{}, b{}, c{};  // sphere: centre; box: min, max; quad: corner, edges; disk, plane: centre, normal
    double radius = 0;
};

class Scene {
public:
    explicit Scene(const Experiment& experiment);

    /// The ray through the centre of pixel (i, j), counted from the bottom-left.
    std::optional<Hit> primary(int i, int j) const;
    /// Traces every pixel once and remembers it, for as long as the scene and its copies live; does nothing for images
    /// of more than 2^20 pixels, which are traced tile by tile whenever they are asked for.
    void remember_primaries();
    /// The same view with another exponent; what was remembered is shared.
    Scene with_s(double s) const;
    Surface surface(const Hit& hit) const;

    /// Near what the camera sees: points are given from here where single precision has to hold them, so that a scene
    /// may stand anywhere. The nearest of some primary hits; the eye where these see nothing.
    Vec3d origin() const { return origin_; }
    const std::vector<Occluder>& occluders() const { return occluders_; }
    const std::vector<DiskLight>& disks() const { return experiment_.disks; }
    const Rgb& fill() const { return experiment_.fill; }
    const Experiment& experiment() const { return experiment_; }

private:
    std::optional<Hit> trace(int i, int j) const;
    Vec3d nearest_seen() const;
    Experiment experiment_;             // a copy: a scene outlives the experiment it was made from
    Vec3d forward_{}, right_{}, up_{};  // right and up scaled to one pixel
    double s_ = 0;
    Vec3d origin_{};
    std::vector<Occluder> occluders_;
    std::shared_ptr<const std::vector<Hit>> primaries_;  // shape -1: nothing met
};

}  // namespace crescent
