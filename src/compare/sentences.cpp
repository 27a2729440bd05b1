// What was found about means, in one sentence.
#include <fmt/format.h>

#include <cmath>

#include "compare/judge.h"
#include "pages/numbers.h"

namespace crescent::inline comparing {

namespace {

std::string relative(double a, double b) {
    if (!(b > 0)) return fmt::format("{} beside {}", figures(a, 2), figures(b, 2));
    return a / b < 2 ? fmt::format("{:+.2g} %", 100 * (a / b - 1)) : fmt::format("{:.2g} times", a / b);
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

}  // namespace

std::string sentence_of(const BiasResult& b, double alpha) {
    if (b.differs()) return fmt::format("{} differs from {}: {}.", b.a, b.b, fmt::join(differences(b), "; "));
    std::vector<std::string> seen, not_seen;
    for (const MeanTest& t : b.regions) {
        if (t.why.empty()) seen.push_back(fmt::format("{} in {}", percent(t.smallest, 2), t.region));
        else not_seen.push_back(fmt::format("{}: {}", t.region, t.why));
    }
    std::string out = seen.empty() ? fmt::format("{} and {} could not be compared", b.a, b.b)
                                   : fmt::format(
                                         "No difference between {} and {} was found; one of {} of mean Y would "
                                         "have been, nine times out of ten (alpha {})",
                                         b.a, b.b, fmt::join(seen, ", "), figures(alpha, 2));
    if (!not_seen.empty()) out += fmt::format("; not tested: {}", fmt::join(not_seen, "; "));
    return out + ".";
}

}  // namespace crescent::inline comparing
