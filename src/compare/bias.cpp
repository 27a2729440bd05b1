// Do two sets of renders have the same expectation? Welch's t-test over renders, per region, tile and pixel, after
// Jung, Hanika & Dachsbacher 2020, "Detecting Bias in Monte Carlo Renderers using Welch's t-test", JCGT 9(2); with the
// chance of a false alarm shared out: half to the regions (Holm), a quarter each to tiles and pixels (false
// discoveries).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge.h"
#include "compare/pixel_tests.h"
#include "compare/sides.h"
#include "pages/numbers.h"

namespace crescent::inline comparing {

namespace {

using Values = std::vector<double>;

constexpr double lone_pixel = 0.5;     // a tile whose spread is half one pixel of one render is not judged by a t-test
constexpr std::size_t named_most = 5;  // places that are named

template <class Read> Values over(const ArmReadings& arm, Read read) {
    Values out;
    for (std::size_t k = 0; k < arm.files.size(); ++k) out.push_back(read(arm, k));
    return out;
}

std::string why_not(const Sides& sides, std::size_t region) {
    if (sides.a.files.size() < 2 || (sides.other && sides.b.files.size() < 2))
        return "two renders or more of each arm are needed";
    if (!sides.pairs.empty() && sides.pairs.size() < 2) return "two pairs or more are needed";
    for (const ArmResult* arm : {&sides.arm, sides.other}) {
        if (!arm || !arm->regions[region].mean_heavy()) continue;
        const auto& needed = arm->regions[region].renders_needed;
        return "heavy tail: " + arm->name +
            (needed ? fmt::format(", from about {:.0f} renders on it could be said", *needed)
                    : ", and from how many renders on it could be said is not known");
    }
    return "";
}

MeanTest region_test(const Sides& sides, std::size_t r, double level) {
    const auto read = [&](const ArmReadings& arm, std::size_t k) { return arm.regions[k][r].y; };
    const Values a = over(sides.a, read), b = over(sides.b, read);
    const PixelSet& set = sides.all.regions[r];
    MeanTest t;
    t.region = set.name, t.a = mean_interval(a, confidence).mean, t.b = mean_interval(b, confidence).mean;
    t.why = why_not(sides, r);
    if (!t.why.empty()) return t;
    const SetNoise noise = sides.noise_of(set);
    t.welch = sides.test(a, b, noise, false);
    const double unseen = std::max(sides.unseen(1, noise.pixels, level), sides.unseen(-1, noise.pixels, level));
    t.smallest = std::max(detectable(t.welch, level), unseen) / std::max(std::fabs(t.b), 1e-300);
    return t;
}

/// p is small, and events no brighter than some render's or than the files' bound could have been missed.
std::string doubted(const Sides& sides, const MeanTest& t, double pixels, double level) {
    const auto events = sides.needed({{}, t.a, t.b, t.welch.p}, pixels, level);
    if (!events) return {};
    return fmt::format(
        "heavy tail: {} is darker by {}, which events brighter than {} in one of {:.0f} pixels could make up that none "
        "of its renders met",
        events->arm, percent(std::fabs(t.a - t.b) / std::max(t.a, t.b), 2), figures(events->size, 2), events->one_in);
}

void test_regions(const Sides& sides, double alpha, BiasResult& out) {
    const double level = alpha / static_cast<double>(sides.all.regions.size());
    Values p;
    for (std::size_t r = 0; r < sides.all.regions.size(); ++r) {
        out.regions.push_back(region_test(sides, r, level));
        p.push_back(out.regions.back().why.empty() ? out.regions.back().welch.p : std::nan(""));
    }
    const std::vector<bool> differs = holm(p, alpha);
    for (std::size_t r = 0; r < p.size(); ++r) {
        MeanTest& t = out.regions[r];
        if (!differs[r]) continue;
        const SetNoise noise = sides.noise_of(sides.all.regions[r]);
        const double d = t.a - t.b;
        t.differs = std::fabs(d) >= sides.blind(t.a, t.b, noise.pixels, noise.a + noise.b, level);
        if (std::fabs(d) < sides.unseen(d, noise.pixels, level)) t.doubt = doubted(sides, t, noise.pixels, level);
    }
}

bool alone(const ArmReadings& arm, std::size_t tile) {
    double sum = 0, largest = 0;
    for (const auto& render : arm.tiles) sum += render[tile].spread, largest = std::max(largest, render[tile].largest);
    return sum > 0 && largest > lone_pixel * sum;
}

void test_tile(const Sides& sides, std::size_t t, double level, PlaceTests& out) {
    const auto read = [&](const ArmReadings& arm, std::size_t k) { return arm.tiles[k][t].y; };
    const Values a = over(sides.a, read), b = over(sides.b, read);
    if (!std::isfinite(a[0]) || !std::isfinite(b[0])) return;  // no finite pixel
    const SetNoise noise = sides.noise_of(sides.all.tiles.box(t, sides.all.width, sides.all.height));
    const double d = out.difference[t] = mean_interval(a, confidence).mean - mean_interval(b, confidence).mean;
    if (alone(sides.a, t) || (sides.other && alone(sides.b, t))) {
        ++out.left_out;
        return;
    }
    const Welch w = sides.test(a, b, noise, true);
    if (w.se == 0 && d == 0) return;  // the same constant on both sides
    out.p[t] = std::fabs(d) < sides.blind(noise.mean_a, noise.mean_b, noise.pixels, noise.a + noise.b, level) ? 1 : w.p;
    ++out.tested;
}

void test_tiles(const Sides& sides, double alpha, BiasResult& result) {
    PlaceTests& out = result.tiles;
    const std::size_t count = sides.all.tiles.count();
    out.p.assign(count, std::nan("")), out.difference.assign(count, std::nan(""));
    for (std::size_t t = 0; t < count; ++t) test_tile(sides, t, alpha / static_cast<double>(count), out);
    out.differs = discoveries(out.p, alpha, sides.dependent);
    std::vector<std::size_t> found;
    for (std::size_t t = 0; t < count; ++t)
        if (out.differs[t]) found.push_back(t);
    out.different = found.size();
    std::sort(found.begin(), found.end(),
        [&](std::size_t s, std::size_t t) { return out.p[s] != out.p[t] ? out.p[s] < out.p[t] : s < t; });
    for (std::size_t k = 0; k < std::min(found.size(), named_most); ++k) {
        const Box box = sides.all.tiles.box(found[k], sides.all.width, sides.all.height);
        const SetNoise mean = sides.noise_of(box);
        result.tiles_found.push_back({box, mean.mean_a, mean.mean_b, out.p[found[k]]});
    }
}

}  // namespace

bool CompareResult::differs() const {
    return std::any_of(bias.begin(), bias.end(), [](const BiasResult& b) { return b.differs(); });
}

bool BiasResult::differs() const {
    return tiles.different > 0 || pixels_different > 0 ||
        std::any_of(regions.begin(), regions.end(), [](const MeanTest& t) { return t.differs; });
}

std::string reference_error_from(const ArmReadings& reference) {
    if (reference.files.size() > 1) return fmt::format("over its {} files", reference.files.size());
    if (!reference.film.told_variance.empty()) return "as the file says it: " + reference.files[0].variance_channels;
    return "one file that does not say it: taken from how its difference from the arms varies between neighbouring "
           "pixels";
}

std::optional<MissedEvents> missed_events(const Sides& sides, const BiasResult& found, double alpha) {
    std::optional<MissedEvents> hardest;
    const auto look = [&](const Found& place, double pixels, double level) {
        const auto events = sides.needed(place, pixels, level);
        if (events && (!hardest || events->size > hardest->size)) hardest = events;
    };
    for (std::size_t r = 0; r < found.regions.size(); ++r) {
        const MeanTest& t = found.regions[r];
        const double pixels = static_cast<double>(sides.all.regions[r].pixels.size());
        if (t.differs) look({{}, t.a, t.b, 0}, pixels, alpha / static_cast<double>(found.regions.size()));
    }
    for (const Found& tile : found.tiles_found)
        look(tile, sides.noise_of(tile.box).pixels, found.place_alpha / static_cast<double>(found.tiles.p.size()));
    for (const Found& pixel : found.pixels_found) look(pixel, 1, pixel_level(sides, found.place_alpha));
    return hardest;
}

BiasResult judge_bias(const ComparePlan& plan, const Readings& all, const CompareResult& measured, std::size_t a,
    std::size_t b, double alpha) {
    const Sides sides(plan, all, measured, a, b);
    BiasResult out;
    out.a = plan.arms[a].name, out.b = sides.referred ? the_reference : plan.arms[b].name;
    out.arm_a = a, out.arm_b = b, out.place_alpha = alpha / 4;
    out.paired = !sides.pairs.empty(), out.dependent = sides.dependent;
    if (sides.referred) out.reference_error = reference_error_from(sides.b);
    test_regions(sides, alpha / 2, out);
    if (sides.a.files.size() >= 2 && (sides.referred || sides.b.files.size() >= 2)) {
        test_tiles(sides, out.place_alpha, out);
        test_pixels(sides, out.place_alpha, out);
    }
    if (out.differs()) out.unless = missed_events(sides, out, alpha / 2);
    out.sentence = sentence_of(out, alpha / 2);
    return out;
}

}  // namespace crescent::inline comparing
