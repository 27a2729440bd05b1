// The drawing of the upper hemisphere of a surface point: an orthographic view from `elevation_deg` degrees above the
// surface, rotated so that a given direction points to the right. Seen from directly above, area on the disc is the
// share of the light that a Lambert surface receives (Nusselt). Directions local, n = +z; lengths in units of the
// sheet.
#pragma once

#include <functional>
#include <vector>

#include "frame.h"

namespace crescent::explainer {

class Hemisphere {
public:
    /// `centre`: of the base; `right`: a direction whose horizontal part points to the right.
    Hemisphere(Point centre, double radius, double elevation_deg, Vec3d right);

    Point at(Vec3d w, double reach = 1) const;
    /// On the rim, counted in turns from the right, counter-clockwise.
    Point rim(double turns) const;
    /// Returns whether w is on the side of the sphere that faces the viewer.
    bool visible(Vec3d w) const;
    double radius() const { return radius_; }
    Point centre() const { return centre_; }

    /// Returns a picture of the hemisphere coloured by direction, its corner at corner(); the ground elsewhere.
    Block field(const std::function<Srgb8(Vec3d)>& colour) const;
    Point corner() const;

    /// Rings and meridians every 30 degrees, the rim and the outline.
    void grid(Frame& f, double alpha = 1) const;
    /// The visible parts of a path.
    void trace(Frame& f, const std::vector<Vec3d>& path, Colour ink, double line, double alpha = 1) const;
    /// Draws an arrow from the surface point through w, to `reach` radii, with words above its tip.
    void arrow(Frame& f, Vec3d w, double reach, const Words& words, Colour ink, double alpha = 1) const;

private:
    Vec3d turned(Vec3d w) const;    // local -> drawing frame
    Vec3d unturned(Vec3d w) const;  // and back
    Point centre_;
    double radius_, sin_elevation_, cos_elevation_;  // sine and cosine of the elevation
    double cos_ = 1, sin_ = 0;                       // of the turn about n
};

/// Returns the unit direction at angles in degrees from n and about it from the local x axis.
Vec3d direction(double theta_deg, double phi_deg);

}  // namespace crescent::explainer
