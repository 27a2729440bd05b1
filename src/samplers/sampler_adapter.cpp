// Rows of random numbers, and the queries that are passed on.
#include "samplers/sampler_adapter.h"

#include <algorithm>

#include "base/errors.h"
#include "samplers/batch_sampler.h"

namespace crescent {

std::span<const double> NumberRows::packed(std::size_t columns, std::vector<double>& room) const {
    if (columns_ == columns && columns > 0) return packed_;
    room.clear();
    for (std::size_t row = 0; row < size(); ++row)
        for (std::size_t k = 0; k < columns; ++k) room.push_back((*this)(row, k));
    return room;
}

std::span<const PrimarySample> NumberRows::samples(std::vector<PrimarySample>& room) const {
    if (columns_ == 0) return samples_;
    room.assign(size(), {});
    for (std::size_t row = 0; row < room.size(); ++row)
        for (std::size_t k = 0; k < columns_; ++k) room[row][static_cast<int>(k)] = (*this)(row, k);
    return room;
}

bool SamplerDeclaration::uses_lights() const { return std::ranges::find(uses, "lights") != uses.end(); }

void SamplerSource::mis_weight(int /*technique*/, std::span<const Pair> /*pairs*/, std::span<double> out) const {
    std::ranges::fill(out, 1.0);
}

void SamplerSource::f(std::span<const Pair> /*pairs*/, std::span<double> out) const { std::ranges::fill(out, 0.0); }

void SamplerSource::f_channels(std::span<const Pair> pairs, std::span<Vec3d> out) const {
    std::vector<double> values(out.size());
    f(pairs, values);
    copy_to_channels(values, out);
}

SamplerDeclaration SamplerSource::declaration() const {
    SamplerDeclaration out{.name = name(),
        .traits = traits(),
        .techniques = {},
        .has_f = has_f(),
        .has_drawn_f = has_drawn_f(),
        .has_true_f = has_true_f(),
        .can_draw = can_draw(),
        .serial = serial(),
        .limited = limited()};
    for (int technique = 0; technique < techniques(); ++technique) out.techniques.push_back(technique_name(technique));
    return out;
}

void SamplerSource::evaluate(const SamplerQuery& query, const SamplerAnswers& out) const {
    using Kind = SamplerQuery::Kind;
    switch (query.kind) {
        case Kind::sample: {
            std::vector<PrimarySample> room;
            const std::span<const PrimarySample> u = query.u.samples(room);
            if (!query.scene) return sample(query.technique, query.wo, u, out.draws);
            std::size_t first = 0;
            for (const SurfaceRun& run : query.scene->runs) {
                sample(query.technique, run.wo, u.subspan(first, run.rows), out.draws.subspan(first, run.rows));
                first += run.rows;
            }
            return;
        }
        case Kind::pdf: return pdf(query.technique, query.pairs, out.values);
        case Kind::exact_pdf: return exact_pdf(query.technique, query.pairs, out.values);
        case Kind::mis_weight: return mis_weight(query.technique, query.pairs, out.values);
        case Kind::f: return f(query.pairs, out.values);
        case Kind::f_channels: return f_channels(query.pairs, out.channels);
        case Kind::target: return target(query.pairs, out.values);
        case Kind::reference_f: return reference_f(query.pairs, out.values);
        case Kind::weigh: ensure(false, "a sampler that does not weigh is not asked to");
    }
}

SamplerDeclaration DecoratedSampler::declaration() const {
    SamplerDeclaration out = inner_->declaration();
    if (declare_) declare_(out);
    return out;
}

void DecoratedSampler::evaluate(const SamplerQuery& query, const SamplerAnswers& out) const {
    if (evaluate_) evaluate_(*inner_, query, out);
    else inner_->evaluate(query, out);
}

}  // namespace crescent
