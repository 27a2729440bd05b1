// Kinds of warnings are listed in the order in which they were added.
#include "compare/file_warnings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

#include "math/statistics.h"

namespace crescent {

void FileWarnings::add(
    const std::string& file, const std::string& text, std::uint64_t pixels, const std::string& kind) {
    const std::string& key = kind.empty() ? text : kind;
    auto entry = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& k) { return k.kind == key; });
    if (entry == kinds_.end()) entry = kinds_.insert(kinds_.end(), {key, file, text, 0, pixels, pixels});
    ++entry->files;
    entry->fewest_pixels = std::min(entry->fewest_pixels, pixels);
    entry->most_pixels = std::max(entry->most_pixels, pixels);
}

std::vector<std::string> FileWarnings::lines() const {
    std::vector<std::string> out;
    for (const Kind& k : kinds_) out.push_back(k.line());
    return out;
}

std::string FileWarnings::line(const std::string& kind) const {
    const auto entry = std::ranges::find(kinds_, kind, &Kind::kind);
    return entry == kinds_.end() ? "" : entry->line();
}

std::string FileWarnings::Kind::line() const {
    const std::string name = files > 1 ? fmt::format("{} (the first of {} files)", file, files) : file;
    const std::string pixels = most_pixels == 0 ? ""
        : fewest_pixels == most_pixels          ? fmt::format("{} pixel{} ", most_pixels, most_pixels == 1 ? "" : "s")
                                                : fmt::format("{} to {} pixels ", fewest_pixels, most_pixels);
    return fmt::format("{}: {}{}", name, pixels, text);
}

// ---- Counts come from the first pass (each pixel over renders) and the second pass (groups in each render and
// region). A failing sample affects one pixel, or as many as its filter covers: groups count such events, which are
// independent although the pixels are not.

namespace {

constexpr std::size_t named_places = 3;  // pixels that are listed

/// Counts connected components of pixels in ascending order: each joins its left neighbour and the three of the row
/// before.
class Groups {
public:
    explicit Groups(int width) : width_(width) {}
    std::uint32_t count(const std::vector<std::uint32_t>& pixels) {
        parent_.resize(pixels.size());
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
        std::uint32_t groups = 0;
        for (std::size_t k = 0; k < pixels.size(); ++k) {
            ++groups;
            const auto x = static_cast<int>(pixels[k] % static_cast<std::uint32_t>(width_));
            for (const int step : {1, width_ - 1, width_, width_ + 1}) {
                const int column = step == 1 || step == width_ + 1 ? x - 1 : step == width_ ? x : x + 1;
                if (column < 0 || column >= width_ || pixels[k] < static_cast<std::uint32_t>(step)) continue;
                const auto neighbour =
                    std::lower_bound(pixels.begin(), pixels.end(), pixels[k] - static_cast<std::uint32_t>(step));
                if (neighbour == pixels.end() || *neighbour != pixels[k] - static_cast<std::uint32_t>(step)) continue;
                groups -= join(k, static_cast<std::size_t>(neighbour - pixels.begin()));
            }
        }
        return groups;
    }

private:
    std::size_t root(std::size_t k) {
        while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
        return k;
    }
    bool join(std::size_t k, std::size_t other) {
        const std::size_t a = root(k), b = root(other);
        parent_[a] = b;
        return a != b;
    }
    int width_;
    std::vector<std::size_t> parent_;
};

std::uint32_t failures(const ArmStats& arm, std::uint32_t pixel) {
    return arm.not_finite.empty() ? 0 : arm.not_finite[pixel];
}

/// The counts of one pixel on both sides.
struct Counts {
    std::uint32_t a = 0, b = 0;
};

class NonFiniteTest {
public:
    NonFiniteTest(const RenderStats& stats, const ArmStats& a, const ArmStats& b)
        : stats_(stats), a_(a), b_(b), na_(a.files.size()), nb_(b.files.size()) {}

    NonFinite result(double alpha) {
        for (const std::uint32_t i : stats_.regions.back().left_out)
            if (failures(a_, i) + failures(b_, i) > 0) failing_.push_back(i);
        if (failing_.empty()) return {};
        differs_.assign(failing_.size(), false);
        groups(alpha / 2);
        pixels(alpha / 2);
        collect();
        return std::move(out_);
    }

private:
    Counts counts(std::uint32_t i) const { return {failures(a_, i), failures(b_, i)}; }
    bool more_in_a(const Counts& c) const { return c.a * nb_ > c.b * na_; }
    bool more_in_b(const Counts& c) const { return c.a * nb_ < c.b * na_; }

    void pixels(double alpha) {
        std::vector<double> p;
        for (std::size_t k = 0; k < failing_.size(); ++k) {
            const Counts c = counts(failing_[k]);
            p.push_back(fisher_exact(c.a, na_, c.b, nb_));
            if ((c.a == na_ && c.b == 0) || (c.b == nb_ && c.a == 0)) {
                differs_[k] = true;
                out_.p = 0;
            }
        }
        const std::vector<bool> rejections = discoveries(p, alpha, false);
        for (std::size_t k = 0; k < p.size(); ++k)
            if (rejections[k]) differs_[k] = true;
        std::sort(p.begin(), p.end());
        out_.p = std::min(out_.p, 2 * simes_p(p, static_cast<double>(p.size()), false));
    }

