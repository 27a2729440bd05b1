// Candidate causes over domains other than directions. A move of the points, such as an exchange of two coordinates,
// gives the supposed density p(move(x)) times the change of measure.
#include "check/explain/domain_causes.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

#include "check/explain/constants.h"
#include "check/explain/factors.h"
#include "math/functions.h"

namespace crescent::check {

namespace {

using Kind = DomainPart::Kind;
using Move = std::function<void(std::span<double>)>;
using Coordinates = std::array<double, Domain::most_coordinates>;

constexpr std::array symbols = {"x", "y", "z"};
constexpr double golden = 0.6180339887498949;

/// Returns coordinate c of the point of a direction.
double coordinate(const DomainChart& chart, Vec3d w, std::size_t c) {
    Coordinates x{};
    chart.point(w, std::span(x).first(chart.domain().coordinates()));
    return x[c];
}

/// Sets `out` to the density of points whose images by `move` have the density p. change: of the measure by it.
void moved_density(const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out,
    const Move& move, double change) {
    const std::shared_ptr<const DomainChart> chart = s.traits().domain;
    const std::size_t count = chart->domain().coordinates();
    constexpr std::array<double, Domain::most_dimensions + 1> middle = {0.5, 0.5, 0.5, 0.5, 0.5};
    std::vector<Pair> images(pairs.begin(), pairs.end());
    std::vector<double> factor(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        Coordinates x{}, image_coordinates{};
        const std::span<double> point = std::span(x).first(count);
        factor[i] = change * chart->point(pairs[i].wi, point);
        move(point);
        if (!chart->domain().fault(point).empty()) {
            factor[i] = 0;
            continue;
        }
        images[i].wi = chart->direction(point, std::span(middle).first(chart->spreads()));
        const double image = chart->point(images[i].wi, std::span(image_coordinates).first(count));
        factor[i] = image > 0 ? factor[i] / image : 0;
    }
    s.exact_pdf(technique, images, out);
    for (std::size_t i = 0; i < pairs.size(); ++i) out[i] *= factor[i];
}

/// The same with 0 where p is 0 and draws there count as no samples.
Hypothesis by_moving(std::string name, Move move, double change, bool counts_zero) {
    Hypothesis h;
    h.name = std::move(name);
    h.density = [move = std::move(move), change, counts_zero](
                    const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out) {
        moved_density(s, technique, pairs, out, move, change);
        if (counts_zero) return;
        std::vector<double> p(pairs.size());
        s.exact_pdf(technique, pairs, p);
        for (std::size_t i = 0; i < p.size(); ++i)
            if (!(p[i] > 0)) out[i] = 0;
    };
    return h;
}

/// The entry beside entry i taken for entry i, and the last one (first, for -1) for itself: what a search does that
/// ends one place off, cut off at the end of its table.
Hypothesis by_next_entry(std::size_t c, double count, int shift, bool counts_zero) {
    const Move undo_shift = [=](std::span<double> x) { x[c] -= shift; };  // the entry that this one is drawn for
    Hypothesis h = by_moving(fmt::format("entry i {} 1 taken for entry i, but for the {} (off by one)",
                                 shift > 0 ? '+' : '-', shift > 0 ? "last" : "first"),
        undo_shift, 1, counts_zero);
    const double end = shift > 0 ? count - 1 : 0;  // drawn for itself and for the entry before it
    h.density = [=, density = std::move(h.density)](
                    const SamplerAdapter& s, int technique, std::span<const Pair> pairs, std::span<double> out) {
        density(s, technique, pairs, out);
        std::vector<double> p(pairs.size());
        s.exact_pdf(technique, pairs, p);
        for (std::size_t i = 0; i < pairs.size(); ++i)
            if (coordinate(*s.traits().domain, pairs[i].wi, c) == end) out[i] += p[i];
    };
    return h;
}

struct NamedMove {
    std::string name;
    Move move;
};

void add_exchange(std::vector<NamedMove>& to, std::string name, std::size_t i, std::size_t j) {
    to.push_back({std::move(name), [=](std::span<double> x) { std::swap(x[i], x[j]); }});
}
/// name: of the coordinate.
void add_reflection(std::vector<NamedMove>& to, const std::string& name, std::size_t i, double sum) {
    to.push_back({fmt::format("{0} mirrored: {0} -> {1}{0}", name, sum == 0 ? "-" : fmt::format("{:g} - ", sum)),
        [=](std::span<double> x) { x[i] = sum - x[i]; }});
}

/// Moves of one part that keep its measure; c: its first coordinate.
void add_moves(std::vector<NamedMove>& to, const DomainPart& part, std::size_t c) {
    const auto coordinate = [](std::size_t i) { return std::string(symbols[i]); };
    switch (part.kind) {
        case Kind::disk:
        case Kind::square:
        case Kind::cube:
            for (std::size_t i = 0; i < part.coordinates(); ++i) {
                for (std::size_t j = i + 1; j < part.coordinates(); ++j)
                    add_exchange(
                        to, "the coordinates " + coordinate(i) + " and " + coordinate(j) + " exchanged", c + i, c + j);
                add_reflection(to, coordinate(i), c + i, part.kind == Kind::disk ? 0 : 1);
            }
            break;
        case Kind::triangle:
            add_exchange(to, "b0 and b1 exchanged", c, c + 1);
            to.push_back({"b0 and b2 exchanged", [c](std::span<double> b) { b[c] = 1 - b[c] - b[c + 1]; }});
            to.push_back({"b1 and b2 exchanged", [c](std::span<double> b) { b[c + 1] = 1 - b[c] - b[c + 1]; }});
            break;
        case Kind::line:
            if (std::isfinite(part.from) == std::isfinite(part.to))
                add_reflection(to, "x", c, std::isfinite(part.to) ? part.from + part.to : 0);
            break;
        case Kind::set:
            for (const int shift : {1, -1})
                to.push_back({fmt::format("entry i {} 1 taken for entry i (off by one)", shift > 0 ? '+' : '-'),
                    [=, count = static_cast<double>(part.count)](
                        std::span<double> x) { x[c] = std::fmod(x[c] - shift + count, count); }});
            to.push_back({"the entries in reverse order",
                [=, last = part.count - 1.0](std::span<double> x) { x[c] = last - x[c]; }});
            break;
        default: break;
    }
}

std::vector<NamedMove> moves_of(const Domain& domain) {
    std::vector<NamedMove> out;
    std::size_t c = 0;
    for (const DomainPart& part : domain.parts()) {
        add_moves(out, part, c);
        c += part.coordinates();
    }
    return out;
}

/// A factor that is a function of the point.
Factor factor_of_point(const std::shared_ptr<const DomainChart>& chart, std::string name,
    std::function<double(std::span<const double>)> value, bool any_exponent = false) {
    Factor out;
    out.name = std::move(name);
    out.any_exponent = any_exponent;
    out.value = [chart, value = std::move(value)](Vec3d, Vec3d wi) {
        Coordinates x{};
        chart->point(wi, std::span(x).first(chart->domain().coordinates()));
        const double v = value(x);
        return std::isfinite(v) ? v : 0;
    };
    return out;
}

/// "x - 2", "x + 3" or "x".
std::string difference(double from) {
    return from == 0 ? "x" : fmt::format("x {} {:g}", from > 0 ? '-' : '+', std::fabs(from));
}

}  // namespace

std::vector<Factor> domain_factors(const std::shared_ptr<const DomainChart>& chart) {
    std::vector<Factor> out;
    const auto add = [&](std::string name, auto value) {
        out.push_back(factor_of_point(chart, std::move(name), std::move(value)));
    };
    using Point = std::span<const double>;
    std::size_t c = 0;
    for (const DomainPart& part : chart->domain().parts()) {
        switch (part.kind) {
            case Kind::sphere:
            case Kind::hemisphere:
                add("cos theta", [c](Point x) { return std::fabs(x[c + 2]); });
                add("sin theta", [c](Point x) { return math::hypot(x[c], x[c + 1]); });
                break;
            case Kind::disk: add("the radius r", [c](Point x) { return math::hypot(x[c], x[c + 1]); }); break;
            case Kind::square:
            case Kind::cube:
                for (std::size_t i = 0; i < part.coordinates(); ++i) {
                    add(symbols[i], [=](Point x) { return x[c + i]; });
                    add(fmt::format("1 - {}", symbols[i]), [=](Point x) { return 1 - x[c + i]; });
                }
                break;
            case Kind::triangle:
                add("b0", [c](Point b) { return b[c]; });
                add("1 - b0", [c](Point b) { return 1 - b[c]; });
                add("b1", [c](Point b) { return b[c + 1]; });
                add("1 - b1", [c](Point b) { return 1 - b[c + 1]; });
                break;
            case Kind::line:
                if (std::isfinite(part.from))
                    add(difference(part.from), [c, from = part.from](Point x) { return x[c] - from; });
                if (std::isfinite(part.to))
                    add(fmt::format("{:g} - x", part.to), [c, to = part.to](Point x) { return to - x[c]; });
                break;
            case Kind::set: break;
        }
        c += part.coordinates();
    }
    return out;
}

namespace {

/// Two entries of a set exchanged: those that are drawn most too often and most too rarely.
std::optional<NamedMove> exchanged_entries(const Place& place) {
    const DomainChart& chart = *place.traits.domain;
    constexpr std::uint32_t most_entries = 4096;  // each is evaluated
    const std::uint32_t entries = chart.domain().parts()[0].count;
    if (chart.domain().parts().size() != 1 || entries < 2 || entries > most_entries) return {};
    std::vector<Vec3d> w;
    constexpr std::array<double, 2> middle = {0.5, 0.5};
    for (std::uint32_t k = 0; k < entries; ++k) {
        const double entry = k;
        w.push_back(chart.direction(std::span(&entry, 1), std::span(middle).first(chart.spreads())));
    }
    std::vector<double> p(entries), draw_counts(entries), deviation(entries);
    place.source().density(w, p);
    for (std::uint32_t k = 0; k < entries; ++k) p[k] = chart.density(w[k], p[k]);
    for (const Vec3d& d : place.w) ++draw_counts[static_cast<std::size_t>(coordinate(chart, d, 0))];
    for (std::uint32_t k = 0; k < entries; ++k)
        deviation[k] = (draw_counts[k] - place.draw_count * p[k]) / std::sqrt(place.draw_count * p[k] + 1);
    const auto [low, high] = std::ranges::minmax_element(deviation);
    if (*low > -clear_entries || *high < clear_entries) return {};
    const double a = static_cast<double>(std::min(low, high) - deviation.begin()),
                 b = static_cast<double>(std::max(low, high) - deviation.begin());
    return NamedMove{fmt::format("entries {} and {} exchanged", a, b), [a, b](std::span<double> x) {
                         x[0] = x[0] == a ? b : x[0] == b ? a : x[0];
                     }};
}

}  // namespace

std::vector<Hypothesis> domain_frames(std::span<const Place> places) {
    const Domain& domain = places[0].traits.domain->domain();
    std::vector<NamedMove> moves = moves_of(domain);
    if (domain.parts()[0].kind == Kind::set)
        if (auto exchange = exchanged_entries(places[0])) moves.push_back(std::move(*exchange));
    std::vector<Hypothesis> hypotheses;
    for (NamedMove& move : moves)
        hypotheses.push_back(by_moving(std::move(move.name), std::move(move.move), 1, places[0].draws_at_zero()));
    std::size_t c = 0;
    for (const DomainPart& part : domain.parts()) {
        for (const int shift : {1, -1})
            if (part.kind == Kind::set && part.count > 1)
                hypotheses.push_back(by_next_entry(c, part.count, shift, places[0].draws_at_zero()));
        c += part.coordinates();
    }
    std::vector<Hypothesis> out;
    for (Hypothesis& h : hypotheses) {
        h.place = static_cast<int>(out.size());
        score(h, places);
        if (h.helps()) out.push_back(std::move(h));
    }
    return out;
}

// ---- The shares of the entries of a set beside other parts: the chance of a lobe, of a light. If the draws within an
// entry follow p, their density is a p there, and E[1 / (p + q)] over them is a times the integral of p / (p + q).

std::optional<EntryShares> entry_shares(std::span<const Place> places) {
    constexpr std::uint32_t most_entries = 16;
    const DomainChart& chart = *places[0].traits.domain;
    const Domain& domain = chart.domain();
    std::size_t c = 0;
    const DomainPart* set = nullptr;
    for (const DomainPart& part : domain.parts()) {
        if (part.kind == Kind::set) {
            set = &part;
            break;
        }
        c += part.coordinates();
    }
    if (!set || domain.parts().size() < 2 || set->count < 2 || set->count > most_entries) return {};
    const Place& place = places[0];
    const auto entry_of = [&](Vec3d w) { return static_cast<std::size_t>(coordinate(chart, w, c)); };
    constexpr double bridge = 1 / (2 * two_pi);  // q, 1/sr: that of even directions
    std::vector<double> drawn_sums(set->count), claimed_sums(set->count), counts(set->count);
    for (std::size_t i = 0; i < place.w.size(); ++i) {
        const std::size_t k = entry_of(place.w[i]);
        drawn_sums[k] += 1 / (place.p[i] + bridge);
        ++counts[k];
    }
    const auto points = static_cast<std::uint32_t>(place.w.size());
    std::vector<Vec3d> directions;
    for (std::uint32_t i = 0; i < points; ++i)
        directions.push_back(from_chart({2 * (i + 0.5) / points, two_pi * std::fmod(i * golden, 1)}));
    std::erase_if(directions, [&](Vec3d w) { return !chart.has_point(w); });
    std::vector<double> p(directions.size());
    place.source().density(directions, p);
    for (std::size_t i = 0; i < directions.size(); ++i) claimed_sums[entry_of(directions[i])] += p[i] / (p[i] + bridge);
    EntryShares out;
    std::vector<double> ratios;
    for (std::size_t k = 0; k < set->count; ++k) {
        const double a = drawn_sums[k] / place.draw_count, b = claimed_sums[k] * 2 * two_pi / points;
        ratios.push_back(b > 0 ? a / b : 0);
        const double share = counts[k] / place.draw_count;
        out.shares.push_back(
            {share, ratios[k] > 0 ? share / ratios[k] : 0, std::sqrt(share * (1 - share) / place.draw_count)});
    }
    out.hypothesis.name = "other shares of the entries";
    out.hypothesis.density = [ratios, c](const SamplerAdapter& s, int technique, std::span<const Pair> pairs,
                                 std::span<double> to) {
        s.exact_pdf(technique, pairs, to);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto k = static_cast<std::size_t>(coordinate(*s.traits().domain, pairs[i].wi, c));
            to[i] *= k < ratios.size() ? ratios[k] : 0;  // a direction beyond the last entry belongs to no point
        }
    };
    score(out.hypothesis, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

// ---- A parameter of a move, by the likelihood of the draws: a coarse search, then golden sections.

namespace {

/// A hypothesis for each value of one number, and the values that are tried.
struct MoveFamily {
    std::function<Hypothesis(double)> hypothesis_at;
    double from, to;
};

double mean_log_of(const Hypothesis& h, std::span<const Place> places, std::size_t most_draws) {
    double out = 0;
    for (const Place& place : places) {
        std::vector<Pair> pairs;
        for (std::size_t i = 0; i < std::min(most_draws, place.w.size()); ++i)
            pairs.push_back({place.check_case->wo, place.w[i]});
        std::vector<double> p(pairs.size());
        h.density(place.adapter(), place.technique(), pairs, p);
        out += place.mean_log(p) / static_cast<double>(places.size());
    }
    return out;
}

std::optional<FittedMove> fitted_move(const MoveFamily& family, std::span<const Place> places) {
    constexpr int steps = 40;
    constexpr std::size_t coarse_count = 512, full_count = 1u << 20;
    const double step = (family.to - family.from) / steps;
    double best_log = -1e300, value = 0;
    for (int k = 0; k <= steps; ++k) {
        const double x = family.from + k * step, l = mean_log_of(family.hypothesis_at(x), places, coarse_count);
        if (l > best_log) {
            best_log = l;
            value = x;
        }
    }
    double low = value - step, high = value + step;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double log_a = mean_log_of(family.hypothesis_at(a), places, full_count),
           log_b = mean_log_of(family.hypothesis_at(b), places, full_count);
    for (int k = 0; k < 16; ++k) {
        if (log_a > log_b) {
            high = b;
            b = a;
            log_b = log_a;
            log_a = mean_log_of(family.hypothesis_at(a = high - golden * (high - low)), places, full_count);
        } else {
            low = a;
            a = b;
            log_a = log_b;
            log_b = mean_log_of(family.hypothesis_at(b = low + golden * (high - low)), places, full_count);
        }
    }
    FittedMove out;
    out.value = (low + high) / 2;
    const double offset = step / 4, peak = mean_log_of(family.hypothesis_at(out.value), places, full_count);
    const double bend = (2 * peak - mean_log_of(family.hypothesis_at(out.value - offset), places, full_count) -
                            mean_log_of(family.hypothesis_at(out.value + offset), places, full_count)) /
        (offset * offset);
    double draws = 0;
    for (const Place& place : places) draws += static_cast<double>(place.w.size());
    out.error = bend > 0 ? 1 / std::sqrt(bend * draws) : step;
    out.hypothesis = family.hypothesis_at(out.value);
    score(out.hypothesis, places);
    return out.hypothesis.helps() ? std::optional(out) : std::nullopt;
}

}  // namespace

std::vector<FittedMove> domain_moves(std::span<const Place> places) {
    std::vector<FittedMove> out;
    const bool counts_zero = places[0].draws_at_zero();
    std::size_t c = 0;
    for (const DomainPart& part : places[0].traits.domain->domain().parts()) {
        if (part.is_infinite()) {
            const double end = std::isfinite(part.from) ? part.from : std::isfinite(part.to) ? part.to : 0;
            const auto hypothesis_at = [=](double log_scale) {
                const double factor = math::exp(-log_scale);
                return by_moving(
                    "scaled", [=](std::span<double> x) { x[c] = end + factor * (x[c] - end); }, factor, counts_zero);
            };
            if (auto move = fitted_move({hypothesis_at, -1.5, 1.5}, places)) {
                move->error *= math::exp(move->value);
                move->value = math::exp(move->value);
                move->factor = "scale";
                move->coordinate = difference(end);
                move->neutral_value = 1;
                out.push_back(std::move(*move));
            }
        }
        c += part.coordinates();
    }
    return out;
}

}  // namespace crescent::check
