// The estimator for any number type: lanes are pixels, samples follow one another, one pass gives every sample count.
// kernel_<isa>.cpp includes it once for each instruction set, in that set's own namespace.
//
// Sums run in float over at most 16 samples (relative error < 1e-6) and in double after that. Blocks begin at multiples
// of 16 for all sample counts, so the result at a sample count does not depend on the other sample counts.
#pragma once

#include <concepts>

#include "math/simd/random.h"
#include "render/kernel_combination.h"
#include "render/kernel_surroundings.h"
#include "samplers/all.h"
#include "scene/lobes/all.h"

namespace crescent {
namespace CRESCENT_ISA {

inline constexpr std::uint64_t block_length = 16;

/// What a kernel needs from a scene's emitters other than the fill: room in its memory, the emitters as one pack of
/// pixels sees them, what a sample gathers from them on top of the fill, and totals in double.
template <class E, class F>
concept Emitters = std::constructible_from<E, const ShadingPoints&, std::size_t, typename E::Room&> &&
    std::constructible_from<typename E::Totals, typename E::Room&> &&
    requires(E emitters, const E& lights, ShadingPoint<F>& shading_point, typename E::Totals totals, Moments& out) {
        { lights.first() } -> std::same_as<typename E::First>;
        lights.show(shading_point);
        totals.take(emitters);
        totals.write(lights, out);
    };

/// The sums of one pack of pixels: those of the current block and those over all samples. Sums that only samples which
/// meet an emitter change are kept elsewhere, so that these can stay in registers.
template <class F> struct RunningSums {
    F g = number<F>(0), g_lobe = number<F>(0);
    F offset = number<F>(0), square = number<F>(0);  // sums of X - pivot and of its square
    F pivot = number<F>(
        0);  // the smaller of the first two X (outliers are large), then the mean of the first 16, 64, 256, ...
    F largest = number<F>(0);
    UintOf<F> horizon{0u}, bad{0u};
};

/// A pack's constants that every sample reads. Passed by value, so that they stay in registers: what `gather` can reach
/// must be loaded again after each call.
template <class E, class F> struct Constants {
    Vec3<F> wo;
    F fill_d, fill_s;
    UintOf<F> pixel;
    typename E::First first;
};

/// One pack of pixels: its emitters and the function that takes one sample.
template <class A, class L, class E, class F> struct Lane : E {
    static_assert(Emitters<E, F>);
    using U = UintOf<F>;
    using E::shading_points, E::start;
    ShadingPoint<F> shading_point;

    Lane(const ShadingPoints& points, std::size_t first, typename E::Room& room) : E(points, first, room) {
        shading_point = {load_lanes<F>(shading_points.wox, shading_points.woy, shading_points.woz, start),
            load_lanes<F>(shading_points.s, start), load_lanes<F>(shading_points.alpha, start),
            load_lanes<F>(shading_points.diffuse, start), load_lanes<F>(shading_points.rho_s, start)};
        shading_point.lobe_kind = static_cast<LobeKind>(shading_points.lobe);
        this->show(shading_point);
    }

    Constants<E, F> constants() const {
        return {shading_point.wo, load_lanes<F>(shading_points.fill_d, start),
            load_lanes<F>(shading_points.fill_s, start), load_lanes<F>(shading_points.pixel, start), this->first()};
    }

    /// Returns X of one drawn direction and adds its contribution to the sums.
    template <class D> [[gnu::always_inline]] F accumulate(
        RunningSums<F>& to, const Constants<E, F>& c, const L& brdf, const D& draw, F weight) {
        const F zero = number<F>(0);
        const F cos = draw.wi.z;
        auto is_below = cos <= zero;  // false for NaN, which must reach the sums and be counted
        if constexpr (requires { this->below_face(draw.wi); }) is_below = is_below | this->below_face(draw.wi);
        const auto can_contribute = !(is_below | (draw.pdf.v == zero));
        to.horizon = plus_one_where(is_below, to.horizon);
        const F g = select(can_contribute, weight * (cos / draw.pdf.v), zero);
        const F lobe = select(can_contribute, brdf(c.wo, draw.wi), zero);
        F x = g * c.fill_d;
        to.g = to.g + g;
        if constexpr (L::present) {
            to.g_lobe = to.g_lobe + g * lobe;
            x = g * (c.fill_d + lobe * c.fill_s);
        }
        return this->gather(c.first, draw, g, lobe, x, can_contribute);
    }

    /// The same for a direction whose weight and density are work: weigh(lanes) is called for those lanes where X may
    /// not be 0. `draw` receives the texel of the sky that it meets.
    template <class D, class Weigh>
    F accumulate_seen(RunningSums<F>& to, const Constants<E, F>& c, const L& brdf, D& draw, const Weigh& weigh) {
        const F zero = number<F>(0);
        const F cos = draw.wi.z;
        auto is_below = cos <= zero;
        if constexpr (requires { this->below_face(draw.wi); }) is_below = is_below | this->below_face(draw.wi);
        const auto can_contribute = !(is_below | (draw.pdf.v == zero));
        to.horizon = plus_one_where(is_below, to.horizon);
        if (!any(can_contribute)) return zero;
        const auto hit = this->look(draw, can_contribute);
        const auto counts = can_contribute &
            (hit.lit() | (c.fill_d > zero) | (c.fill_s > zero) | !(draw.pdf.v >= zero));  // NaN is counted
        F g = zero, lobe = zero;
        if (any(counts)) {
            if constexpr (requires { hit.texel; }) draw.texel = hit.texel.pack();
            const auto [weight, pdf] = weigh(counts);
            const auto contributes = counts & !(pdf == zero);
            g = select(contributes, weight * (cos / pdf), zero);
            lobe = select(contributes, brdf(c.wo, draw.wi), zero);
        }
        to.g = to.g + g;
        to.g_lobe = to.g_lobe + g * lobe;
        return this->add_seen(draw, hit, g, lobe, g * (c.fill_d + lobe * c.fill_s));
    }

    template <class First, class Second> struct TwoDirections {
        First a;
        Second b;
        F weight_a, weight_b;
    };

    /// Draws what a sample needs from its random numbers: its direction, or both of them with their weights. Samplers
    /// that draw later get the numbers themselves. `second`: the numbers of a second technique.
    [[gnu::always_inline]] auto draw(
        const Constants<E, F>& c, const A& arm, Vec2<F> u, [[maybe_unused]] const Vec2<F>& second) const {
        if constexpr (requires { A::many_directions; } || requires { A::combines; }) {
            return u;
        } else if constexpr (requires { A::techniques; }) {
            auto a = arm.template sample_technique<0>(c.wo, u);
            auto b = arm.template sample_technique<1>(c.wo, second);
            return TwoDirections<decltype(a), decltype(b)>{
                a, b, arm.template weight<0>(c.wo, a), arm.template weight<1>(c.wo, b)};
        } else {
            return arm.sample(c.wo, u);
        }
    }

    /// Takes one sample by what draw() returned.
    template <class D> [[gnu::always_inline]] void step(RunningSums<F>& to, const Constants<E, F>& c, const A& arm,
        const L& brdf, const D& draw, std::uint64_t j, const KernelCall& call) {
        F x;
        if constexpr (requires { A::many_directions; }) {
            x = accumulate(to, c, brdf, arm.next->draw, arm.next->weight);
            ++arm.next;
            for (std::size_t k = 1; k < arm.count; ++k, ++arm.next)
                x = x + accumulate(to, c, brdf, arm.next->draw, arm.next->weight);
        } else if constexpr (requires { A::combines; }) {
            x = arm.sample(c.pixel, j, call.seed, draw,
                [&](auto& direction, const auto& weigh) { return accumulate_seen(to, c, brdf, direction, weigh); });
        } else if constexpr (requires { A::techniques; }) {
            x = accumulate(to, c, brdf, draw.a, draw.weight_a);  // sums depend on the order
            x = x + accumulate(to, c, brdf, draw.b, draw.weight_b);
        } else {
            x = accumulate(to, c, brdf, draw, number<F>(1));
        }
        const F offset = x - to.pivot;
        to.offset = to.offset + offset;
        to.square = to.square + offset * offset;
        to.largest = larger(x, to.largest);
        // Only NaN, infinite and negative numbers have bits from 0x7f800000 up. -0, which is not negative, cannot arise
        // from the values of a shading point (shading_points.cpp).
        to.bad = plus_one_where(bits(x) > U(0x7f7fffffu), to.bad);
        if (call.samples) record_sample(x, call.samples, j, call.sample_counts.back());
    }

    void record_sample(F x, float* samples, std::uint64_t j, std::uint64_t n) const {
        float lanes[Lanes<F>::count];
        store(x, lanes);
        for (std::size_t l = 0; l < Lanes<F>::count && start + l < shading_points.count; ++l)
            samples[(start + l) * n + j] = lanes[l];
    }
};

/// Double totals of one pack.
template <class F> struct Totals {
    static constexpr std::size_t count = Lanes<F>::count;
    double g[count] = {}, g_lobe[count] = {}, offset[count] = {}, square[count] = {};

    /// Adds the block's sums and clears them.
    void take(RunningSums<F>& p) {
        add_lanes(p.g, g);
        add_lanes(p.g_lobe, g_lobe);
        add_lanes(p.offset, offset);
        add_lanes(p.square, square);
        p.g = p.g_lobe = p.offset = p.square = number<F>(0);
    }
    /// Moves the pivot of the second moment to the mean of the n samples so far. Requires that the block's sums are 0.
    [[gnu::noinline]] F turn(F old_pivot, double n) {
        float pivot[count];
        store(old_pivot, pivot);
        const double share = 1 / n;  // a power of two: exact
        for (std::size_t l = 0; l < count; ++l) {
            const float next = static_cast<float>(static_cast<double>(pivot[l]) + offset[l] * share);
            const double shift = static_cast<double>(next) - static_cast<double>(pivot[l]);
            square[l] += shift * (n * shift - 2 * offset[l]);
            offset[l] -= n * shift;
            pivot[l] = next;
        }
        return load_as<F>(pivot);
    }
    /// Writes the sum of (X - mean X)^2 over the n samples of the full blocks and of the partial one.
    void spread(const RunningSums<F>& p, double n, double* out) const {
        double first[count];
        add_lanes(p.offset, offset, first);
        add_lanes(p.square, square, out);
        for (std::size_t l = 0; l < count; ++l) {
            out[l] -= first[l] * first[l] / n;
            if (out[l] < 0) out[l] = 0;
        }
    }
};

template <class E, class F> [[gnu::noinline]] void write_sample_count(const E& emitters,
    const typename E::Totals& emitted, const RunningSums<F>& p, const Totals<F>& totals, std::uint64_t n,
    Moments& out) {
    const std::size_t index = emitters.start;
    add_lanes(p.g, totals.g, out.g.data() + index);
    add_lanes(p.g_lobe, totals.g_lobe, out.g_lobe.data() + index);
    totals.spread(p, static_cast<double>(n), out.spread.data() + index);
    emitted.write(emitters, out);
    store(p.largest, out.largest.data() + index);
    store(p.horizon, out.horizon.data() + index);
    store(p.bad, out.bad.data() + index);
}

/// Any lobe, chosen at each call. Where a sample takes rays through trees, the choice costs nothing next to them, and
/// one kernel for all lobes is compiled in a fifth of the time.
template <class F> struct AnyLobe {
    static constexpr bool present = true;
    int kind;  // -1: none
    F s, alpha;
    [[gnu::noinline]] F operator()(Vec3<F> wo, Vec3<F> wi) const {
        F out = number<F>(0);
        const auto among = [&]<template <class> class... L>(LobeList<L...>) {
            int k = 0;
            ((k++ == kind ? void(out = L<F>(s, alpha)(wo, wi)) : void()), ...);
        };
        among(Lobes{});
        return out;
    }
};

template <class L, class F> L lobe_of(const ShadingPoints& points, const ShadingPoint<F>& point) {
    if constexpr (requires { L{points.lobe, point.s, point.alpha}; }) return L{points.lobe, point.s, point.alpha};
    else return L(point.s, point.alpha);
}

/// Writes the random numbers of samples j to end, two each, from a block of their dimensions.
template <class F> CRESCENT_INLINE void draw_numbers(
    UintOf<F> pixel, std::uint32_t seed, std::uint32_t block, std::uint64_t j, std::uint64_t end, Vec2<F>* to) {
    using U = UintOf<F>;
    while (j < end) {
        const Vec4u<U> h = draws<U>(pixel, static_cast<std::uint32_t>(j >> 1), block, seed);
        if (!(j & 1)) {
            *to++ = {unit_float<F>(h.x), unit_float<F>(h.y)};
            if (++j == end) return;
        }
        *to++ = {unit_float<F>(h.z), unit_float<F>(h.w)};
        ++j;
    }
}

/// Runs one pack of pixels through all its samples; make(shading point) returns the sampler. A block's random numbers,
/// directions and sums each have a loop of their own: a whole sample is a longer chain of dependent operations than a
/// processor looks ahead, and the steps of a short loop overlap.
template <class A, class L, class E, class F, class Make>
void estimate_pack(const KernelCall& call, std::size_t index, typename E::Room& room, const Make& make) {
    Lane<A, L, E, F> lane(*call.shading_points, index, room);
    RunningSums<F> gathered;
    Totals<F> totals;
    typename E::Totals emitted(room);
    const A arm = make(lane.shading_point);
    const L brdf = lobe_of<L>(*call.shading_points, lane.shading_point);
    const Constants<E, F> c = lane.constants();
    const std::uint64_t n = call.sample_counts.back();
    std::size_t sample_count = 0;
    Vec2<F> u[block_length], second[block_length];
    decltype(lane.draw(c, arm, u[0], second[0])) draws[block_length];
    for (std::uint64_t j = 0; j < n;) {
        const std::uint64_t block_end = (j / block_length + 1) * block_length;
        const std::uint64_t end =
            block_end < call.sample_counts[sample_count] ? block_end : call.sample_counts[sample_count];
        draw_numbers(c.pixel, call.seed, 0, j, end, u);
        if constexpr (requires { A::techniques; }) draw_numbers(c.pixel, call.seed, 1, j, end, second);
        for (std::uint64_t k = 0; k < end - j; ++k) draws[k] = lane.draw(c, arm, u[k], second[k]);
        for (std::uint64_t k = 0; j < end; ++k, ++j) {
            lane.step(gathered, c, arm, brdf, draws[k], j, call);
            if (j == 0) {  // X - pivot is X because the pivot is 0
                gathered.pivot = gathered.offset;
                gathered.offset = gathered.square = number<F>(0);
            } else if (j == 1) {  // X_1 - X_0 is the sum so far; relative to the smaller of the two it is its size, and
                                  // the square is unchanged
                gathered.pivot = gathered.pivot + smaller(gathered.offset, number<F>(0));
                gathered.offset = abs(gathered.offset);
            }
        }
        if (j == block_end) {
            totals.take(gathered);
            emitted.take(lane);
            if (j < n && (j & (j - 1)) == 0 && (j & 0x5555555555555555u))
                gathered.pivot = totals.turn(gathered.pivot, static_cast<double>(j));
            if (j % 4096 == 0 && call.stop && call.stop->load(std::memory_order_relaxed)) return;
        }
        if (j == call.sample_counts[sample_count])
            write_sample_count<E>(lane, emitted, gathered, totals, j, call.out[sample_count++]);
    }
}

template <class A, class L, class E, class F> void estimate(const KernelCall& call) {
    typename E::Room room(*call.shading_points, call.memory);
    for (std::size_t index = 0; index < call.shading_points->count; index += Lanes<F>::count)
        estimate_pack<A, L, E, F>(
            call, index, room, [](const ShadingPoint<F>& shading_point) { return A(shading_point); });
}

template <class E, class F> void estimate_combined(const KernelCall& call, const CombinationCall& combination) {
    typename E::Room room(*call.shading_points, call.memory);
    for (std::size_t index = 0; index < call.shading_points->count; index += Lanes<F>::count) {
        if (call.stop && call.stop->load(std::memory_order_relaxed)) return;
        estimate_pack<CombinedArm<F>, AnyLobe<F>, E, F>(call, index, room, [&](const ShadingPoint<F>& shading_point) {
            return CombinedArm<F>(combination, *call.shading_points, index, shading_point);
        });
    }
}

/// The kernels of one sampler, [lobe + 1].
template <class F, template <class> class A, template <class> class... L>
constexpr std::array<Kernel, sizeof...(L) + 1> kernels_on(LobeList<L...>) {
    return {estimate<A<F>, NoLobe<F>, Lights<F>, F>, estimate<A<F>, L<F>, Lights<F>, F>...};
}
template <class F, template <class> class... A> constexpr KernelTable kernels_of(std::string_view isa, ArmList<A...>) {
    return {isa, {{kernels_on<F, A>(Lobes{})...}}, {{estimate<A<F>, AnyLobe<F>, Surrounded<F>, F>...}},
        {estimate_combined<Lights<F>, F>, estimate_combined<Surrounded<F>, F>}};
}

}  // namespace CRESCENT_ISA
}  // namespace crescent
