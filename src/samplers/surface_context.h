// What a sampler that is not built in receives of a surface point: its parameters, and the lights as it sees them, in
// the local frame, n = +z.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace crescent {

/// The data of the surface point for a sampler, in addition to wo. Files and C use the same layout.
struct SurfaceParameters {
    double s;        // Phong exponent
    double alpha;    // GGX roughness
    double diffuse;  // Y(rho_d)
    double lobe;     // rho_s
};

/// A light of the scene, the same for every surface point.
struct SceneLight {
    std::string_view kind;  // its name in LightKinds
    Rgb radiance;           // W/(sr m^2)
    double radius;  // m; of a light that is neither disk nor sphere: of a ball about its centre that contains it
};

/// A light as one surface point sees it, in the local frame of the point, m.
struct LightAtPoint {
    Vec3<double> center;
    Vec3<double> normal;          // unit; 0 where the light has none
    Vec3<double> edge_u, edge_v;  // from the centre to the middle of an edge; 0 where it has no edges
    bool shines;                  // false: the point is on its dark side, in its plane or in it. Occlusion is ignored
};

/// Rows that follow one another at one surface point.
struct SurfaceRun {
    Vec3<double> wo;
    SurfaceParameters surface;
    std::size_t rows;
    Rgb rho_d{};  // by channel
};

/// The surface points of a batch of rows, in their order.
struct SceneRows {
    std::span<const SurfaceRun> runs;
    std::span<const SceneLight> lights{};       // empty if the sampler does not use them
    std::span<const LightAtPoint> lights_at{};  // [run][light]

    /// The lights as the points of a run see them.
    std::span<const LightAtPoint> lights_of_run(std::size_t run) const {
        return lights_at.subspan(run * lights.size(), lights.size());
    }
};

// ---- The description of the surface point for a program behind a pipe: columns after w_o and u, or after w_o and
// w_i. docs/samplers.md has their order and units.

/// The quantities that a handshake may name in `uses`: "s, alpha, rho_d, rho_s, side, eta, lights".
std::span<const std::string_view> context_names();

/// Number of columns of one row for a scene with this many lights.
std::size_t context_columns(std::span<const std::string> uses, std::size_t lights);

/// Appends the columns of one surface point, in the order of `uses`. `lights_at`: each light relative to the point.
void add_context(std::span<const std::string> uses, const SurfaceRun& point, std::span<const SceneLight> lights,
    std::span<const LightAtPoint> lights_at, std::vector<double>& to);

/// Reads names of context_names() separated by commas, each at most once; returns false for any other text.
bool take_context_names(std::string_view text, std::vector<std::string>& out);

/// The light of a check.
struct ExampleLight {
    SceneLight light;
    LightAtPoint at;
};
ExampleLight example_light();

/// The columns of the surface on which `crescent check` tests a sampler: the default of a plugin, below one disk light.
std::vector<double> example_context(std::span<const std::string> uses);

}  // namespace crescent
