// The GL back end: computes the same films as the CPU, in GLSL.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pass.h"
#include "point_texture.h"
#include "program.h"

namespace crescent::gl {

// ---- Computes films on a GL context: src/render/ with src/gl/shaders/estimator.glsl as its kernel. Moments of a draw
// are returned as floats and summed in double.

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

class GlBackend : public Backend {
public:
    /// Makes the context current on this thread.
    explicit GlBackend(std::unique_ptr<Context> context);

    std::string name() const override;
    std::vector<std::pair<std::string, std::string>> details() const override;
    void check(const Experiment& experiment) const override;
    std::vector<Film> films(const TiledScene& view, const Job& job, ProgressMonitor& monitor) override;
    std::vector<AssertionResult> assertions() const override { return claims_; }

    Context& context() { return *context_; }
    const Estimator& estimator() const { return estimator_; }

private:
    void claim_framebuffer(const std::string& what, int width, int height, std::size_t attachments);

    std::unique_ptr<Context> context_;
    Estimator estimator_;
    std::vector<AssertionResult> claims_;
    bool claimed_film_ = false;
};

// ---- The random integers as the driver computes them.

/// The input of a set of hashes: pixels 0 to width x height - 1, one pair of samples, one block of dimensions, one
/// seed.
struct IntegerBlock {
    int width = 0, height = 0;
    std::uint32_t pair = 0, block = 0, seed = 0;
};

/// Returns four integers per pixel, by src/gl/shaders/integers.glsl, for each block.
std::vector<std::vector<std::uint32_t>> driver_integers(
    const Context& context, const std::vector<IntegerBlock>& blocks);
/// Returns how many of them differ from draws() of src/math/simd/random.h.
std::uint64_t unlike_integers(const IntegerBlock& block, const std::vector<std::uint32_t>& integers);

}  // namespace crescent::gl
