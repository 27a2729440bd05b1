// Tests other than the identity E[h(w)] = integral of h p: unusable numbers, corners of u and of w_o, and calls that
// must agree with each other (the same u twice, in other batches, without one of its numbers).
#include "check/decide/small_tests.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "check/constants.h"
#include "check/decide/curve.h"
#include "check/decide/jacobian.h"
#include "check/estimate/sampling_map.h"
#include "samplers/domains/sphere_chart.h"

namespace crescent::check {

std::optional<const char*> fault_of(const Draw& d, const Traits& traits) {
    if (std::isnan(d.pdf)) return "pdf is NaN";
    if (d.pdf < 0) return "pdf is negative";
    if (std::isinf(d.pdf)) return "pdf is infinite";
    if (std::isnan(d.wi.x + d.wi.y + d.wi.z))
        return traits.domain ? "A point is outside the domain" : "The direction is NaN";
    const bool has_finite_weight = !d.weight || std::isfinite(*d.weight + d.weights.x + d.weights.y + d.weights.z);
    if (d.pdf == 0 && d.delta == 0) {
        if (!has_finite_weight) return "pdf is 0 and the weight is not finite";
        return {};
    }
    if (!(d.delta >= 0 && d.delta <= 1)) return "A delta part is chosen with a probability outside (0, 1]";
    if (d.delta > 0 && !d.weight) return "A draw of a delta part comes without its weight";
    if (!(std::fabs(std::sqrt(dot(d.wi, d.wi)) - 1) <= unit_length)) return "The direction is not of length 1";
    if (!d.weight) return {};
    if (!has_finite_weight) return "The weight is not finite";
    if (std::min({*d.weight, d.weights.x, d.weights.y, d.weights.z}) < -negative_weight)
        return "The weight is negative";
    return {};
}

namespace {

std::vector<PrimarySample> corner_numbers(int count) {
    constexpr double ends[] = {0, ulp, 0.25, 0.5, 0.75, 1 - ulp}, interior = 95.0 / 256;
    const int n = std::max(count, 2);
    PrimarySample middle;
    for (int k = 0; k < n; ++k) middle[k] = interior;
    std::vector<PrimarySample> out;
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j)
            for (double x : ends)
                for (double y : ends) {
                    out.push_back(middle);
                    out.back()[i] = x;
                    out.back()[j] = y;
                }
    for (int bits = 0; n > 2 && bits < 1 << n; ++bits) {
        out.push_back(middle);
        for (int k = 0; k < n; ++k) out.back()[k] = bits >> k & 1 ? 1 - ulp : 0;
    }
    return out;
}

std::vector<PrimarySample> some_numbers(const Source& source, StreamKey key, std::uint32_t count) {
    const std::vector<PrimarySample> u = first_numbers(key, count, source.traits);
    return u;
}

/// Whether two numbers are equal to `same_number`. What is not finite is a fault of its own, and equal to itself.
bool same_to(double a, double b) {
    if (!std::isfinite(a) || !std::isfinite(b)) return std::isnan(a) ? std::isnan(b) : a == b;
    return std::fabs(a - b) <= same_number * std::max(std::fabs(a), std::fabs(b));
}

/// Whether two draws are equal to the rounding of a text format of seven digits, including pdf and weight unless they
/// are random estimates.
bool same_draw(const Draw& a, const Draw& b, bool is_random = false) {
    constexpr double tolerance = 1e-6;
    if ((a.pdf > 0) != (b.pdf > 0) || (a.delta != 0) != (b.delta != 0)) return false;
    if (!(a.pdf > 0) && a.delta == 0) return true;
    const auto is_near = [](double x, double y) {
        return std::isfinite(x) && std::isfinite(y) ? std::fabs(x - y) <= tolerance : same_to(x, y);
    };
    return is_near(a.wi.x, b.wi.x) && is_near(a.wi.y, b.wi.y) && is_near(a.wi.z, b.wi.z) &&
        (is_random || (same_to(a.pdf, b.pdf) && same_to(a.weight.value_or(0), b.weight.value_or(0))));
}

/// Whether rounding explains that p at w is once a and once b: p over a few roundings of w has as wide a range. Next to
/// w_i = -w_o, for example, the half vector is a difference of nearly equal numbers.
bool differ_by_rounding(Source& source, Vec3d w, double a, double b) {
    if (!source.has_density() || !std::isfinite(a + b + w.x + w.y + w.z)) return false;
    std::vector<Vec3d> directions = of_other_lengths(source, w);
    for (const Vec3d v : neighbours(w)) directions.push_back(v);
    std::vector<double> p(directions.size());
    source.stated_pdf(directions, p);
    std::erase_if(p, [](double v) { return !std::isfinite(v); });
    if (p.empty()) return false;
    const auto [low, high] = std::ranges::minmax(p);
    return std::min(a, b) >= low * (1 - same_number) && std::max(a, b) <= high * (1 + same_number);
}

}  // namespace

