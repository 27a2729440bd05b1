// One trial under way, as the verdicts see it: the layers that ask, draw, integrate and bin, made once and shared, and
// the two stages of every statistical test.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "judgements/verdict.h"
#include "trials/densities.h"

namespace crescent::inline warps {
struct WarpFinding;
struct Reached;
}  // namespace crescent::inline warps

namespace crescent::inline trials {

/// What is looked at once for several verdicts, by technique; filled by study_warp, preimages_of and the diagnosis.
struct LookedAtOnce {
    std::array<std::shared_ptr<const WarpFinding>, 2> warps;
    std::array<std::shared_ptr<const Reached>, 2> reached;
    std::array<std::vector<double>, 2> claimed;  // pdf(w) at the points of `warps`
};

class TrialContext : public Densities {
public:
    TrialContext(const Trial& trial, const TestSettings& settings, TestCounts& test_counts, std::uint32_t index)
        : Densities(trial, settings, index), test_counts(test_counts) {}
    TestCounts& test_counts;

    /// Fresh draws for another seed; bins and integrals of f stay.
    void redraw(std::uint32_t seed);

    Verdict verdict(std::string_view name, State state, std::string say) const;
    /// Both stages of a statistical test: p(round) is its p-value on that round's draws.
    template <class P> bool fails(double p_first, P&& p_of_round) const {
        ++test_counts.tests;
        if (!(p_first < settings.screen)) return false;
        ++test_counts.screened;
        if (!(p_of_round(1) < settings.confirm)) {
            note_unconfirmed(p_first);
            return false;
        }
        ++test_counts.confirmed;
        return true;
    }
    /// The p of a test that failed by both stages' level at once, and had fewer draws to confirm it than it began with:
    /// questions ran out. Of the verdict that is being made; 1 where there is none.
    double unconfirmed() const { return unconfirmed_; }
    void begin_verdict() { unconfirmed_ = 1; }

    mutable LookedAtOnce kept;
    std::vector<BinMap> maps;             // for the page
    std::vector<WeightPicture> pictures;  // likewise

private:
    mutable double unconfirmed_ = 1;
    void note_unconfirmed(double p_first) const;
};

}  // namespace crescent::inline trials
