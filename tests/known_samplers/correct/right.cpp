// The parameters' seed mixes the number with the seed; the family is the number modulo how many there are. w_o is n in
// one of eight, else from 0.5 to 80 degrees in three of four and from 80 to 89 in the rest, at any azimuth.

#include <cmath>
#include <fmt/format.h>

#include "check/sources/cases.h"
#include "math/functions.h"
#include "tests/known_samplers/correct/renderers.h"

namespace crescent {

namespace {

class FromRecipe : public SamplerSource {
public:
    explicit FromRecipe(SyntheticSampler r) : recipe_(std::move(r)) {}
    std::string name() const override { return recipe_.family + " (" + recipe_.parameters + ")"; }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) out[i] = recipe_.sample(wo, u[i]);
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = recipe_.pdf(at[i].wo, at[i].wi);
    }
    Traits traits() const override { return recipe_.traits; }
    bool has_f() const override { return recipe_.f || recipe_.f_channels; }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i)
            out[i] = recipe_.f       ? recipe_.f(at[i].wo, at[i].wi)
                : recipe_.f_channels ? luminance(recipe_.f_channels(at[i].wo, at[i].wi))
                                     : 0;
    }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        if (!recipe_.f_channels) return SamplerAdapter::f_channels(at, out);
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = recipe_.f_channels(at[i].wo, at[i].wi);
    }

private:
    SyntheticSampler recipe_;
};

Rng dice_of(std::uint64_t index, std::uint32_t seed) { return Rng(0x9e3779b97f4a7c15u * (index + 1) + seed); }

}  // namespace

double Rng::log(double low, double high) { return low * math::exp(uniform(0, math::log(high / low))); }
Vec3d Rng::direction(double least_cos, double most_cos) {
    const double cos = uniform(least_cos, most_cos);
    return about({0, 0, 1}, cos, uniform(0, 1));
}

std::shared_ptr<const SamplerAdapter> make_adapter(SyntheticSampler recipe) {
    return std::make_shared<FromRecipe>(std::move(recipe));
}

SyntheticSampler right_sampler(std::uint64_t index, std::uint32_t seed) {
    static const std::vector<SamplerFamily> all = [] {
        std::vector<SamplerFamily> out;
        for (const auto& some : {microfacet_families(), lobe_families(), table_families(), renderer_families()})
            out.insert(out.end(), some.begin(), some.end());
        return out;
    }();
    Rng dice = dice_of(index, seed);
    return all[index % all.size()](dice);
}

CheckCase correct_case(std::uint64_t index, std::uint32_t seed) {
    Rng dice = dice_of(index, seed + 0x51u);
    const double theta = dice.whole(0, 7) == 0 ? 0 : dice.whole(0, 3) ? dice.uniform(0.5, 80) : dice.uniform(80, 89);
    const std::shared_ptr<const SamplerAdapter> adapter = make_adapter(right_sampler(index, seed));
    const Traits::WoDomain asked = adapter->traits().wo;
    if (asked == Traits::WoDomain::none) return make_user_case(adapter, 0, 0);
    const bool below = asked == Traits::WoDomain::both && index / 2 % 2 == 1;
    return make_user_case(adapter, below ? 180 - theta : theta, theta == 0 ? 0 : dice.uniform(0, 360));
}

}  // namespace crescent
