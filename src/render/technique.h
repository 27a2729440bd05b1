// A sampler as a part of a combination: it draws and evaluates its density at shading points, in any language.
// Directions are float, as in the estimator; densities in 1/sr.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "render/shading_points.h"
#include "samplers/sampler.h"
#include "samplers/sampler_adapter.h"
#include "samplers/weight_formula.h"

namespace crescent {

/// Rows that follow one another at one shading point.
struct PointRun {
    std::size_t point;
    Vec3<float> wo;
    std::size_t rows;
};

/// A batch of rows at some of the shading points.
struct PointRows {
    const ShadingPoints& points;
    std::span<const PointRun> runs;
    std::size_t count() const;
};

/// A drawn direction. pdf 0: nothing was drawn; NaN: the sampler returned no usable pdf or direction.
struct PointDraw {
    Vec3<float> wi{0, 0, 1};
    double pdf = 0;
    float light = -1;                                        // the light at which it was aimed, disks first
    bool meets_light = false;                                // it meets that light
    std::uint32_t texel = no_texel, triangle = no_triangle;  // of the sky and of emitting triangles, if drawn there
};

class Technique {
public:
    virtual ~Technique() = default;
    /// Returns the number of random numbers of a row, 1 to 8.
    virtual int numbers() const = 0;
    /// One draw a row; row i has u[i * numbers() ...], each in (0, 1). May be called by many threads.
    virtual void draw(const PointRows& rows, std::span<const double> u, std::span<PointDraw> out) const = 0;
    /// Whether it can evaluate its density.
    virtual bool has_density() const { return true; }
    /// Evaluates the density of each row's direction, 0 where it is never drawn.
    virtual void density(const PointRows& rows, std::span<const Vec3<float>> wi, std::span<double> out) const = 0;
    /// The index of the sampler in samplers/all.h; -1: another one.
    virtual int built_in() const { return -1; }
    /// Returns the device that evaluates it; of a mixture, that of the first part that has one.
    virtual EvaluationDevice device() const { return {}; }
};

using Techniques = std::vector<std::shared_ptr<const Technique>>;
/// Random numbers that suffice for a row of any of these; at least 2.
int most_numbers(const Techniques& parts);
/// Returns the device of the first part that has one.
EvaluationDevice device_of(const Techniques& parts);

/// A sampler of samplers/all.h with one direction a sample, in scalar code.
std::shared_ptr<const Technique> built_in_technique(std::string_view sampler);
std::shared_ptr<const Technique> external_technique(std::shared_ptr<const SamplerAdapter> sampler);
/// Writes the sampler's weights for each wi, [row][K], from the densities p, [row][K].
void external_weights(const SamplerAdapter& sampler, const PointRows& rows, std::span<const Vec3<float>> wi,
    std::span<const double> p, std::span<double> out);
/// p = sum_k weight_k p_k: u[0] chooses a part and is stretched back to (0, 1).
std::shared_ptr<const Technique> mixture_technique(Techniques parts, WeightList weights);

/// The chosen part of each row, and its u[0] stretched to (0, 1).
struct Choices {
    std::vector<std::size_t> part;
    std::vector<double> stretched;
};
/// `weights`: those of each run, [run][part].
Choices choose(const PointRows& rows, std::span<const double> u, std::size_t numbers, std::span<const double> weights,
    std::size_t parts);
/// Evaluates the weights at the point of each run, [run][part].
std::vector<double> weights_at(const PointRows& rows, const WeightList& weights);
/// The quantities of a formula at the point of a run.
FormulaInputs formula_inputs(const ShadingPoints& points, const PointRun& run);

/// Draws each row by its chosen part. p[part][row] receives the density of every part at the direction.
void draw_chosen(const Techniques& parts, const PointRows& rows, std::span<const double> u, std::size_t numbers,
    const Choices& choices, std::span<PointDraw> out, std::vector<std::vector<double>>& p);

// ---- What samplers from outside receive of shading points, and which of their draws are usable.

/// Every light, in the scene's order; empty where there is none or no point.
std::vector<SceneLight> lights_of(const ShadingPoints& shading_points);

/// Appends each of these lights as shading point `index` sees it.
void add_lights_at(const ShadingPoints& shading_points, std::size_t index, std::vector<LightAtPoint>& to);

/// Rows at shading point `index`.
SurfaceRun run_at(const ShadingPoints& shading_points, std::size_t index, Vec3<double> wo, std::size_t rows);

/// A draw is usable if its direction is of unit length to 1e-4 and its pdf is above 0 and finite also in single
/// precision, in which the estimate is computed. pdf 0, which means that nothing was drawn, is for the caller.
bool is_usable(const Vec3<double>& wi, double pdf);

}  // namespace crescent