std::optional<SmallFault> rows_of_file(const Source& source) {
    const RecordedSampler* file = source.recorded();
    if (!file) return {};
    SmallFault out{Family::values, 0, static_cast<double>(file->rows())};
    for (std::size_t i = 0; i < file->rows(); ++i) {
        const Draw& d = file->row(i);
        std::optional<const char*> fault = fault_of(d, source.traits);
        if (!fault && d.f && !(std::isfinite(*d.f) && *d.f >= 0)) fault = "f is not a number >= 0";
        if (fault && out.times++ == 0) {
            out.first = {.u = file->row_numbers(i), .draw = d, .p = 0, .expected = 0};
            out.what = *fault;
            out.place = file->place(i);
        }
    }
    return out.times > 0 ? std::optional(out) : std::nullopt;
}

std::optional<SmallFault> corners_of_u(Source& source) {
    if (!source.declaration.can_draw) return {};
    const std::vector<PrimarySample> u = corner_numbers(source.traits.numbers);
    const std::vector<Draw> draws = source.draw(u);
    SmallFault out{Family::corners, 0, static_cast<double>(u.size())};
    for (std::size_t i = 0; i < u.size(); ++i) {
        std::optional<const char*> fault = fault_of(draws[i], source.traits);
        double p = 0;
        if (!fault && draws[i].pdf > 0) {
            source.stated_pdf({&draws[i].wi, 1}, {&p, 1});
            if (!std::isfinite(p) || p < 0) fault = "pdf(w) there is not a number >= 0";
        }
        if (fault && out.times++ == 0) {
            out.first = {.u = u[i], .draw = draws[i], .p = p, .expected = 0};
            out.what = *fault;
        }
    }
    return out.times > 0 ? std::optional(out) : std::nullopt;
}

namespace {

/// Calls in blocks of 1, 2, 3, ... 64 rows.
constexpr std::size_t rows_in_blocks = 64 * 65 / 2;
template <class Call> void in_blocks(const Call& call) {
    for (std::size_t first = 0, block = 1; first < rows_in_blocks; first += block++) call(first, block);
}

}  // namespace

std::optional<SmallFault> same_u_again(Source& source, const StreamKey& key) {
    if (source.traits.own_random || !source.declaration.can_draw) return {};
    const std::vector<PrimarySample> u = some_numbers(source, key, rows_in_blocks);
    const std::vector<Draw> draws = source.draw(u);
    std::vector<Draw> block_draws(u.size());
    in_blocks([&](std::size_t first, std::size_t n) {
        source.draw(std::span(u).subspan(first, n), std::span(block_draws).subspan(first, n));
    });
    std::vector<Draw> reversed_draws = source.draw(std::vector(u.rbegin(), u.rend()));
    std::reverse(reversed_draws.begin(), reversed_draws.end());
    SmallFault out{Family::state, 0, static_cast<double>(u.size())};
    const bool is_random = source.estimates || source.f_estimates;
    const auto are_same = [&](const Draw& a, const Draw& b) {
        if (same_draw(a, b, is_random)) return true;
        Draw adjusted_draw = b;  // the weight is f cos / pdf
        adjusted_draw.pdf = a.pdf;
        adjusted_draw.weight = a.weight;
        return same_draw(a, adjusted_draw) && a.delta == 0 && a.pdf > 0 && b.pdf > 0 &&
            differ_by_rounding(source, a.wi, a.pdf, b.pdf);
    };
    for (std::size_t i = 0; i < u.size(); ++i)
        if (!are_same(draws[i], block_draws[i]) || !are_same(draws[i], reversed_draws[i]))
            if (out.times++ == 0) {
                out.first = {.u = u[i], .draw = draws[i], .p = 0, .expected = 0};
                out.what = "The same u gives another draw";
            }
    return out.times > 0 ? std::optional(out) : std::nullopt;
}