    void groups(double alpha) {
        const auto sum = [](const ArmStats& arm, std::size_t region) {
            std::uint64_t out = 0;
            for (const auto& render : arm.failed_groups) out += render[region];
            return out;
        };
        std::vector<double> p;
        const double share = static_cast<double>(na_) / static_cast<double>(na_ + nb_);
        for (std::size_t r = 0; r < stats_.regions.size(); ++r) {
            FailedGroups g{
                .region = stats_.regions[r].name, .a = sum(a_, r), .b = sum(b_, r), .p = 1, .differs = false};
            g.p = binomial_exact(g.a, g.a + g.b, share);
            p.push_back(g.p);
            out_.groups.push_back(g);
        }
        const std::vector<bool> rejections = holm(p, alpha);
        out_.p = std::min(out_.p, 2 * static_cast<double>(p.size()) * *std::min_element(p.begin(), p.end()));
        for (std::size_t r = 0; r < p.size(); ++r) {
            FailedGroups& g = out_.groups[r];
            g.differs = rejections[r];
            const bool is_more_in_a = g.a * nb_ > g.b * na_;
            for (const std::uint32_t i : stats_.regions[r].left_out) {
                const Counts c = counts(i);
                if (!g.differs || !(is_more_in_a ? more_in_a(c) : more_in_b(c))) continue;
                differs_[static_cast<std::size_t>(
                    std::lower_bound(failing_.begin(), failing_.end(), i) - failing_.begin())] = true;
            }
        }
    }

    static void put(FailingPixels& to, std::uint32_t pixel, std::uint32_t renders, std::uint32_t other_renders) {
        const bool is_first = to.pixels.empty();
        to.pixels.push_back(pixel);
        to.least_renders = is_first ? renders : std::min(to.least_renders, renders);
        to.most_renders = std::max(to.most_renders, renders);
        to.least_other_renders = is_first ? other_renders : std::min(to.least_other_renders, other_renders);
        to.most_other_renders = std::max(to.most_other_renders, other_renders);
    }

    void collect() {
        for (std::size_t k = 0; k < failing_.size(); ++k) {
            const Counts c = counts(failing_[k]);
            if (!differs_[k]) {
                ++(c.a > 0 && c.b > 0 ? out_.two_sided : out_.one_sided);
                out_.undecided += (c.a == 0 && 2 * c.b >= nb_) || (c.b == 0 && 2 * c.a >= na_);
            } else if (more_in_a(c)) put(out_.a, failing_[k], c.a, c.b);
            else put(out_.b, failing_[k], c.b, c.a);
        }
    }

    const RenderStats& stats_;
    const ArmStats &a_, &b_;
    const std::size_t na_, nb_;
    std::vector<std::uint32_t> failing_;  // pixels that fail in some render of either side, ascending
    std::vector<bool> differs_;           // one per failing pixel
    NonFinite out_;
};

}  // namespace

std::uint32_t touching_groups(const std::vector<std::uint32_t>& pixels, int width) {
    return Groups(width).count(pixels);
}

std::vector<std::uint32_t> failed_groups(const Render& render, const RenderStats& stats) {
    std::vector<std::uint32_t> out;
    for (const PixelSet& set : stats.regions) {
        std::vector<std::uint32_t> bad;
        std::copy_if(set.left_out.begin(), set.left_out.end(), std::back_inserter(bad),
            [&](std::uint32_t i) { return !render.is_finite(i); });
        out.push_back(touching_groups(bad, stats.width));
    }
    return out;
}

NonFinite compare_non_finite(const RenderStats& stats, const ArmStats& a, const ArmStats& b, double alpha) {
    return NonFiniteTest(stats, a, b).result(alpha);
}

std::string places_of(const FailingPixels& failing, int width) {
    const auto x = [&](std::uint32_t i) { return static_cast<int>(i) % width; };
    const auto y = [&](std::uint32_t i) { return static_cast<int>(i) / width; };
    std::vector<std::string> first;
    Box box{x(failing.pixels[0]), y(failing.pixels[0]), 0, y(failing.pixels.back())};
    for (const std::uint32_t i : failing.pixels) {
        if (first.size() < named_places) first.push_back(fmt::format("({}, {})", x(i), y(i)));
        box.x0 = std::min(box.x0, x(i));
        box.x1 = std::max(box.x1, x(i));
    }
    std::string out = fmt::format("{}", fmt::join(first, ", "));
    if (failing.pixels.size() > first.size())
        out += fmt::format(", ... within x {}–{} y {}–{}", box.x0, box.x1, box.y0, box.y1);
    return out;
}

}  // namespace crescent
