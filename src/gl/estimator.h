// Computes films on a GL context: src/render/ with src/gl/shaders/estimator.glsl as its kernel. Moments of a draw are
// returned as floats and summed in double.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framebuffer.h"
#include "pass.h"
#include "program.h"
#include "point_texture.h"

namespace crescent::gl {

class Estimator {
public:
    /// `largest_texture`: pixels along a side of a rectangle; 0: the driver's limit.
    explicit Estimator(const Context& context, int largest_texture = 0);

    /// Returns one film per sample count of n (ascending), as estimate_films() does.
    std::vector<Film> films(const Scene& scene, const std::string& sampler, const std::vector<std::uint64_t>& n,
        std::uint32_t seed, ProgressMonitor& monitor);
    /// Returns the longest duration of a draw so far.
    double longest_draw_s() const;
    int largest_texture() const { return largest_texture_; }

private:
    /// A program for one sampler on one lobe, and its speed so far.
    struct Kernel {
        Program program;
        Pacer pacer;
        Kernel(const Context& context, const ShaderSource& source) : program(context, source) {}
    };

    Kernel& kernel(const std::string& sampler, int lobe, const LightCounts& lights, const Bodies& bodies);
    const PointTexture& shading_points(const Scene& scene, const TileBox& box, ProgressMonitor& monitor);
    const Framebuffer& framebuffer(int width, int height, std::size_t attachments);
    void estimate(const Scene& scene, const TileBox& box, const std::string& sampler, std::uint32_t seed,
        std::vector<Film>& films, ProgressMonitor& monitor);

    const Context& context_;
    GLuint vertex_array_ = 0;
    int largest_texture_ = 0;
    std::map<std::string, std::unique_ptr<Kernel>> kernels_;  // by source text
    std::optional<Framebuffer> framebuffer_;
    std::optional<PointTexture> shading_points_;  // of the last rectangle
    std::optional<Scene> points_of_;              // and of this scene
};

/// Returns the fragment shader of one sampler on one lobe, its index in the list or -1.
ShaderSource estimator_source(
    const std::string& sampler, int lobe, const LightCounts& lights, const std::array<std::size_t, 5>& bodies);

}  // namespace crescent::gl
