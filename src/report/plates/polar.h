// A half-circle polar plot: an angle from -90 to 90 deg from n, a radius from 0 to the round number above `peak`, in
// 1/sr.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "experiment/experiment.h"
#include "report/plates/sheet.h"
#include "samplers/external_sampler.h"

namespace crescent::plates {

/// A curve of r over the polar angle.
struct PolarCurve {
    bool filled = false;
    Colour ink;
    std::string name;
    std::function<double(double)> value;  // of the angle in radians
};
struct PolarPlot {
    Rect slot;
    double legend_w = 0;  // at the right of the slot
    double peak = 1;      // the largest value; the outer circle is the next round one
    double tilt = 0;      // of R, radians
    std::vector<PolarCurve> curves;
};
/// Densities in the plane of n and R, as polar curves.
void draw_polar(Canvas& canvas, const PolarPlot& plot);

// ---- An arm's own pdf in 1/sr over the hemisphere of n = +z, for a wo whose mirror direction R is tilted from n in
// the xz plane. It is the arm of arms/all.h that answers, or a sampler from outside; nothing is restated here.

/// The pdf of a sampler at one surface point of an experiment, for the plates. Directions in the local frame, n = +z.
class Density {
public:
    /// `tilt`: radians from n to R. An arm that aims at lights alone is asked at a pixel, which sees a light and has R
    /// as near to that as there is one. A sampler that is not in the list, or that has no one density, has density 0.
    Density(const Experiment& e, const std::string& sampler, double s, double tilt);
    /// Of a sampler from outside, which has to live as long; 0 where it cannot be asked, and where it gives none.
    Density(const Experiment& e, const ExternalSampler& outside, double s, double tilt);
    double at(const Vec3d& wi) const { return at(std::span(&wi, 1))[0]; }
    /// Of many directions, asked in one call.
    std::vector<double> at(std::span<const Vec3d> wi) const;
    /// In the plane of incidence, `angle` radians from n towards R.
    double in_plane(double angle) const;
    /// The largest in that plane, or at what a pixel's arm draws.
    double peak() const { return peak_; }
    /// Radians from n to R.
    double tilt() const { return tilt_; }
    /// "pixel (12, 34)" where an arm that aims at lights was asked; else "".
    const std::string& where() const { return where_; }

private:
    void query_at_a_pixel(const Experiment& e, const std::string& sampler, double s);
    void find_peak();
    std::function<void(std::span<const Vec3d>, std::span<double>)> ask_;
    double tilt_, peak_ = 0;
    std::string where_;
};

}  // namespace crescent::plates
