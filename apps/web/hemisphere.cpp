// One pixel: its hemisphere as a picture, its draws as points, its running mean, the factors of its largest sample.
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
    out["met"] = s.disk >= 0 && static_cast<std::size_t>(s.disk) < pixel.lights().size()
        ? pixel.lights()[static_cast<std::size_t>(s.disk)].name
        : s.meets_surroundings ? "sky or mesh"
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

/// The response for a pixel.
struct OpenPixelReply {
    std::shared_ptr<const OpenPixel> pixel;
    Disk view;
    std::string css;
    std::vector<PixelSample> samples;
    ordered_json out = {};
    const PixelSample* largest = nullptr;
    std::uint64_t lower_count = 0;

    void draw(const std::string& sampler, std::uint64_t n) {
        samples = pixel->samples(sampler, n, bench().experiment.seed);
        const auto largest_sample = std::ranges::max_element(samples, {}, &PixelSample::x);
        if (largest_sample != samples.end() && largest_sample->x > 0) largest = &*largest_sample;
        const auto shape = static_cast<std::size_t>(pixel->shape());
        out = {{"shape", bench().experiment.surface_name(shape)}, {"mirror", view.place(pixel->mirror())},
            {"draws", ordered_json::array()}};
    }
    void describe_draws() {
        for (const PixelSample& s : samples) {
            if (s.wi.z <= 0) ++lower_count;
            ordered_json entry = view.place({s.wi.x, s.wi.y, s.wi.z});
            entry.push_back(
                largest && s.x > 0 ? std::sqrt(double(s.x) / double(largest->x)) : 0);  // its area is its weight
            entry.push_back(s.wi.z > 0 ? s.disk : -2);
            out["draws"].push_back(std::move(entry));
        }
    }
    void describe_mean(const std::optional<double>& reference) {
        const std::vector<double> mean = running_mean(samples);
        out["mean"] = mean.empty() ? "0" : figures(mean.back());
        if (reference) out["reference"] = figures(*reference);
        out["chart"] = mean_chart(mean, reference, css);
    }
    void send() {
        out["under"] = lower_count;
        out["lights"] = ordered_json::array();
        for (const PixelLight& light : pixel->lights()) {
            ordered_json rim = ordered_json::array();
            for (const Vec3d& w : light.rim)
                if (w.z > 0) rim.push_back(view.place(w));
            out["lights"].push_back({{"name", light.name}, {"rim", rim}, {"angle", light.angular_radius}});
        }
        if (largest) out["largest"] = largest_in_parts(*largest, *pixel);
        respond(out);
    }
};

}  // namespace

/// {i, j, arm, n, css, reference: whether it is computed} -> draws, lights, the running mean and the largest sample; {}
/// if the pixel sees nothing.
CRESCENT_EXPORT(pixel)()->void {
    const ordered_json query = request();
    const int i = query.at("i").get<int>(), j = query.at("j").get<int>();
    const std::shared_ptr<const OpenPixel> pixel = open_pixel(i, j);
    if (!pixel) return respond(ordered_json::object());
    OpenPixelReply reply{pixel, Disk(pixel->mirror()), query.at("css").get<std::string>(), {}};
    reply.draw(arm_of(query.at("arm").get<std::string>()).sampler, query.at("n").get<std::uint64_t>());
    reply.describe_draws();
    const std::size_t index = static_cast<std::size_t>(j) * bench().width() + static_cast<std::size_t>(i);
    const bool has_reference = query.at("reference").get<bool>();
    reply.describe_mean(has_reference ? std::optional<double>(bench().reference.y.at(index)) : std::nullopt);
    reply.send();
}

/// {i, j, arm, what, size} -> the picture of a hemisphere for disk(), `size` pixels across: f L cos, or if `what` is
/// "pdf" the sampler's density (for two techniques, that of the first).
CRESCENT_EXPORT(hemisphere)()->void {
    const ordered_json query = request();
    const std::shared_ptr<const OpenPixel> pixel = open_pixel(query.at("i").get<int>(), query.at("j").get<int>());
    const int size = query.at("size").get<int>();
    if (!pixel) return paint_disk(Disk({0, 0, 1}), size, [](Vec3d) { return 0; });
    const std::string sampler = arm_of(query.at("arm").get<std::string>()).sampler;
    const bool shows_pdf = query.at("what").get<std::string>() == "pdf";
    paint_disk(Disk(pixel->mirror()), size, [&](Vec3d wi) {
        return shows_pdf ? pixel->pdf(sampler, wi) : pixel->f(wi, pixel->disk_met(wi)) * pixel->light(wi) * wi.z;
    });
}

}  // namespace crescent::web
