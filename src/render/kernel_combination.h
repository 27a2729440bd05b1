// A combination of built-in samplers as a kernel's arm: the directions of one sample at a pack of pixels, and their
// weights. Densities are those of the samplers in single precision; what is made of them is in double, lane by lane, in
// the order of combination.cpp, so both have the same bits. Included only by kernel_body.h.
#pragma once

#include <limits>
#include <new>

#include "math/simd/random.h"
#include "render/kernel.h"
#include "render/kernel_lights.h"
#include "samplers/all.h"

namespace crescent {
namespace CRESCENT_ISA {

template <class F> MaskOf<F> no_lane() { return number<F>(1) < number<F>(0); }
template <class F> CRESCENT_INLINE Vec3<F> select_each(MaskOf<F> m, Vec3<F> a, Vec3<F> b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

/// One built-in sampler, whose type is known from its index alone. `memory`: where it was made.
template <class F> struct PackSampler {
    void (*make)(std::byte* memory, const ShadingPoint<F>& point);
    /// Draws; the density may be a part of it, which is above 0 if it is.
    void (*draw)(const std::byte* memory, Vec3<F> wo, Vec2<F> u, DrawnByAny<F>& out);
    /// The density of a drawn direction where it may be only a part; null: it never is.
    F (*whole_pdf)(const std::byte* memory, Vec2<F> u, MaskOf<F> where);
    /// The density of a direction of another sampler. Lanes outside of `where` may have any value.
    F (*pdf)(const std::byte* memory, Vec3<F> wo, const DrawnByAny<F>& draw, MaskOf<F> where);
};

template <class F, class A> const A& sampler_at(const std::byte* memory) {
    return *std::launder(reinterpret_cast<const A*>(memory));
}

template <class F, class A> void make_sampler(std::byte* memory, const ShadingPoint<F>& point) {
    ::new (static_cast<void*>(memory)) A(point);
}
template <class F, class A>
[[gnu::noinline]] void draw_direction(const std::byte* memory, Vec3<F> wo, Vec2<F> u, DrawnByAny<F>& out) {
    const A& arm = sampler_at<F, A>(memory);
    const auto take = [&](const auto& draw) {
        out.wi = draw.wi;
        out.pdf = draw.pdf;
        out.disk = number<F>(-1);
        out.meets_light = no_lane<F>();
        out.texel = UintOf<F>(no_texel);
        out.triangle = UintOf<F>(no_triangle);
        if constexpr (requires { draw.meets_light; }) {
            out.disk = draw.disk;
            out.meets_light = draw.meets_light;
        }
        if constexpr (requires { draw.texel; }) out.texel = draw.texel;
        if constexpr (requires { draw.triangle; }) out.triangle = draw.triangle;
    };
    if constexpr (requires { arm.sample_part(u); }) take(arm.sample_part(u));
    else take(arm.sample(wo, u));
}
template <class F, class A> [[gnu::noinline]] F whole_density(const std::byte* memory, Vec2<F> u, MaskOf<F> where) {
    return sampler_at<F, A>(memory).whole_pdf(u, where).v;
}
template <class F, class A>
[[gnu::noinline]] F density_of(const std::byte* memory, Vec3<F> wo, const DrawnByAny<F>& draw, MaskOf<F> where) {
    const A& arm = sampler_at<F, A>(memory);
    if constexpr (requires { arm.pdf_where(draw, where); }) return arm.pdf_where(draw, where).v;
    else return arm.pdf(wo, draw.wi).v;
}

template <class F, class A> constexpr PackSampler<F> pack_sampler() {
    if constexpr (requires { A::techniques; }) {
        return {};
    } else {
        PackSampler<F> out = {make_sampler<F, A>, draw_direction<F, A>, nullptr, density_of<F, A>};
        if constexpr (requires(const A& arm, Vec2<F> u) { arm.sample_part(u); }) out.whole_pdf = whole_density<F, A>;
        return out;
    }
}

template <class F> struct PackSamplers {
    template <template <class> class... A>
    static constexpr std::array<PackSampler<F>, sizeof...(A)> table(ArmList<A...>) {
        return {pack_sampler<F, A<F>>()...};
    }
    template <template <class> class... A> static constexpr std::size_t largest(ArmList<A...>) {
        std::size_t size = 0;
        ((size = sizeof(A<F>) > size ? sizeof(A<F>) : size), ...);
        return size;
    }
    static constexpr auto entries = table(Samplers{});
    static constexpr std::size_t size = (largest(Samplers{}) + 63) / 64 * 64;
};

/// What a direction is weighted by.
template <class F> struct WeightAndPdf {
    F weight, pdf;
};

template <class F> class CombinedArm {
public:
    static constexpr bool combines = true;
    static constexpr std::size_t lanes = Lanes<F>::count;
    using Form = CombinationCall::Form;

    CombinedArm(
        const CombinationCall& plan, const ShadingPoints& points, std::size_t index, const ShadingPoint<F>& point)
        : plan_(plan), points_(points), start_(index), wo_(point.wo) {
        for (std::size_t k = 0; k < plan_.samplers; ++k) sampler(k).make(place(k), point);
        if (plan_.form == Form::every) {
            for (std::size_t k = 0; k < plan_.samplers; ++k)
                for (double& lane : share_[k]) lane = static_cast<double>(plan_.repeats[k]);
            return;
        }
        double at_lane[most_parts];
        for (std::size_t l = 0; l < lanes; ++l) {
            plan_.shares(points_, start_ + l, at_lane);
            for (std::size_t k = 0; k < plan_.samplers; ++k) share_[k][l] = at_lane[k];
        }
    }

    /// Calls take(draw, weigh) for each direction of sample j and returns the sum of what it returns; weigh(where) is
    /// a WeightAndPdf. `u`: the first two random numbers of films.
    template <class Take> [[gnu::always_inline]] F sample(
        UintOf<F> pixel, std::uint64_t j, std::uint32_t seed, Vec2<F> u, Take&& take) const {
        DrawnByAny<F> draw;
        Indices choice;
        if (plan_.form != Form::every) {
            const Vec2<F> stretched = choose(plan_.numbers ? numbers(pixel, j, 0, seed) : u, choice);
            draw_chosen(stretched, choice, draw);
            return take(draw, [&](MaskOf<F> where) { return weigh(draw, stretched, choice, where); });
        }
        F x = number<F>(0);
        for (std::size_t k = 0; k < plan_.samplers; ++k)
            for (std::uint64_t repeat = 0; repeat < plan_.repeats[k]; ++repeat) {
                const bool first = k == 0 && repeat == 0;
                const Vec2<F> v = first && !plan_.numbers
                    ? u
                    : numbers(pixel, j, block_of(k, 0, static_cast<std::size_t>(repeat)), seed);
                for (std::size_t& lane : choice.index) lane = k;
                sampler(k).draw(place(k), wo_, v, draw);
                const F contribution = take(draw, [&](MaskOf<F> where) { return weigh(draw, v, choice, where); });
                x = first ? contribution : x + contribution;
            }
        return x;
    }

private:
    /// The sampler of each lane.
    struct Indices {
        std::size_t index[lanes];
        /// The lanes of sampler k.
        MaskOf<F> mask(std::size_t k) const {
            LaneArray<F> flags;
            for (std::size_t l = 0; l < lanes; ++l) flags.at[l] = index[l] == k ? 1.0f : 0.0f;
            return flags.pack() > number<F>(0);
        }
    };

    const PackSampler<F>& sampler(std::size_t k) const {
        return PackSamplers<F>::entries[static_cast<std::size_t>(plan_.sampler[k])];
    }
    std::byte* place(std::size_t k) { return memory_ + k * PackSamplers<F>::size; }
    const std::byte* place(std::size_t k) const { return memory_ + k * PackSamplers<F>::size; }

    Vec2<F> numbers(UintOf<F> pixel, std::uint64_t j, std::uint32_t block, std::uint32_t seed) const {
        if (!plan_.numbers) {
            const Vec4u<UintOf<F>> h = draws<UintOf<F>>(pixel, static_cast<std::uint32_t>(j >> 1), block, seed);
            return j & 1 ? Vec2<F>{unit_float<F>(h.z), unit_float<F>(h.w)}
                         : Vec2<F>{unit_float<F>(h.x), unit_float<F>(h.y)};
        }
        LaneArray<F> x, y;
        const LaneIntegers<F> pixels(pixel);
        plan_.read_numbers(pixels.at, lanes, j, block, x.at, y.at);
        return {x.pack(), y.pack()};
    }

    /// Chooses a sampler for each lane by u.x, and stretches that back to (0, 1).
    Vec2<F> choose(Vec2<F> u, Indices& choice) const {
        const LaneArray<F> numbers(u.x);
        LaneArray<F> out;
        for (std::size_t l = 0; l < lanes; ++l)
            out.at[l] = as_float(choose_part([&](std::size_t k) { return share_[k][l]; }, plan_.samplers,
                static_cast<double>(numbers.at[l]), choice.index[l]));
        return {out.pack(), u.y};
    }

    void draw_chosen(Vec2<F> u, const Indices& choice, DrawnByAny<F>& out) const {
        bool has_direction = false;
        for (std::size_t k = 0; k < plan_.samplers; ++k) {
            const auto is_chosen = choice.mask(k);
            if (!any(is_chosen)) continue;
            DrawnByAny<F> draw;
            sampler(k).draw(place(k), wo_, u, draw);
            if (!has_direction) {
                out = draw;
                has_direction = true;
            }
            out.wi = select_each(is_chosen, draw.wi, out.wi);
            out.pdf.v = select(is_chosen, draw.pdf.v, out.pdf.v);
            out.disk = select(is_chosen, draw.disk, out.disk);
            out.meets_light = (is_chosen & draw.meets_light) | (!is_chosen & out.meets_light);
            out.texel = select(is_chosen, draw.texel, out.texel);
            out.triangle = select(is_chosen, draw.triangle, out.triangle);
        }
    }

    [[gnu::noinline]] WeightAndPdf<F> weigh(
        const DrawnByAny<F>& draw, Vec2<F> u, const Indices& choice, MaskOf<F> where) const {
        float p[most_parts][lanes];
        F pdf = draw.pdf.v;
        const bool one_sampler = plan_.form == Form::every;
        for (std::size_t k = 0; k < plan_.samplers; ++k) {
            if (one_sampler ? k != choice.index[0] : !any(choice.mask(k))) continue;
            const auto is_chosen = one_sampler ? where : where & choice.mask(k);
            if (sampler(k).whole_pdf && any(is_chosen))
                pdf = select(is_chosen, sampler(k).whole_pdf(place(k), u, is_chosen), pdf);
        }
        for (std::size_t k = 0; k < plan_.samplers; ++k) {
            if (one_sampler && k == choice.index[0]) {
                store(pdf, p[k]);
                continue;
            }
            const MaskOf<F> is_chosen = one_sampler ? no_lane<F>() : choice.mask(k), others = where & !is_chosen;
            store(any(others) ? select(is_chosen, pdf, sampler(k).pdf(place(k), wo_, draw, others)) : pdf, p[k]);
        }
        LaneArray<F> weight;
        if (plan_.form == Form::mixture) {
            for (std::size_t l = 0; l < lanes; ++l) {
                double sum = 0;
                for (std::size_t k = 0; k < plan_.samplers; ++k) sum += share_[k][l] * static_cast<double>(p[k][l]);
                weight.at[l] = static_cast<float>(sum);
            }
            return {number<F>(1), weight.pack()};
        }
        double w[lanes], count[lanes];
        for (std::size_t l = 0; l < lanes; ++l) count[l] = share_[choice.index[l]][l];
        if (plan_.has_weights) ask_for_weights(draw, choice, where, p, w);
        else heuristic(choice, count, p, w);
        for (std::size_t l = 0; l < lanes; ++l) weight.at[l] = static_cast<float>(w[l] / count[l]);
        return {weight.pack(), pdf};
    }

    /// Relative to the own density: a large one does not overflow. As Combination::mis_weight().
    void heuristic(const Indices& choice, const double (&count)[lanes], const float (&p)[most_parts][lanes],
        double (&w)[lanes]) const {
        double density_of_drawn[lanes], sum[lanes], minimum[lanes];
        for (std::size_t l = 0; l < lanes; ++l) {
            density_of_drawn[l] = static_cast<double>(p[choice.index[l]][l]);
            sum[l] = 0;
            minimum[l] = 0;
        }
        for (std::size_t k = 0; k < plan_.samplers; ++k)
            for (std::size_t l = 0; l < lanes; ++l) {
                const double density = static_cast<double>(p[k][l]);
                const double ratio =
                    choice.index[l] == k ? 1 : share_[k][l] * density / (count[l] * density_of_drawn[l]);
                sum[l] += plan_.power ? ratio * ratio : ratio;
                minimum[l] = density >= minimum[l] || density < 0 ? minimum[l] : density;  // NaN if one is
                minimum[l] = density < 0 ? std::numeric_limits<double>::quiet_NaN() : minimum[l];
            }
        for (std::size_t l = 0; l < lanes; ++l) {
            w[l] = count[l] > 0 && density_of_drawn[l] > 0 ? 1 / sum[l] : 0;
            if (!(minimum[l] >= 0)) w[l] = std::numeric_limits<double>::quiet_NaN();
        }
    }

    void ask_for_weights(const DrawnByAny<F>& draw, const Indices& choice, MaskOf<F> where,
        const float (&p)[most_parts][lanes], double (&w)[lanes]) const {
        const LaneArray<F> cos(draw.wi.z), flags(select(where, number<F>(1), number<F>(0)));
        for (std::size_t l = 0; l < lanes; ++l) {
            double densities[most_parts];
            for (std::size_t k = 0; k < plan_.samplers; ++k) densities[k] = static_cast<double>(p[k][l]);
            w[l] = flags.at[l] > 0 ? plan_.weight(points_, start_ + l, choice.index[l], cos.at[l], densities) : 0;
        }
    }

    const CombinationCall& plan_;
    const ShadingPoints& points_;
    std::size_t start_;
    Vec3<F> wo_;
    double share_[most_parts][lanes];
    alignas(64) std::byte memory_[most_parts * PackSamplers<F>::size];
};

}  // namespace CRESCENT_ISA
}  // namespace crescent
