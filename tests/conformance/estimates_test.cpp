// Samplers whose f, pdf and weights are random estimates, like layered surfaces: they do not fail for it, and a fault
// of the mean is found.
#include <bit>
#include <cmath>
#include <gtest/gtest.h>

#include "check/check.h"
#include "check/sources/cases.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/support/checked.h"

namespace crescent {
namespace estimates_test {

enum class Walk { own, hashed };

/// The factor of an estimate: 0 or 2, or exponential.
struct Factor {
    bool coin = false;
    double operator()(double u) const { return coin ? (u < 0.5 ? 0 : 2) : -std::log(1 - u); }
};

/// A correct sampler whose results are multiplied by a random number of mean 1; its draws keep their own pdf, times
/// another.
class Estimating : public SamplerSource {
public:
    SyntheticSampler right;
    Factor factor;
    Walk walk = Walk::own;
    bool of_pdf = true, of_f = true;
    double f_off = 1;
    bool swapped = false;

    Estimating(SyntheticSampler r, Factor by, Walk w) : right(std::move(r)), factor(by), walk(w) {}
    std::string name() const override { return "estimates"; }
    Traits traits() const override {
        Traits t = right.traits;
        t.own_random = walk == Walk::own;
        return t;
    }
    bool serial() const override { return true; }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            PrimarySample v = u[i];
            for (int k = 0; walk == Walk::own && k < right.traits.numbers; ++k) v[k] = dice_.uniform(0, 1);
            Draw& d = out[i] = right.sample(wo, v);
            if (!(d.pdf > 0)) continue;
            const Vec3d f = right.f_channels ? right.f_channels(wo, d.wi) : Vec3d{1, 1, 1} * right.f(wo, d.wi);
            const double estimate = factor(of(wo, d.wi, 3));
            d.weights = f * (estimate * std::fabs(d.wi.z) / d.pdf);
            if (swapped) std::swap(d.weights.x, d.weights.z);
            d.weight = right.traits.channels == 3 ? luminance(d.weights) : d.weights.x;
            if (of_pdf) d.pdf *= 0.5 + of(wo, d.wi, 4);
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i)
            out[i] = right.pdf(at[i].wo, at[i].wi) * (of_pdf ? factor(of(at[i].wo, at[i].wi, 1)) : 1);
    }
    bool has_f() const override { return true; }
    void f_channels(std::span<const Pair> at, std::span<Vec3d> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) {
            const auto& [wo, wi] = at[i];
            out[i] = right.f_channels ? right.f_channels(wo, wi) : Vec3d{1, 1, 1} * right.f(wo, wi);
            out[i] = out[i] * (f_off * (of_f ? factor(of(wo, wi, 2)) : 1));
        }
    }
    void f(std::span<const Pair> at, std::span<double> out) const override {
        std::vector<Vec3d> by_channel(at.size());
        f_channels(at, by_channel);
        for (std::size_t i = 0; i < at.size(); ++i)
            out[i] = right.traits.channels == 3 ? luminance(by_channel[i]) : by_channel[i].x;
    }

private:
    mutable Rng dice_{7};
    double of(Vec3d wo, Vec3d wi, std::uint64_t which) const {
        if (walk == Walk::own) return dice_.uniform(0, 1);
        for (double v : {wo.x, wo.y, wo.z, wi.x, wi.y, wi.z}) {
            which = (which ^ std::bit_cast<std::uint64_t>(v)) * 0xbf58476d1ce4e5b9u;
            which ^= which >> 29;
        }
        return static_cast<double>(which * 0x94d049bb133111ebu >> 11) * 0x1p-53;
    }
};

CheckResult checked(std::shared_ptr<const SamplerAdapter> adapter, double theta = 45) {
    TestSettings settings;
    settings.budget = check::CheckBudget::limited();
    return checked_at(std::move(adapter), theta, settings);
}

