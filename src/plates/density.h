// An arm's own pdf in 1/sr over the hemisphere of n = +z, for a wo whose mirror direction R is tilted from n in the
// xz plane. It is the arm of arms/all.h that answers, or a sampler from outside; nothing is restated here.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "arms/outside.h"
#include "base/vec.h"
#include "experiment/experiment.h"

namespace crescent::plates {

/// The pdf of a sampler at one surface point of an experiment, for the plates. Directions in the local frame, n = +z.
class Density {
public:
    /// `tilt`: radians from n to R. An arm that aims at lights alone is asked at a pixel, which sees a light and has R
    /// as near to that as there is one. A sampler that is not in the list, or that has no one density, has density 0.
    Density(const Experiment& e, const std::string& sampler, double s, double tilt);
    /// Of a sampler from outside, which has to live as long; 0 where it cannot be asked, and where it gives none.
    Density(const Experiment& e, const OutsideSampler& outside, double s, double tilt);
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
    void ask_at_a_pixel(const Experiment& e, const std::string& sampler, double s);
    void find_peak();
    std::function<void(std::span<const Vec3d>, std::span<double>)> ask_;
    double tilt_, peak_ = 0;
    std::string where_;
};

}  // namespace crescent::plates
