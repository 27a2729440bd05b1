// Which renders of two arms were made with the same random numbers: those with the same number in their names, or with
// correlated residuals (shared_seeds.h); and the pictures of their differences.
#include "compare/pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "compare/second_pass.h"
#include "stats/hypotheses.h"

namespace crescent::inline comparing {

namespace {

/// Numbers of a file's name that are not the same in all files of its arm: what tells its render.
std::vector<std::uint64_t> own_numbers(const ArmReadings& arm, std::size_t file) {
    std::vector<std::uint64_t> out;
    const auto& own = arm.files[file].numbers;
    for (std::size_t i = 0; i < own.size(); ++i) {
        const bool varies = std::any_of(arm.files.begin(), arm.files.end(),
            [&](const RenderFile& f) { return f.numbers.size() != own.size() || f.numbers[i] != own[i]; });
        if (varies) out.push_back(own[i]);
    }
    return out.empty() ? own : out;
}

/// a less b, channel by channel.
Render difference(const Readings& all, Render a, const Render& b) {
    for (const Render* r : {&std::as_const(a), &b})
        if (r->width != all.width || r->height != all.height)
            throw InputError({r->file, 0, 0},
                fmt::format("expected {} x {} pixels as before, found {} x {}: the file has changed", all.width,
                    all.height, r->width, r->height));
    for (std::size_t i = 0; i < a.size(); ++i) a.r[i] -= b.r[i], a.g[i] -= b.g[i], a.b[i] -= b.b[i];
    a.variance.clear(), a.rounding = std::max(a.rounding, b.rounding);
    return a;
}

}  // namespace

std::vector<RenderPair> pairs_of(const ArmReadings& a, const ArmReadings& b) {
    std::vector<std::vector<std::uint64_t>> theirs;
    for (std::size_t j = 0; j < b.files.size(); ++j) theirs.push_back(own_numbers(b, j));
    std::vector<RenderPair> out;
    for (std::size_t i = 0; i < a.files.size(); ++i) {
        const std::vector<std::uint64_t> own = own_numbers(a, i);
        const auto found = std::count(theirs.begin(), theirs.end(), own);
        if (found != 1 || own.empty())
            throw InputError({a.files[i].path, 0, 0},
                own.empty()
                    ? "--pair: expected a number in its name"
                    : fmt::format(
                          "--pair: expected one render of the other arm with the number {} in its name, found {}",
                          fmt::join(own, ", "), found));
        out.emplace_back(i, static_cast<std::size_t>(std::find(theirs.begin(), theirs.end(), own) - theirs.begin()));
    }
    if (out.size() != b.files.size())
        throw InputError({b.files[0].path, 0, 0}, "--pair: expected as many renders of one arm as of the other");
    return out;
}

bool all_paired(const std::vector<SeedPair>& shared, const ArmReadings& a, const ArmReadings& b) {
    return !shared.empty() && shared.size() == a.files.size() && shared.size() == b.files.size();
}

bool sharper_in_pairs(const std::vector<SeedPair>& shared, const ArmReadings& a, const ArmReadings& b, double level) {
    if (shared.size() < 3) return false;
    const double k = static_cast<double>(shared.size()), na = static_cast<double>(a.files.size()),
                 nb = static_cast<double>(b.files.size());
    double left = 0;  // of the variance of a difference
    for (const SeedPair& p : shared) left += (1 - p.correlation) / k;
    const double paired = student_quantile(1 - level / 2, k - 1), apart = student_quantile(1 - level / 2, na + nb - 2);
    return 2 * left / k * paired * paired < (1 / na + 1 / nb) * apart * apart;
}

PairedRenders paired_renders(const ComparePlan& plan, const Readings& all, std::size_t a, std::size_t b,
    std::vector<RenderPair> pairs, ProgressMonitor& monitor) {
    const bool referred = b >= all.arms.size();
    const ArmReadings &first = all.arms[a], &second = referred ? *all.reference : all.arms[b];
    const std::string &layer = plan.arms[a].layer, &other_layer = referred ? plan.reference_layer : plan.arms[b].layer;
    PairedRenders out{std::move(pairs), {}};
    RenderSource source;
    source.read = [&](const std::string& path, const std::string&) {
        std::size_t k = 0;
        std::from_chars(path.data(), path.data() + path.size(), k);
        return difference(all, all.source.read(first.files[out.pairs[k].first].path, layer),
            all.source.read(second.files[out.pairs[k].second].path, other_layer));
    };
    std::vector<std::string> paths;
    for (std::size_t k = 0; k < out.pairs.size(); ++k)
        paths.push_back(std::to_string(k)), out.differences.files.push_back({paths.back(), {}, {}, {}, {}, {}, {}, {}});
    monitor.begin("differences of pairs", 2 * static_cast<double>(out.pairs.size()));
    each_render(source, paths, {}, monitor, [&](const Render& render) { out.differences.film.add(render); });
    second_pass(plan, all, source, out.differences, {}, nullptr, monitor);
    return out;
}

}  // namespace crescent::inline comparing