std::string all_messages(const CheckResult& j) {
    std::string out;
    for (const Verdict& v : j.verdicts) out += v.name + ": " + std::string(word(v.state)) + ". " + v.message() + "\n";
    return out;
}

TEST(Estimates, AreRecognisedAndNotAccused) {
    for (Walk walk : {Walk::own, Walk::hashed})
        for (bool coin : {false, true})
            for (const SyntheticSampler& right : {recipe_of(Layers{}), recipe_of(RoughGlass{})}) {
                const CheckResult j = checked(std::make_shared<Estimating>(right, Factor{coin}, walk));
                EXPECT_NE(j.state, State::wrong) << all_messages(j);
                EXPECT_NE(named(j, "valid").message().find("random estimates"), std::string::npos) << all_messages(j);
                for (const char* name : {"valid", "normalised", "density", "identity"})
                    EXPECT_EQ(named(j, name).state, State::right) << all_messages(j);
                if (!coin) EXPECT_EQ(named(j, "mean").state, State::right) << all_messages(j);  // else a tail with ties
            }
}

TEST(Estimates, OfFAloneOrOfPdfAloneAreTold) {
    for (bool of_pdf : {false, true}) {
        const auto adapter = std::make_shared<Estimating>(recipe_of(Layers{}), Factor{}, Walk::own);
        adapter->of_pdf = of_pdf;
        adapter->of_f = !of_pdf;
        const CheckResult j = checked(adapter);
        EXPECT_EQ(j.state, State::right) << all_messages(j);
        EXPECT_NE(
            named(j, "valid").message().find(of_pdf ? "pdf(w) is a random" : "f(w) is a random"), std::string::npos);
    }
}

TEST(Estimates, RandomWeightsAloneAreRight) {
    const auto adapter = std::make_shared<Estimating>(recipe_of(Layers{}), Factor{}, Walk::own);
    adapter->of_pdf = adapter->of_f = false;
    const CheckResult j = checked(adapter);
    EXPECT_EQ(j.state, State::right) << all_messages(j);
    adapter->f_off = 1.1;
    EXPECT_EQ(named(checked(adapter), "mean").state, State::wrong);
}

TEST(Estimates, OfAnFOffTheWeightAreFound) {
    for (Walk walk : {Walk::own, Walk::hashed})
        for (bool of_pdf : {false, true}) {
            const auto adapter = std::make_shared<Estimating>(recipe_of(Layers{}), Factor{}, walk);
            // If f is an estimate and pdf(w) is not, few points of f are evaluated: the integral is known to 3 %.
            adapter->f_off = walk == Walk::hashed && !of_pdf ? 1.25 : 1.1;
            adapter->of_pdf = of_pdf;
            const CheckResult j = checked(adapter);
            EXPECT_EQ(named(j, "mean").state, State::wrong) << all_messages(j);
            EXPECT_NE(named(j, "physics").state, State::wrong)
                << "an estimate of f is not reciprocal: " << all_messages(j);
        }
}

TEST(Estimates, WhoseChannelsAreExchangedAreFound) {
    const auto adapter = std::make_shared<Estimating>(recipe_of(Layers{}), Factor{}, Walk::own);
    adapter->swapped = true;
    const CheckResult j = checked(adapter);
    EXPECT_EQ(named(j, "mean").state, State::wrong) << all_messages(j);
}

/// The visible normals of another roughness: draws that do not follow the mean of pdf(w).
TEST(Estimates, OfADensityThatIsNotDrawnAreFound) {
    SyntheticSampler r = recipe_of(Layers{.alpha = 0.3});
    r.sample = recipe_of(Layers{.alpha = 0.45}).sample;
    const CheckResult j = checked(std::make_shared<Estimating>(r, Factor{}, Walk::own));
    EXPECT_EQ(named(j, "density").state, State::wrong) << all_messages(j);
}

}  // namespace estimates_test
}  // namespace crescent
