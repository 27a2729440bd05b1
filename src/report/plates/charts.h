// Charts on plates. Polar: a half-circle, an angle from -90 to 90 deg from n, a radius from 0 to the round number above
// `peak`, in 1/sr.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "experiment/experiment.h"
#include "report/plates/sheet.h"
#include "samplers/sampler_adapter.h"

namespace crescent::plates {

/// The scale of a density: linear from 0 to `top`, or logarithmic over decades below it.
struct DensityScale {
    double top = 1;   // 1/sr
    int decades = 0;  // 0: linear
    /// Returns the place of a density between 0 and 1.
    double share(double p) const;
};

/// A curve of r over the polar angle.
struct PolarCurve {
    bool filled = false;
    Colour ink;
    std::string name;
    std::function<double(double)> value;  // by the angle in radians
};
struct PolarPlot {
    Rect slot;
    double legend_w = 0;  // at the right of the slot
    DensityScale scale;   // its top is the largest value; the outer circle is the next round one
    double tilt = 0;      // of R, radians
    std::vector<PolarCurve> curves;
};
/// Draws densities in the plane of n and R as polar curves.
void draw_polar(Canvas& canvas, const PolarPlot& plot);

// ---- A sampler's own pdf in 1/sr over the hemisphere of n = +z, for a wo whose mirror direction R is tilted from n in
// the xz plane; it is evaluated by the sampler of samplers/all.h or by an external sampler.

/// Returns the surface whose material the densities have, without its textures: that of the experiment's exponent, else
/// the first with a lobe; none: a surface without a lobe.
std::optional<std::size_t> surface_of_densities(const Experiment& e);

/// The pdf of a sampler at one surface point of an experiment, for the plates. Directions in the local frame, n = +z.
class Density {
public:
    /// `tilt`: radians from n to R. A sampler that aims only at lights is evaluated at a pixel that sees a light and
    /// whose R is as near to the tilt as possible. A sampler that is not in the list, or that has no single density,
    /// has density 0.
    Density(const Experiment& e, const std::string& sampler, double s, double tilt);
    /// The density of an external sampler, which must outlive this object; 0 if it cannot be evaluated or returns none.
    Density(const Experiment& e, const SamplerAdapter& external, double s, double tilt);
    double at(const Vec3d& wi) const { return at(std::span(&wi, 1))[0]; }
    /// Returns the densities of many directions in one call.
    std::vector<double> at(std::span<const Vec3d> wi) const;
    /// Returns the density in the plane of incidence, `angle` radians from n towards R.
    double in_plane(double angle) const;
    /// Returns the largest density in that plane, or at the draws for a pixel.
    double peak() const { return peak_; }
    /// Returns its scale with the peak as its top: logarithmic if most directions have a density, and most of those
    /// less than a hundredth of the peak, as under a sky with a sun. The lobe of a surface is linear: its width is its
    /// shape.
    DensityScale scale() const;
    /// Returns the radians from n to R.
    double tilt() const { return tilt_; }
    /// Returns "pixel (12, 34)" for a sampler that aims at lights; else "".
    const std::string& where() const { return where_; }

private:
    void query_at_a_pixel(const Experiment& e, const std::string& sampler, double s);
    void find_peak();
    std::function<void(std::span<const Vec3d>, std::span<double>)> ask_;
    double tilt_, peak_ = 0;
    std::string where_;
};

// ---- A quantity of one region against N, both logarithmic, one curve per arm with its fitted slope.

/// The curve of an arm.
struct LadderCurve {
    std::string name;
    Colour ink;
    std::vector<double> n, value;
    std::vector<std::pair<double, double>> interval;  // for each value; empty: none is drawn; NaN: none for this one
    double slope = 0, low = 0, high = 0;              // of log value over log N, and its interval; NaN: none
    bool heavy = false;                               // the tail is too heavy for a meaningful slope
};

/// `title` is markup. Nothing is drawn without curves.
void draw_ladder_chart(
    Canvas& canvas, const Rect& slot, const std::string& title, const std::vector<LadderCurve>& curves);

/// Returns the RMSE of a region of a run against N, one curve for each arm that the plate shows.
std::vector<LadderCurve> ladder_curves(const Sheet& sheet, const std::string& region);

}  // namespace crescent::plates
