// A camera that sees a whole model, whatever its shape: one that is thin along two axes is seen from near one of its
// ends, so that its length is foreshortened, and a flat one from its face.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/mesh/mesh.h"
#include "scene/scene_data.h"

namespace crescent {

/// The points of a model, of which the view of it depends on the box and on the principal axes.
class ModelPoints {
public:
    ModelPoints() = default;
    explicit ModelPoints(const Bounds& box) { add(box); }
    explicit ModelPoints(const Mesh& mesh) { add(mesh); }

    void add(Vec3d point);
    /// The corners of a box.
    void add(const Bounds& box);
    /// The corners of its triangles.
    void add(const Mesh& mesh);
    const std::vector<Vec3f>& points() const { return points_; }
    /// Around all points.
    const Bounds& box() const { return box_; }

    /// The principal axes, the longest extent first, with the ends of all points along them.
    struct Axes {
        Vec3d axis[3];
        double low[3], high[3];
        double extent(std::size_t k) const { return high[k] - low[k]; }
    };
    Axes axes() const;
    /// Whether a triangle may be seen in an image of this aspect. False only if none is: all points are behind the
    /// camera, or beyond one side of the image.
    bool may_be_seen(const Camera& camera, double aspect) const;

private:
    Bounds box_;
    std::vector<Vec3f> points_;
};

/// Returns the table [camera] of a view in which the whole model is seen, from above and the side. It fills an image of
/// this width over height in one direction, but for a margin of 5 %, and is in the middle in the other one; in a wider
/// image it is seen whole too.
std::string camera_table(const ModelPoints& points, double aspect = 1);

/// A point with six digits of `detail`, a length: far from the origin, more digits than six.
std::string point_in_table(Vec3d v, double detail);

}  // namespace crescent