std::optional<SmallFault> same_answers_again(Source& source, const StreamKey& key) {
    if (!source.declaration.can_draw) return {};
    const std::vector<PrimarySample> u = some_numbers(source, key, rows_in_blocks);
    const std::vector<Draw> draws = source.draw(u);
    constexpr double golden = 2.399963229728653;  // radians
    std::vector<Vec3d> w;
    for (std::size_t i = 0; i < u.size(); ++i) {
        const double k = static_cast<double>(i), n = static_cast<double>(u.size());
        const Vec3d wi = draws[i].wi;
        const bool is_usable = draws[i].pdf > 0 && std::isfinite(wi.x + wi.y + wi.z);
        w.push_back(is_usable ? wi : from_chart({2 * (k + 0.5) / n, std::fmod(golden * k, two_pi)}));
    }
    SmallFault out{Family::state, 0, static_cast<double>(u.size())};
    const auto compare = [&](auto evaluate, auto differ, const char* what) {
        using Value = std::decay_t<decltype(evaluate.value)>;
        std::vector<Value> answers(w.size()), block_answers(w.size());
        evaluate(w, answers);
        in_blocks([&](std::size_t first, std::size_t n) {
            evaluate(std::span(w).subspan(first, n), std::span(block_answers).subspan(first, n));
        });
        for (std::size_t i = 0; i < w.size(); ++i)
            if (differ(w[i], answers[i], block_answers[i]) && out.times++ == 0) {
                out.first.u = u[i];
                out.first.draw.wi = w[i];
                out.what = what;
            }
    };
    struct Pdf {
        Source& source;
        double value = 0;
        void operator()(std::span<const Vec3d> wi, std::span<double> to) const { source.stated_pdf(wi, to); }
    };
    struct F {
        Source& source;
        Vec3d value{};
        void operator()(std::span<const Vec3d> wi, std::span<Vec3d> to) const { source.f_cos(wi, to); }
    };
    if (source.has_density() && !source.estimates)
        compare(
            Pdf{source},
            [&](Vec3d direction, double a, double b) {
                return !same_to(a, b) && !differ_by_rounding(source, direction, a, b);
            },
            "pdf(w) gives another answer in a block of another size");
    if (source.has_f() && !source.f_estimates)
        compare(
            F{source},
            [](Vec3d, Vec3d a, Vec3d b) { return !same_to(a.x, b.x) || !same_to(a.y, b.y) || !same_to(a.z, b.z); },
            "f(w) gives another answer in a block of another size");
    return out.times > 0 ? std::optional(out) : std::nullopt;
}

std::vector<int> numbers_without_effect(Source& source, const StreamKey& key) {
    std::vector<int> out;
    if (source.traits.own_random || !source.declaration.can_draw) return out;
    const std::vector<PrimarySample> u = some_numbers(source, key, 64);
    const std::vector<Draw> draws = source.draw(u);
    for (int k = 0; k < source.traits.numbers; ++k) {
        std::vector<PrimarySample> v = u;
        for (std::size_t i = 0; i < v.size(); ++i) v[i][k] = u[(i + 1) % u.size()][k];
        const std::vector<Draw> others = source.draw(v);
        bool has_no_effect = true;
        for (std::size_t i = 0; i < v.size(); ++i) has_no_effect = has_no_effect && same_draw(draws[i], others[i]);
        if (has_no_effect) out.push_back(k);
    }
    return out;
}

std::optional<SmallFault> few_bits(Source& source, const StreamKey& key) {
    // With more than two numbers, one may choose a texel and others the place in it.
    if (source.traits.numbers > 2 || source.traits.own_random || !source.declaration.can_draw) return {};
    const std::vector<PrimarySample> u = some_numbers(source, key, 64);
    const std::vector<Draw> draws = source.draw(u);
    for (int k = 0; k < source.traits.numbers; ++k) {
        const std::vector<Draw> far_draws = source.draw(moved(u, k, 0x1p-10)),
                                near_draws = source.draw(moved(u, k, 0x1p-11)),
                                nearest_draws = source.draw(moved(u, k, few_bits_step));
        SmallFault out{.family = Family::repeats, .what = "Only the first bits of a random number move the draw"};
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double a = chord(draws[i], far_draws[i]), b = chord(draws[i], near_draws[i]);
            const bool is_smooth = b > 0 && a > 1.5 * b && a < 3 * b && a < no_chord;
            if (!is_smooth || a * few_bits_step / 0x1p-10 < few_bits_move) continue;
            ++out.trials;
            if (chord(draws[i], nearest_draws[i]) == 0 && out.times++ == 0) {
                out.first = {.u = u[i], .draw = draws[i], .p = 0, .expected = 0};
                out.size = k;
            }
        }
        if (out.trials >= 16 && out.times > few_bits_share * out.trials) return out;
    }
    return {};
}

std::vector<SmallFault> small_tests(Source& source, const StreamKey& base_key) {
    StreamKey key = base_key;
    std::vector<SmallFault> out;
    const auto add = [&](std::optional<SmallFault> fault) {
        if (fault) out.push_back(*fault);
    };
    add(rows_of_file(source));
    add(corners_of_u(source));
    key.purpose = Purpose::corners;
    add(same_u_again(source, key));
    add(same_answers_again(source, key));
    add(few_bits(source, key));
    add(draws_on_curve(source, key));
    key.purpose = Purpose::jacobian;
    if (!source.estimates) add(jacobian(source, key));
    return out;
}

}  // namespace crescent::check
