// What was found about means, in one sentence.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge.h"
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

std::string places(const std::vector<Found>& found, std::uint64_t all) {
    std::vector<std::string> out;
    for (const Found& f : found) out.push_back(fmt::format("{} ({})", place(f), relative(f.a, f.b)));
    return fmt::format("{}{}", fmt::join(out, ", "), all > found.size() ? " and more" : "");
}

std::vector<std::string> differences(const BiasResult& b) {
    std::vector<std::string> out;
    for (const MeanTest& t : b.regions)
        if (t.differs)
            out.push_back(fmt::format("mean Y in {} is {} where {} has {} ({}, p = {:.2g})", t.region, figures(t.a),
                b.b, figures(t.b), relative(t.a, t.b), t.welch.p));
    if (b.tiles.different)
        out.push_back(fmt::format(
            "{} of {} tiles differ: {}", b.tiles.different, b.tiles.tested, places(b.tiles_found, b.tiles.different)));
    if (b.pixels_different)
        out.push_back(fmt::format("{} of {} pixels differ: {}", b.pixels_different, b.pixels_tested,
            places(b.pixels_found, b.pixels_different)));
    return out;
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

std::string sentence_of(const BiasResult& b, double alpha) {
    if (b.differs())
        return fmt::format("{} differs from {}: {}.{}", b.a, b.b, fmt::join(differences(b), "; "), unless(b));
    std::vector<std::string> seen, not_seen;
    for (const MeanTest& t : b.regions) {
        if (!t.doubt.empty()) not_seen.push_back(fmt::format("{}: {}", t.region, t.doubt));
        else if (t.why.empty()) seen.push_back(fmt::format("{} in {}", percent(t.smallest, 2), t.region));
        else not_seen.push_back(fmt::format("{}: {}", t.region, t.why));
    }
    std::string out = seen.empty() ? fmt::format("{} and {} could not be compared", b.a, b.b)
                                   : fmt::format(
                                         "No difference between {} and {} was found; one of {} of mean Y would "
                                         "have been, nine times out of ten (alpha {})",
                                         b.a, b.b, fmt::join(seen, ", "), figures(alpha, 2));
    if (!not_seen.empty()) out += fmt::format("; not told: {}", fmt::join(not_seen, "; "));
    return out + ".";
}

std::vector<std::string> found_about_means(const CompareResult& result) {
    constexpr std::size_t few = 6;
    const auto quiet = [](const BiasResult& b) {
        return !b.differs() && std::all_of(b.regions.begin(), b.regions.end(), [](const MeanTest& t) {
            return t.why.empty() && t.doubt.empty();
        });
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
