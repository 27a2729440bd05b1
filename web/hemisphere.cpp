// One pixel opened: its hemisphere as a picture, its draws as points, its running mean, its largest sample in parts.
// Directions go to the disk by Lambert's azimuthal equal-area projection from n: (x, y) / sqrt(1 + z), the horizon
// at 1.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "door.h"

namespace crescent::web {

namespace {

/// Where a direction of the upper half lies in the unit disk, and back.
std::pair<double, double> projected(double x, double y, double z) {
    const double by = 1 / std::sqrt(1 + std::max(z, 0.0));
    return {x * by, y * by};
}
std::optional<Vec3d> direction(double x, double y) {
    const double r2 = x * x + y * y;
    if (r2 >= 1) return std::nullopt;
    const double by = std::sqrt(2 - r2);
    return Vec3d{x * by, y * by, 1 - r2};
}

/// Turned about n so that R lies towards +x, hence the plane of incidence is the picture's middle row.
class View {
public:
    explicit View(const OpenPixel& pixel) {
        const Vec3d r = pixel.mirror();
        const double length = std::sqrt(r.x * r.x + r.y * r.y);
        if (length > 1e-9) c_ = r.x / length, s_ = r.y / length;
    }
    Vec3d turned(Vec3d w) const { return {c_ * w.x + s_ * w.y, c_ * w.y - s_ * w.x, w.z}; }
    Vec3d back(Vec3d w) const { return {c_ * w.x - s_ * w.y, s_ * w.x + c_ * w.y, w.z}; }
    ordered_json place(Vec3d w) const {
        const Vec3d t = turned(w);
        const auto [x, y] = projected(t.x, t.y, t.z);
        return {x, y};
    }

private:
    double c_ = 1, s_ = 0;
};

std::unique_ptr<OpenPixel> open_pixel(int i, int j) {
    if (!bench().scene.primary(i, j)) return nullptr;
    return std::make_unique<OpenPixel>(bench().scene, i, j);
}

const ordered_json number_of(double x) { return told(x); }

ordered_json largest_in_parts(const PixelSample& s, const OpenPixel& pixel) {
    const double polar = math::acos(std::clamp(double(s.wi.z), -1.0, 1.0)) * 180 / pi;
    ordered_json out = {{"x", figures(s.x)}, {"f", figures(s.f)}, {"light", figures(s.light)}, {"cos", figures(s.cos)},
        {"pdf", figures(s.pdf)}, {"over_p", figures(1 / double(s.pdf))}, {"angle", figures(polar, 3)}};
    if (s.weight != 1) out["weight"] = figures(s.weight);
    out["met"] = s.disk >= 0 && static_cast<std::size_t>(s.disk) < pixel.disks().size()
        ? pixel.disks()[static_cast<std::size_t>(s.disk)].name
        : "fill";
    return out;
}

std::string mean_chart(const std::vector<double>& mean, double reference, const std::string& css) {
    std::vector<Point> points;
    std::vector<double> values{reference};
    for (std::size_t k = 0; k < mean.size(); ++k) {
        points.push_back({double(k + 1), mean[k]});
        values.push_back(mean[k]);
    }
    values.push_back(0);
    Chart chart(420, 220, log_axis("N, samples of this pixel", {1, double(std::max<std::size_t>(mean.size(), 2))}),
        linear_axis("running mean of X", values), "Running mean of this pixel against N");
    chart.rule(reference, "strong", "reference");
    chart.line(points, css);
    return chart.str();
}

}  // namespace

/// {i, j, arm, n, css} -> draws, lights, the running mean and the largest sample; {} where the pixel sees nothing.
CRESCENT_EXPORT(pixel)()->void {
    const ordered_json asked = request();
    const int i = asked.at("i").get<int>(), j = asked.at("j").get<int>();
    const auto open = open_pixel(i, j);
    if (!open) return say(ordered_json::object());
    const Bench& b = bench();
    const View view(*open);
    const auto n = asked.at("n").get<std::uint64_t>();
    const std::string sampler = arm_of(asked.at("arm").get<std::string>()).sampler;
    const std::vector<PixelSample> all = open->samples(sampler, n, b.experiment.seed);
    ordered_json out = {{"shape", b.experiment.shapes.at(static_cast<std::size_t>(open->shape())).name}};
    out["mirror"] = view.place(open->mirror());
    out["draws"] = ordered_json::array();
    const PixelSample* largest = nullptr;
    std::uint64_t under = 0;
    for (const PixelSample& s : all) {
        if (s.wi.z <= 0) ++under;
        ordered_json at = view.place({s.wi.x, s.wi.y, s.wi.z});
        at.push_back(number_of(s.x));
        at.push_back(s.wi.z > 0 ? s.disk : -2);
        out["draws"].push_back(at);
        if (s.x > 0 && (!largest || s.x > largest->x)) largest = &s;
    }
    out["under"] = under;
    out["lights"] = ordered_json::array();
    for (const PixelDisk& disk : open->disks()) {
        ordered_json rim = ordered_json::array();
        for (const Vec3d& w : disk.rim)
            if (w.z > 0) rim.push_back(view.place(w));
        out["lights"].push_back({{"name", disk.name}, {"rim", rim}, {"angle", disk.angular_radius}});
    }
    const double reference = b.reference.y.at(static_cast<std::size_t>(j) * b.width() + static_cast<std::size_t>(i));
    const std::vector<double> mean = running_mean(all);
    out["mean"] = mean.empty() ? "0" : figures(mean.back());
    out["reference"] = figures(reference);
    out["chart"] = mean_chart(mean, reference, asked.at("css").get<std::string>());
    if (largest) out["largest"] = largest_in_parts(*largest, *open);
    say(out);
}

/// A square picture of a hemisphere, `size` pixels across: what = 0: f L cos, 1: the arm's density (of an arm of two
/// techniques, of the first), each through turbo on a logarithmic scale of four decades below its largest value.
CRESCENT_EXPORT(hemisphere)(int i, int j, int arm, int what, int size)->const void* {
    std::vector<std::byte>& out = scratch<std::byte>();
    const auto side = static_cast<std::size_t>(size);
    out.assign(side * side * 4, std::byte{0});
    const auto open = open_pixel(i, j);
    if (!open) return out.data();
    const View view(*open);
    const std::string& sampler = bench().experiment.arms.at(static_cast<std::size_t>(arm)).sampler;
    std::vector<double> values(side * side, -1);
    double largest = 0;
    for (std::size_t row = 0; row < side; ++row)
        for (std::size_t column = 0; column < side; ++column) {
            const double x = (2 * double(column) + 1) / size - 1, y = 1 - (2 * double(row) + 1) / size;
            const auto turned = direction(x, y);
            if (!turned) continue;
            const Vec3d wi = view.back(*turned);
            const double value =
                what == 1 ? open->pdf(sampler, wi) : open->f(wi, open->disk_met(wi)) * open->light(wi) * wi.z;
            values[row * side + column] = value;
            if (std::isfinite(value)) largest = std::max(largest, value);
        }
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] < 0) continue;
        const double t = values[k] > 0 && largest > 0 ? 1 + math::log10(values[k] / largest) / 4 : 0;
        const Srgb8 colour = turbo(std::clamp(t, 0.0, 1.0));
        for (std::size_t c = 0; c < 3; ++c) out[4 * k + c] = static_cast<std::byte>(colour[c]);
        out[4 * k + 3] = std::byte{255};
    }
    return out.data();
}

}  // namespace crescent::web
