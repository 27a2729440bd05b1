// The principal axes are those of the covariance of the points, by Jacobi's rotations.
#include "experiment/model_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "math/functions.h"
#include "math/simd/math.h"
#include "math/simd/scalar.h"

namespace crescent {

namespace {

constexpr double half_view = 20;            // degrees of the ball around a model, from the eye
constexpr double margin = 1.05;             // of the image around the model
constexpr double longest = 8;               // length over width of a model that is seen from its side
constexpr double foreshortened = 4;         // about half the length over width in the image of a longer one
constexpr double flat = 0.05;               // thickness over width, below which a model is seen from its face
constexpr double least_face_cosine = 0.34;  // of a face that is seen: 20 degrees from its edge
constexpr double least_axis_cosine = 0.3;   // of the long axis, before it is foreshortened

double norm(Vec3d v) { return std::sqrt(dot(v, v)); }

/// The direction with the cosine `cosine` to an axis that is nearest to d.
Vec3d tilted(Vec3d d, Vec3d axis, double cosine) {
    Vec3d perpendicular = d - dot(d, axis) * axis;
    if (norm(perpendicular) < 1e-6)
        perpendicular = cross(axis, std::fabs(axis.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
    const double sign = dot(d, axis) < 0 ? -1 : 1;
    return sign * cosine * axis + std::sqrt(1 - cosine * cosine) * normalize(perpendicular);
}

/// From the model towards the eye.
Vec3d direction_to_eye(const ModelPoints::Axes& axes) {
    Vec3d out = normalize(Vec3d{0.5, 0.4, 1});
    const bool is_flat = axes.extent(2) < flat * axes.extent(1);
    if (is_flat && std::fabs(dot(out, axes.axis[2])) < least_face_cosine)
        out = tilted(out, axes.axis[2], least_face_cosine);
    if (!(axes.extent(0) > longest * axes.extent(1))) return out;
    const Vec3d axis = axes.axis[0];
    if (std::fabs(dot(out, axis)) < least_axis_cosine) out = tilted(out, axis, least_axis_cosine);
    // 1e6: beyond it, the width is lost in the rounding of single precision along the length.
    const double ratio = std::min(axes.extent(0) / std::max(axes.extent(1), 1e-300), 1e6);
    return normalize(out + (ratio / foreshortened - 1) * dot(out, axis) * axis);
}

}  // namespace

bool ModelPoints::may_be_seen(const Camera& camera, double aspect) const {
    const Vec3d forward = normalize(camera.target - camera.eye), right = normalize(cross(forward, camera.up)),
                up = cross(right, forward);
    const double half_height = math::tan(camera.vfov_deg * pi / 360), half_width = half_height * aspect;
    // Inner normals of the sides of what is seen.
    const std::array<Vec3d, 5> sides = {forward, half_width * forward + right, half_width * forward - right,
        half_height * forward + up, half_height * forward - up};
    return std::ranges::all_of(sides, [&](const Vec3d& side) {
        return std::ranges::any_of(
            points_, [&](const Vec3f& point) { return dot(widen(point) - camera.eye, side) > 0; });
    });
}

std::string point_in_table(Vec3d v, double detail) {
    const double size = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    const int digits = size > detail && detail > 0 ? 6 + static_cast<int>(std::ceil(math::log10(size / detail))) : 6;
    return fmt::format("[{0:.{3}g}, {1:.{3}g}, {2:.{3}g}]", v.x, v.y, v.z, std::min(digits, 17));
}

void ModelPoints::add(Vec3d point) {
    const Vec3f p{static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)};
    box_.add(p);
    points_.push_back(p);
}

void ModelPoints::add(const Bounds& box) {
    for (unsigned corner = 0; corner < 8; ++corner)
        add(widen(Vec3f{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
            corner & 4 ? box.high.z : box.low.z}));
}

void ModelPoints::add(const Mesh& mesh) {
    box_.add(mesh.bounds());
    points_.insert(points_.end(), mesh.positions.begin(), mesh.positions.end());
}

ModelPoints::Axes ModelPoints::axes() const {
    const Vec3d middle = 0.5 * (widen(box_.low) + widen(box_.high));
    const auto coordinates = [](Vec3d v) { return std::array{v.x, v.y, v.z}; };
    Vec3d mean{};
    for (const Vec3f& p : points_) mean = mean + (widen(p) - middle);
    mean = (1 / static_cast<double>(std::max<std::size_t>(points_.size(), 1))) * mean;
    std::array<std::array<double, 3>, 3> m{}, v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (const Vec3f& p : points_) {
        const std::array d = coordinates(widen(p) - middle - mean);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) m[i][j] += d[i] * d[j];
    }
    constexpr int sweeps = 32;  // it converges quadratically, in fewer than ten
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
            if (std::fabs(m[i][j]) <= 1e-14 * std::sqrt(std::fabs(m[i][i] * m[j][j]))) continue;
            const double theta = (m[j][j] - m[i][i]) / (2 * m[i][j]);
            const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
            const double c = 1 / std::sqrt(t * t + 1), s = t * c;
            for (std::size_t k = 0; k < 3; ++k) {
                const double a = m[k][i], b = m[k][j];
                m[k][i] = c * a - s * b;
                m[k][j] = s * a + c * b;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const double a = m[i][k], b = m[j][k];
                m[i][k] = c * a - s * b;
                m[j][k] = s * a + c * b;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const double a = v[k][i], b = v[k][j];
                v[k][i] = c * a - s * b;
                v[k][j] = s * a + c * b;
            }
        }
    Axes out{};
    for (std::size_t k = 0; k < 3; ++k) {
        out.axis[k] = normalize(Vec3d{v[0][k], v[1][k], v[2][k]});
        out.low[k] = points_.empty() ? 0 : INFINITY;
        out.high[k] = points_.empty() ? 0 : -INFINITY;
        for (const Vec3f& p : points_) {
            const double position = dot(widen(p) - middle, out.axis[k]);
            out.low[k] = std::min(out.low[k], position);
            out.high[k] = std::max(out.high[k], position);
        }
        const double offset = dot(middle, out.axis[k]);
        out.low[k] += offset;
        out.high[k] += offset;
    }
    std::array<std::size_t, 3> order = {0, 1, 2};
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return out.extent(a) > out.extent(b); });
    const Axes unsorted = out;
    for (std::size_t k = 0; k < 3; ++k) {
        out.axis[k] = unsorted.axis[order[k]];
        out.low[k] = unsorted.low[order[k]];
        out.high[k] = unsorted.high[order[k]];
    }
    return out;
}

