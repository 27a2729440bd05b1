// One pixel opened: its hemisphere as a picture, its draws as points, its running mean, its largest sample in parts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "disk.h"

namespace crescent::web {

namespace {

std::unique_ptr<OpenPixel> open_pixel(int i, int j) {
    if (!bench().scene.primary(i, j)) return nullptr;
    return std::make_unique<OpenPixel>(bench().scene, i, j);
}

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

std::string mean_chart(const std::vector<double>& mean, std::optional<double> reference, const std::string& css) {
    std::vector<Point> points;
    std::vector<double> values{0};
    if (reference) values.push_back(*reference);
    for (std::size_t k = 0; k < mean.size(); ++k) {
        points.push_back({double(k + 1), mean[k]});
        values.push_back(mean[k]);
    }
    Chart chart(320, 260, log_axis("N, samples of this pixel", {1, double(std::max<std::size_t>(mean.size(), 2))}),
        linear_axis("running mean of X", values), "Running mean of this pixel against N");
    if (reference) chart.rule(*reference, "strong", "reference");
    chart.line(points, css);
    return chart.str();
}

}  // namespace

/// {i, j, arm, n, css, reference: whether it is computed} -> draws, lights, the running mean and the largest sample; {}
/// where the pixel sees nothing.
CRESCENT_EXPORT(pixel)()->void {
    const ordered_json asked = request();
    const int i = asked.at("i").get<int>(), j = asked.at("j").get<int>();
    const auto open = open_pixel(i, j);
    if (!open) return say(ordered_json::object());
    const Bench& b = bench();
    const Disk view(open->mirror());
    const auto n = asked.at("n").get<std::uint64_t>();
    const std::string sampler = arm_of(asked.at("arm").get<std::string>()).sampler;
    const std::vector<PixelSample> all = open->samples(sampler, n, b.experiment.seed);
    ordered_json out = {{"shape", b.experiment.shapes.at(static_cast<std::size_t>(open->shape())).name}};
    out["mirror"] = view.place(open->mirror());
    out["draws"] = ordered_json::array();
    const auto by_x = [](const PixelSample& s) { return s.x; };
    const auto most = std::ranges::max_element(all, {}, by_x);
    const PixelSample* largest = most != all.end() && most->x > 0 ? &*most : nullptr;
    std::uint64_t under = 0;
    for (const PixelSample& s : all) {
        if (s.wi.z <= 0) ++under;
        ordered_json at = view.place({s.wi.x, s.wi.y, s.wi.z});
        at.push_back(largest && s.x > 0 ? std::sqrt(double(s.x) / double(largest->x)) : 0);  // its side: area is weight
        at.push_back(s.wi.z > 0 ? s.disk : -2);
        out["draws"].push_back(at);
    }
    out["under"] = under;
    out["lights"] = ordered_json::array();
    for (const PixelDisk& disk : open->disks()) {
        ordered_json rim = ordered_json::array();
        for (const Vec3d& w : disk.rim)
            if (w.z > 0) rim.push_back(view.place(w));
        out["lights"].push_back({{"name", disk.name}, {"rim", rim}, {"angle", disk.angular_radius}});
    }
    std::optional<double> reference;
    if (asked.at("reference").get<bool>())
        reference = b.reference.y.at(static_cast<std::size_t>(j) * b.width() + static_cast<std::size_t>(i));
    const std::vector<double> mean = running_mean(all);
    out["mean"] = mean.empty() ? "0" : figures(mean.back());
    if (reference) out["reference"] = figures(*reference);
    out["chart"] = mean_chart(mean, reference, asked.at("css").get<std::string>());
    if (largest) out["largest"] = largest_in_parts(*largest, *open);
    say(out);
}

/// A square picture of a hemisphere, `size` pixels across: what = 0: f L cos, 1: the arm's density (of an arm of two
/// techniques, of the first), each through turbo on a logarithmic scale of four decades below its largest value.
CRESCENT_EXPORT(hemisphere)(int i, int j, int arm, int what, int size)->const void* {
    const auto open = open_pixel(i, j);
    if (!open) return Disk({0, 0, 1}).paint(size, [](Vec3d) { return 0; });
    const Disk view(open->mirror());
    const std::string& sampler = bench().experiment.arms.at(static_cast<std::size_t>(arm)).sampler;
    return view.paint(size, [&](Vec3d wi) {
        return what == 1 ? open->pdf(sampler, wi) : open->f(wi, open->disk_met(wi)) * open->light(wi) * wi.z;
    });
}

}  // namespace crescent::web
