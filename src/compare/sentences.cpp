// What was found about means, in one sentence.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge.h"
#include "compare/quantities.h"
#include "pages/numbers.h"

namespace crescent::inline comparing {

namespace {

std::string relative(double a, double b) {
    if (!(b > 0)) return fmt::format("{} beside {}", figures(a, 2), figures(b, 2));
    if (a / b >= 2) return fmt::format("{} times", figures(a / b, 2));
    return (a < b ? "−" : "+") + percent(std::fabs(a / b - 1), 2);
}

std::string place(const Found& f) {
    if (f.box.x0 == f.box.x1 && f.box.y0 == f.box.y1) return fmt::format("({}, {})", f.box.x0, f.box.y0);
    return fmt::format("x {}–{} y {}–{}", f.box.x0, f.box.x1, f.box.y0, f.box.y1);
}

/// "R " before what is said of a channel; nothing of Y.
std::string of_channel(std::size_t quantity) {
    return quantity == 0 ? "" : fmt::format("{} ", quantity_names[quantity]);
}

std::string places(const std::vector<Found>& found, std::uint64_t all) {
    std::vector<std::string> out;
    for (const Found& f : found)
        out.push_back(fmt::format("{} ({}{})", place(f), of_channel(f.quantity), relative(f.a, f.b)));
    return fmt::format("{}{}", fmt::join(out, ", "), all > found.size() ? " and more" : "");
}

/// " in R", or " (12 most in R, 4 in B)": in which quantity places differ the most, where it is not Y alone.
std::string by_quantity(const std::vector<std::uint64_t>& by) {
    std::vector<std::string> out;
    for (std::size_t q = 0; q < by.size(); ++q)
        if (by[q]) out.push_back(fmt::format("{} {}in {}", by[q], out.empty() ? "most " : "", quantity_names[q]));
    if (out.empty() || (out.size() == 1 && by[0])) return "";
    if (out.size() > 1) return fmt::format(" ({})", fmt::join(out, ", "));
    const auto q = std::find_if(by.begin(), by.end(), [](std::uint64_t n) { return n > 0; }) - by.begin();
    return fmt::format(" in {}", quantity_names[q]);
}

void mean_difference(const BiasResult& b, const std::string& region, const std::string& name, const MeanTest& t,
    std::vector<std::string>& out) {
    if (t.differs)
        out.push_back(fmt::format("mean {} in {} is {} where {} has {} ({}, p = {:.2g})", name, region, figures(t.a),
            b.b, figures(t.b), relative(t.a, t.b), t.welch.p));
}

std::vector<std::string> differences(const Readings& all, const BiasResult& b) {
    std::vector<std::string> out;
    if (b.non_finite.differs()) out.push_back(failing_pixels(all, b));
    for (const MeanTest& t : b.regions) {
        mean_difference(b, t.region, quantity_names[0], t, out);
        for (const MeanTest& channel : t.channels) mean_difference(b, t.region, channel.region, channel, out);
    }
    if (b.tiles.different)
        out.push_back(fmt::format("{} of {} tiles differ{}: {}", b.tiles.different, b.tiles.tested,
            by_quantity(b.tiles_by), places(b.tiles_found, b.tiles.different)));
    if (b.pixels_different)
        out.push_back(fmt::format("{} of {} pixels differ{}: {}", b.pixels_different, b.pixels_tested,
            by_quantity(b.pixels_by), places(b.pixels_found, b.pixels_different)));
    return out;
}

std::string counted(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string renders_of(std::uint32_t least, std::uint32_t most, std::size_t of) {
    if (most == 0) return "in none";
    if (least == of) return of == 1 ? "in its render" : fmt::format("in all {} renders", of);
    if (least == most) return fmt::format("in {} of {} renders", most, of);
    return fmt::format("in {} to {} of {} renders", least, most, of);
}

std::string failing(const FailingPixels& pixels, const std::string& name, std::size_t renders, const std::string& other,
    std::size_t other_renders, int width) {
    return fmt::format("{} of {} {} not finite {}, and {} of {}: {}", counted(pixels.pixels.size(), "pixel"), name,
        pixels.pixels.size() == 1 ? "is" : "are", renders_of(pixels.least, pixels.most, renders),
        renders_of(pixels.other_least, pixels.other_most, other_renders), other, places_of(pixels, width));
}

/// Pixels that are not finite and are no difference.
std::string excluded(const BiasResult& b) {
    std::string out;
    if (b.non_finite.both)
        out += fmt::format(" {} not finite on both sides {} left out.", counted(b.non_finite.both, "pixel"),
            b.non_finite.both == 1 ? "is" : "are");
    if (b.non_finite.one)
        out += fmt::format(" {} not finite on one side, in so few renders that the rates may be equal, {} left out.",
            counted(b.non_finite.one, "pixel"), b.non_finite.one == 1 ? "is" : "are");
    if (b.non_finite.undecided)
        out += fmt::format(
            " {} of those not finite in half of the renders of one side or more and in none of the other: whether the "
            "rates are equal, more renders would show.",
            b.non_finite.undecided == 1 ? "1 is" : fmt::format("{} are", b.non_finite.undecided));
    return out;
}

/// Renders that share their random numbers, and what was made of it.
std::string seeds(const BiasResult& b) {
    if (b.shared.empty()) return "";
    const auto smaller = [](const SeedPair& x, const SeedPair& y) { return x.correlation < y.correlation; };
    const auto [least, most] = std::minmax_element(b.shared.begin(), b.shared.end(), smaller);
    const std::string low = figures(least->correlation, 2), high = figures(most->correlation, 2);
    const std::string found = fmt::format(" {} of {} and {} share random numbers (their noise correlates by {}): ",
        b.all_shared ? "The renders" : counted(b.shared.size(), "pair") + " of renders", b.a, b.b,
        low == high ? low : low + " to " + high);
    if (b.paired && b.all_shared) return found + "they were compared in pairs.";
    if (b.paired) return found + "these were compared, in pairs.";
    return found + "a test of pairs would be no sharper, so all were compared as if independent.";
}

/// A t-test does not see events that no render met; how rare and bright they would have to be is for the reader to
/// judge.
std::string unless(const BiasResult& b) {
    if (!b.unless) return {};
    const std::string times =
        b.unless->of_mean > 0 ? fmt::format(", {} times its mean there,", figures(b.unless->of_mean, 2)) : "";
    return fmt::format(
        " Without a bias {} would have to meet events brighter than {}{} in fewer than one of {:.0f} "
        "pixels, none of which its renders met.",
        b.unless->arm, figures(b.unless->size, 2), times, std::max(1.0, b.unless->one_in));
}

}  // namespace

std::string failing_pixels(const Readings& all, const BiasResult& b) {
    const std::size_t renders_a = all.arms[b.arm_a].files.size(),
                      renders_b = (b.arm_b < all.arms.size() ? all.arms[b.arm_b] : *all.reference).files.size();
    std::vector<std::string> out;
    if (!b.non_finite.a.pixels.empty())
        out.push_back(failing(b.non_finite.a, b.a, renders_a, b.b, renders_b, all.width));
    if (!b.non_finite.b.pixels.empty())
        out.push_back(failing(b.non_finite.b, b.b, renders_b, b.a, renders_a, all.width));
    const bool everywhere = (b.non_finite.a.pixels.empty() || b.non_finite.a.least == renders_a) &&
        (b.non_finite.b.pixels.empty() || b.non_finite.b.least == renders_b);
    for (const FailedGroups& g : b.non_finite.groups)
        if (g.differs && !everywhere)
            out.push_back(
                fmt::format("in {} {} of such pixels over all renders of {} and {} over those of {} (p = {:.2g})",
                    g.region, counted(g.a, "group"), b.a, g.b, b.b, g.p));
    return fmt::format("{}", fmt::join(out, "; "));
}

namespace {

std::string smallest_seen(const MeanTest& t) {
    double channel = 0;
    for (const MeanTest& c : t.channels) channel = std::max(channel, c.why.empty() ? c.smallest : 0);
    return channel > 0
        ? fmt::format("{} of mean Y or {} of a channel in {}", percent(t.smallest, 2), percent(channel, 2), t.region)
        : fmt::format("{} of mean Y in {}", percent(t.smallest, 2), t.region);
}

std::string single(const BiasResult& b) {
    const SingleDifference& s = *b.single;
    return fmt::format(
        "{} and {} are one render each: {} of {} pixels differ, the RMS of the difference of Y is {}, the largest "
        "difference of a channel is {} at ({}, {}); whether that is noise cannot be said with fewer than two renders "
        "of each",
        b.a, b.b, s.different, s.pixels, figures(s.rms, 3), figures(s.largest, 3), s.at.x0, s.at.y0);
}

}  // namespace

std::string sentence_of(const Readings& all, const BiasResult& b, double alpha) {
    if (b.identical)
        return fmt::format("{} and {} are identical: the same pixels in every render.{}", b.a, b.b, excluded(b));
    const std::string notes = excluded(b) + seeds(b);
    if (b.differs())
        return fmt::format(
            "{} differs from {}: {}.{}{}", b.a, b.b, fmt::join(differences(all, b), "; "), unless(b), notes);
    if (b.single) return single(b) + "." + notes;
    std::vector<std::string> seen, not_seen;
    for (const MeanTest& t : b.regions) {
        if (!t.doubt.empty()) not_seen.push_back(fmt::format("{}: {}", t.region, t.doubt));
        else if (t.why.empty()) seen.push_back(smallest_seen(t));
        else not_seen.push_back(fmt::format("{}: {}", t.region, t.why));
        for (const MeanTest& c : t.channels)
            if (t.why.empty() && !c.why.empty())
                not_seen.push_back(fmt::format("{} in {}: {}", c.region, t.region, c.why));
    }
    std::string out = seen.empty() ? fmt::format("{} and {} could not be compared", b.a, b.b)
                                   : fmt::format(
                                         "No difference between {} and {} was found; one of {} would have been, "
                                         "nine times out of ten (alpha {})",
                                         b.a, b.b, fmt::join(seen, ", "), figures(alpha, 2));
    if (!not_seen.empty()) out += fmt::format("; not tested: {}", fmt::join(not_seen, "; "));
    return out + "." + notes;
}

std::vector<std::string> found_about_means(const CompareResult& result) {
    constexpr std::size_t few = 6;
    const auto quiet = [](const BiasResult& b) {
        return !b.differs() && !b.identical && !b.non_finite.any() && b.shared.empty() &&
            std::all_of(
                b.regions.begin(), b.regions.end(), [](const MeanTest& t) { return t.why.empty() && t.doubt.empty(); });
    };
    std::vector<std::string> out;
    std::size_t rest = 0;
    double smallest = 0;
    for (const BiasResult& b : result.bias) {
        if (result.bias.size() <= few || !quiet(b)) out.push_back(b.sentence);
        else ++rest, smallest = std::max(smallest, b.regions.back().smallest);
    }
    if (rest)
        out.push_back(
            fmt::format("In {} of {} pairs no difference was found; one of {} of mean Y in {} would have been in each "
                        "of them, nine "
                        "times out of ten.",
                rest, result.bias.size(), percent(smallest, 2), result.bias[0].regions.back().region));
    return out;
}

}  // namespace crescent::inline comparing