namespace {

/// The least tangent t with |x - m| <= t depth for all points at one m: the largest (x_i - x_j) / (depth_i + depth_j),
/// by Dinkelbach's iteration (1967), whose steps grow and end.
class Fit {
public:
    Fit(std::vector<double> offsets, const std::vector<double>& depths)
        : offsets_(std::move(offsets)), depths_(depths) {
        constexpr int most_steps = 64;
        for (int step = 0; step < most_steps; ++step) {
            const auto [i, j] = ends(tangent_);
            const double estimate = (offsets_[i] - offsets_[j]) / (depths_[i] + depths_[j]);
            if (!(estimate > tangent_)) break;
            tangent_ = estimate;
        }
    }
    double tangent() const { return tangent_; }
    double middle() const {
        const auto [i, j] = ends(tangent_);
        return 0.5 * (offsets_[i] - tangent_ * depths_[i] + offsets_[j] + tangent_ * depths_[j]);
    }

private:
    /// The points that bound m from below and above.
    std::pair<std::size_t, std::size_t> ends(double tangent) const {
        std::pair<std::size_t, std::size_t> out{0, 0};
        for (std::size_t k = 0; k < offsets_.size(); ++k) {
            const double reach = tangent * depths_[k];
            if (offsets_[k] - reach > offsets_[out.first] - tangent * depths_[out.first]) out.first = k;
            if (offsets_[k] + reach < offsets_[out.second] + tangent * depths_[out.second]) out.second = k;
        }
        return out;
    }

    std::vector<double> offsets_;
    const std::vector<double>& depths_;
    double tangent_ = 0;
};

}  // namespace

std::string camera_table(const ModelPoints& points, double aspect) {
    const ModelPoints::Axes axes = points.axes();
    const Bounds& box = points.box();
    const double radius = 0.5 * norm(widen(box.high) - widen(box.low));
    const double distance = radius / math::sin(half_view * pi / 180);
    const Vec3d eye_direction = direction_to_eye(axes), middle = 0.5 * (widen(box.low) + widen(box.high));
    const bool is_from_above = std::fabs(eye_direction.y) > 0.95;
    const Vec3d up = is_from_above ? Vec3d{0, 0, -1} : Vec3d{0, 1, 0};
    const Vec3d right = normalize(cross(-1.0 * eye_direction, up)), vertical = cross(right, -1.0 * eye_direction);
    std::vector<double> depths, horizontal_offsets, vertical_offsets;
    for (const Vec3f& point : points.points()) {
        const Vec3d offset = widen(point) - middle;
        depths.push_back(distance - dot(offset, eye_direction));
        horizontal_offsets.push_back(dot(offset, right));
        vertical_offsets.push_back(dot(offset, vertical));
    }
    const Fit horizontal_fit(std::move(horizontal_offsets), depths), vertical_fit(std::move(vertical_offsets), depths);
    const double tangent = std::max(horizontal_fit.tangent() / aspect, vertical_fit.tangent());
    const Vec3d target = middle + horizontal_fit.middle() * right + vertical_fit.middle() * vertical;
    const double detail = std::clamp(axes.extent(1), 1e-6 * radius, radius);
    return fmt::format("[camera]\neye = {}\ntarget = {}\n{}vfov_deg = {:.6g}\n",
        point_in_table(target + distance * eye_direction, detail), point_in_table(target, detail),
        is_from_above ? "up = [0, 0, -1]\n" : "", 2 * math::atan2(margin * tangent, 1.0) * 180 / pi);
}

}  // namespace crescent
