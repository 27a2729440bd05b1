// The one switch over the kinds of query of samplers that are asked in batches.
#include "samplers/batch_sampler.h"

#include <algorithm>
#include <vector>

#include "base/errors.h"

namespace crescent {

void copy_to_channels(std::span<const double> values, std::span<Vec3d> out) {
    std::ranges::transform(values, out.begin(), [](double value) { return Vec3d{value, value, value}; });
}

void BatchSampler::evaluate(const SamplerQuery& query, const SamplerAnswers& out) const {
    using Kind = SamplerQuery::Kind;
    if (query.rows() == 0) return;
    switch (query.kind) {
        case Kind::sample: return draw_rows(query, out.draws);
        case Kind::pdf:
        case Kind::exact_pdf: return pdf_rows(query, out.values);
        case Kind::mis_weight: return std::fill(out.values.begin(), out.values.end(), 1.0);
        case Kind::f:
        case Kind::target:
        case Kind::reference_f: return f_rows(query, out.values);
        case Kind::f_channels: return f_rows_by_channel(query, out.channels);
        case Kind::weigh: return weight_rows(query, out.values);
    }
}

void BatchSampler::f_rows_by_channel(const SamplerQuery& query, std::span<Vec3d> out) const {
    std::vector<double> values(out.size());
    f_rows(query, values);
    copy_to_channels(values, out);
}

void BatchSampler::weight_rows(const SamplerQuery& /*query*/, std::span<double> /*out*/) const {
    ensure(false, "a sampler that does not weigh is not asked to");
}

}  // namespace crescent
