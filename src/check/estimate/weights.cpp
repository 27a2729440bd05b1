// A weight that a sampler gives itself counts before f cos / pdf.
#include "check/estimate/weights.h"

#include <cmath>

namespace crescent::check {

namespace {

double own_weight(const Source& source, const Draw& d, const Vec3d* f_cos) {
    if (d.weight) return *d.weight;
    if (!source.has_density()) return 0;  // the pdf of a draw is 1 or 0 then
    if (!f_cos) return d.f.value_or(0) * std::fabs(d.wi.z) / d.pdf;
    return (source.channels() == 3 ? luminance(*f_cos) : f_cos->x) / d.pdf;
}

}  // namespace

void append_weights(
    Source& source, std::span<const Draw> batch, const DrawnDirections& directions, std::vector<double>& to) {
    const std::size_t first = to.size();
    to.resize(first + batch.size(), 0);
    std::vector<double> mis(directions.wi.size(), 1);
    if (source.adapter.techniques() > 1) source.mis_weights(directions.wi, mis);
    for (std::size_t k = 0; k < directions.at.size(); ++k) {
        const Draw& d = batch[directions.at[k]];
        if (!is_direction(d, directions.p[k])) continue;
        const double x = own_weight(source, d, directions.f_cos.empty() ? nullptr : &directions.f_cos[k]);
        if (std::isfinite(x)) to[first + directions.at[k]] = mis[k] * x * source.radiance(d.wi);
    }
    for (std::size_t i = 0; i < batch.size(); ++i)
        if (batch[i].delta > 0 && batch[i].weight && std::isfinite(*batch[i].weight))
            to[first + i] = *batch[i].weight * source.radiance(batch[i].wi);
}

}  // namespace crescent::check
