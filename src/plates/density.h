// An arm's own pdf in 1/sr over the hemisphere of n = +z, for a wo whose mirror direction R is tilted from n in the
// xz plane. It is the arm of arms/all.h that answers; nothing is restated here.
#pragma once

#include <functional>
#include <string>

#include "base/vec.h"
#include "experiment/experiment.h"

namespace crescent::plates {

/// The pdf of a sampler at one surface point of an experiment, for the plates. Directions in the local frame, n = +z.
class Density {
public:
    /// `tilt`: radians from n to R. A sampler that is not in the list, or that needs a light, has density 0.
    Density(const Experiment& e, const std::string& sampler, double s, double tilt);
    double at(const Vec3d& wi) const { return pdf_(wi); }
    /// In the plane of incidence, `angle` radians from n towards R.
    double in_plane(double angle) const;

private:
    std::function<double(const Vec3d&)> pdf_;
};

}  // namespace crescent::plates
