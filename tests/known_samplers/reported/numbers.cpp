// Unusable values, states that draws depend on, and random numbers of the sampler's own.
#include <cmath>

#include "check/sources/cases.h"
#include "tests/known_samplers/correct/renderers.h"
#include "tests/known_samplers/reported/known.h"

namespace crescent {

namespace {

Draw cosine_draw(double u1, double u2) {
    const Vec3d wi = about({0, 0, 1}, std::sqrt(1 - u1), u2);
    return {wi, wi.z / pi, {}, {}};
}

SyntheticSampler cosine() {
    SyntheticSampler r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d wi) { return std::max(wi.z, 0.0) / pi; };
    r.f = [](Vec3d wo, Vec3d wi) { return wo.z > 0 && wi.z > 0 ? 0.5 / pi : 0.0; };
    r.sample = [](Vec3d, const PrimarySample& u) { return cosine_draw(u[0], u[1]); };
    return r;
}
SyntheticSampler changed(std::function<void(const PrimarySample&, Draw&)> change) {
    SyntheticSampler r = cosine();
    r.sample = [change](Vec3d, const PrimarySample& u) {
        Draw d = cosine_draw(u[0], u[1]);
        change(u, d);
        return d;
    };
    return r;
}

/// Returns its previous draw.
class Delayed : public SamplerSource {
public:
    std::string name() const override { return "delayed"; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            out[i] = last_;
            last_ = cosine_draw(u[i].x, u[i].y);
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = std::max(at[i].wi.z, 0.0) / pi;
    }
    bool serial() const override { return true; }

private:
    mutable Draw last_ = cosine_draw(0.5, 0.5);
};

/// The last bits of a block depend on vector instructions, as in NumPy.
class Packed : public SamplerSource {
public:
    std::string name() const override { return "packed"; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            out[i] = cosine_draw(u[i].x, u[i].y);
            if (i % 8 < 3) {
                out[i].wi.x *= 1 + 0x1p-52;
                out[i].pdf *= 1 - 0x1p-52;
            }
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = std::max(at[i].wi.z, 0.0) / pi;
    }
    bool serial() const override { return true; }
};

/// A coat that draws random numbers of its own; `says`: whether it declares this.
SyntheticSampler own_numbers(bool says) {
    SyntheticSampler r = recipe_of(SmoothCoat{});
    r.traits.own_random = says;
    const auto dice = std::make_shared<Rng>(5);
    r.sample = [dice](Vec3d wo, const PrimarySample&) {
        PrimarySample u;
        for (int k = 0; k < 3; ++k) u[k] = dice->uniform(0, 1);
        return SmoothCoat{}.sample(wo, u);
    };
    return r;
}

}  // namespace

std::vector<KnownSampler> numbers_samplers() {
    KnownList list;
    list.add("answers with its previous draw", Known::wrong, "identity",
        {make_user_case(std::make_shared<Delayed>(), 45, 130)});
    list.add(
        "last bits by place in the block", Known::right, "", {make_user_case(std::make_shared<Packed>(), 45, 130)});
    list.wrong("NaN in one corner of u", "valid", changed([](const PrimarySample& u, Draw& d) {
        if (u[0] == 0 && u[1] == 0) d.pdf = std::nan("");
    }));
    list.wrong("NaN in 4 of 100 000 draws", "valid", changed([](const PrimarySample& u, Draw& d) {
        if (u[0] > 0.5 && u[0] < 0.5 + 4e-5) d.wi.x = std::nan("");
    }));
    SyntheticSampler below = cosine();
    below.pdf = [](Vec3d, Vec3d wi) { return wi.z / pi; };
    list.wrong("negative pdf below the horizon", "valid", below);
    list.not_wrong("its own numbers", own_numbers(true));  // no replicates, a third of the draws are delta parts
    list.wrong("its own numbers without saying so", "identity", own_numbers(false));
    return list.take();
}

}  // namespace crescent
