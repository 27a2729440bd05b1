// The target is evaluated at each draw, and q once for each w_o from draws of its own.
#include "check/sources/reciprocal_weights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/parallel.h"
#include "check/estimate/stream.h"

namespace crescent {

namespace {

class BoundedWeights : public DecoratedSampler {
    using Kind = SamplerQuery::Kind;

public:
    explicit BoundedWeights(std::shared_ptr<const SamplerAdapter> sampler)
        : DecoratedSampler(std::move(sampler), {}), traits_(inner().traits()) {}

    void evaluate(const SamplerQuery& query, const SamplerAnswers& out) const override {
        switch (query.kind) {
            case Kind::sample: return sample(query, out.draws);
            case Kind::f: return f(query.pairs, out.values);
            case Kind::target: return inner().f(query.pairs, out.values);
            case Kind::f_channels: {
                std::vector<double> values(out.channels.size());
                f(query.pairs, values);
                for (std::size_t i = 0; i < values.size(); ++i) out.channels[i] = {values[i], values[i], values[i]};
                return;
            }
            default: inner().evaluate(query, out);
        }
    }

private:
    void sample(const SamplerQuery& query, std::span<Draw> out) const {
        const double q = scale_at(query.wo);
        inner().evaluate(query, {.draws = out});
        const std::vector<double> target = targets_at(query.wo, out);
        for (std::size_t i = 0; i < out.size(); ++i) {
            Draw& d = out[i];
            if (d.weight) *d.weight *= bounded(target[i], q);
        }
    }
    void f(std::span<const Pair> pairs, std::span<double> out) const {
        inner().f(pairs, out);
        Vec3d wo{};
        double q = 0;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const Vec3d direction = pairs[i].wo;
            if (i == 0 || direction.x != wo.x || direction.y != wo.y || direction.z != wo.z) {
                wo = direction;
                q = scale_at(wo);
            }
            const double target = traits_.density(pairs[i].wi, out[i]);
            // Over another domain f is the target times a factor of measure, which h has too.
            out[i] = target > 0 ? bounded(target, q) * (out[i] / target) : target;
        }
    }

    Traits traits_;
    mutable Mutex lock_;
    mutable std::map<std::tuple<double, double, double>, double> scales_;

    static double bounded(double target, double q) { return target / (target + q); }

    /// The target at each draw with a weight; 0 for the others.
    std::vector<double> targets_at(Vec3d wo, std::span<const Draw> draws) const {
        std::vector<Pair> pairs;
        std::vector<std::size_t> indices;
        for (std::size_t i = 0; i < draws.size(); ++i)
            if (draws[i].pdf > 0 && draws[i].weight && std::isfinite(dot(draws[i].wi, draws[i].wi))) {
                pairs.push_back({wo, draws[i].wi});
                indices.push_back(i);
            }
        std::vector<double> answers(pairs.size()), out(draws.size());
        inner().f(pairs, answers);
        for (std::size_t k = 0; k < pairs.size(); ++k) out[indices[k]] = traits_.density(pairs[k].wi, answers[k]);
        return out;
    }

    double scale_at(Vec3d wo) const {
        const Guard one_at_a_time(lock_);
        double& q = scales_[{wo.x, wo.y, wo.z}];
        if (q > 0) return q;
        constexpr std::uint32_t pilot = 512;
        constexpr check::StreamKey key{.seed = 0x72657376, .purpose = check::Purpose::pilot};
        const std::vector<PrimarySample> u = check::first_numbers(key, pilot, traits_);
        std::vector<Draw> draws(u.size());
        inner().sample(0, wo, u, draws);
        std::vector<double> targets = targets_at(wo, draws);
        std::erase_if(targets, [](double t) { return !(t > 0) || !std::isfinite(t); });
        const auto middle = targets.begin() + std::ssize(targets) / 2;
        if (!targets.empty()) std::nth_element(targets.begin(), middle, targets.end());
        return q = targets.empty() ? 1 : *middle;
    }
};

}  // namespace

std::shared_ptr<const SamplerAdapter> with_bounded_weights(std::shared_ptr<const SamplerAdapter> sampler) {
    return std::make_shared<BoundedWeights>(std::move(sampler));
}

}  // namespace crescent
