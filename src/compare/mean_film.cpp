// Means and squared deviations of Y, R, G and B over renders that come one at a time (Welford 1962).
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "compare/quantities.h"
#include "compare/renders.h"

namespace crescent::inline comparing {

namespace {

bool is_grey(const Render& render) {
    const auto same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    return std::equal(render.r.begin(), render.r.end(), render.g.begin(), same) &&
        std::equal(render.r.begin(), render.r.end(), render.b.begin(), same);
}

void add_value(MeanPlane& plane, std::size_t i, float x, double n) {
    const double value = static_cast<double>(x), off = value - plane.mean[i];
    plane.mean[i] += off / n;
    plane.m2[i] += off * (value - plane.mean[i]);
}

}  // namespace

void MeanFilm::add(const Render& render, double variance_scale) {
    if (count == 0) {
        const std::vector<double> zero(render.size());
        planes.assign(1, {zero, zero});
        told_variance.assign(render.variance.size(), 0);
    }
    if (planes.size() == 1 && !is_grey(render)) planes.resize(colour_quantities, MeanPlane(planes[0]));
    if (render.variance.size() != told_variance.size() || variance_scale == 0)
        told_variance.clear();  // not every file has one
    ++count;
    rounding = std::max(rounding, render.rounding);
    const double n = static_cast<double>(count);
    const std::vector<float>* channels[] = {&render.r, &render.g, &render.b};
    const auto width = static_cast<std::size_t>(render.width);
    parallel_for(std::size_t{0}, static_cast<std::size_t>(render.height), [&](std::size_t row) {
        for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
            add_value(planes[0], i, render.y(i), n);
            for (std::size_t q = 1; q < planes.size(); ++q) add_value(planes[q], i, (*channels[q - 1])[i], n);
            if (!told_variance.empty()) told_variance[i] += render.variance[i] * static_cast<float>(variance_scale);
        }
    });
}

std::vector<float> MeanFilm::radiance(std::size_t channel) const {
    const std::vector<double>& mean = of(channel + 1).mean;
    std::vector<float> out(mean.size());
    std::transform(mean.begin(), mean.end(), out.begin(), [](double x) { return static_cast<float>(x); });
    return out;
}

double MeanFilm::variance(std::size_t i, std::size_t quantity) const {
    if (count >= 2) return of(quantity).m2[i] / static_cast<double>(count - 1);
    const bool known = !told_variance.empty() && (quantity == 0 || planes.size() == 1);
    return known ? static_cast<double>(told_variance[i]) / static_cast<double>(count) : std::nan("");
}

}  // namespace crescent::inline comparing
