// One trial under way: its draws, how finely its directions are resolved, where it draws most, and its integrals, made
// once and shared by the verdicts.
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/progress_monitor.h"
#include "cubature/cubature.h"
#include "judgements/verdict.h"
#include "subjects/subject.h"
#include "trials/scatter.h"
#include "trials/settings.h"

namespace crescent::inline warps {
struct WarpFinding;
struct Reached;
}  // namespace crescent::inline warps

namespace crescent::inline trials {

/// Draws of one technique on one seed.
struct SampleBatch {
    std::vector<Numbers> u;
    std::vector<Draw> draws;
    std::vector<double> pdf;        // pdf(w) asked afterwards, as the sampler's own arithmetic says it
    mutable std::vector<double> f;  // f of every draw above the horizon, once asked for
    std::vector<std::pair<Vec2d, Draw>>
        dropped;  // draws that cannot be used, too few to matter; a neighbour stands in for each
    mutable std::vector<Vec3d> f_channels;   // the same by channel, where there are three
    mutable std::vector<Vec2d> coordinates;  // of the draws about the axis that was last asked for, {} of nothing drawn
    mutable std::optional<Vec3d> axis;
    std::uint64_t nothing = 0;  // pdf 0, or under the horizon where pdf(w) is 0; draws of delta parts among them
    std::uint64_t deltas = 0;   // draws of delta parts
};

/// No component is NaN or infinite.
inline bool is_finite(Vec3d w) { return std::isfinite(w.x + w.y + w.z); }

/// Nothing drawn as a density: pdf 0, or a direction under the horizon at which pdf(w) is 0.
inline bool is_null_sample(const Draw& d, double pdf_there) {
    return !(d.pdf > 0) || (d.wi.z <= 0 && !(pdf_there > 0));
}

/// The bins of one technique's density and their expected mass.
struct Density {
    SphereMap map{Vec3d{0, 0, 1}};
    bool about_n = true;
    std::vector<double> rings;  // ascending edges of a = 1 - cos, first 0, last 2
    int sectors = 0;
    Integral mass;
    std::optional<Integral> second;         // in other coordinates, where the first does not come to one
    std::vector<double> tabulation_errors;  // by bin, where p was tabulated; else empty
    double tabulation_error = 0;            // their sum
    double nothing = 0, nothing_se = 0;     // share of draws that draw nothing or a delta part, randomised lattice
    double delta = 0;                       // of these a delta part
    std::size_t bin_of(Vec2d at) const;
};

/// Light in directions whose weight X = f L cos / p is larger than any that was drawn; see unmet.cpp.
struct Unmet {
    double largest = 0, mean = 0;  // of the drawn weights
    double mass = 0, error = 0;    // int f L cos there
    double chance = 0;             // int p there: of one draw to meet it
    double variance = 0;           // of the weights up to the largest, by quadrature
    bool heavy = false;            // it explains what the mean lacks, and so many draws need not have met it
};

class TrialContext {
public:
    TrialContext(const Trial& trial, const TestSettings& settings, TestCounts& test_counts, std::uint32_t index);
    /// So many of the wanted questions as a limited sampler may still be asked here, `keep` of them left for later;
    /// 2000 at least.
    std::size_t affordable(std::size_t wanted, std::size_t keep = 0) const;

    const Trial& trial;
    const TestSettings& settings;
    TestCounts& test_counts;
    const JudgedSampler& subject;
    const Traits traits;

    /// A limited sampler is asked no more than its answers are worth: integrals are known to a fifth of what the tests
    /// grant.
    bool thrifty() const { return subject.limited() && !settings.full; }
    double tolerance() const { return thrifty() ? 2e-5 : 5e-6; }
    /// The error of a mass that is looked at no further.
    double enough() const { return thrifty() ? 8e-5 : 5e-5; }

    /// Fresh draws for another seed; bins and integrals stay.
    void redraw(std::uint32_t seed);
    SampleBatch draw(int technique, int round) const;  // round 0: the screening seed, 1: the confirming one
    const SampleBatch& first(int technique) const { return first_[static_cast<std::size_t>(technique)]; }
    const Density& density(int technique) const { return density_[static_cast<std::size_t>(technique)]; }
    /// Rounding of the directions that come back: 2^-24 for floats, 2^-50 for doubles, or that of short decimals.
    double direction_resolution() const { return direction_resolution_; }
    std::span<const Vec3d> pilot_directions() const { return pilot_directions_; }
    /// Whether pdf and f are random estimates, right in the mean alone.
    const Scatter& scatter() const { return scatter_; }
    /// By cubature, or by points at random where the integrand is made of estimates.
    Integral integral_of(std::vector<Rect> cells, int bins, const Batch& g, const Effort& effort, bool estimates,
        const SamplesPerBin* samples = nullptr) const;

    /// Under the surface: whether f is not 0 there, most at `at` of those tried, and whether the sampler reaches it.
    struct Below {
        bool transmits = false, reached = false;
        Vec3d at{};
        double f = 0;
    };
    const Below& below() const { return below_; }
    /// The whole sphere is judged, not its upper half alone.
    bool whole() const { return trial.wo.z < 0 || (below_.transmits && below_.reached); }
    /// Light from wi counts.
    bool counts(Vec3d wi) const { return wi.z > 0 || (wi.z < 0 && whole()); }
    /// Its draws have weights: f cos / p, or what the sampler itself says.
    bool weighs() const;
    /// Radiance from wi; the fill shines from below too where that counts.
    double light(Vec3d wi) const { return wi.z < 0 && whole() ? trial.light.fill : trial.light(wi); }

    /// f of every draw above the horizon, 0 elsewhere; asked once.
    const std::vector<double>& f_of_drawn(const SampleBatch& b) const;
    std::vector<double> pdf_of_drawn(int technique, std::span<const Draw> draws) const;
    /// Of every draw, {} where nothing was drawn; computed once an axis.
    const std::vector<Vec2d>& coordinates_of(const SampleBatch& b, const SphereMap& map) const;
    std::vector<double> pdf(int technique, std::span<const Vec3d> wi, bool exact = false) const;
    /// Sum over techniques.
    std::vector<double> any_pdf(std::span<const Vec3d> wi) const;
    /// The mean of several answers beside each direction, where p is a random estimate.
    std::vector<double> mean_pdf(std::span<const Vec3d> wi, int answers) const;
    std::vector<double> f(std::span<const Vec3d> wi, bool truth = false) const;
    std::vector<Vec3d> f_channels(std::span<const Vec3d> wi) const;
    std::vector<double> f_of_channel(std::span<const Vec3d> wi, int channel) const;

    /// X = sum over techniques of w f L cos / p, sample by sample; even: L = 1 in place of the light.
    std::vector<double> weights(std::span<const SampleBatch> pair, bool even) const;
    /// Those of the screening draws; computed once.
    const std::vector<double>& first_weights(bool even) const;
    /// int f L |cos| over what counts, or only where any_pdf is (not) positive. bins: the upper and the lower half of
    /// the fill's part.
    enum class Where { everywhere, reached, lost };
    const Integral& incoming(Where where, bool even) const;
    /// int g L over what counts, g = f |cos| or what goes with it at each direction; even: L = 1.
    using OfLight = std::function<void(std::span<const Vec3d>, std::span<double>)>;
    Integral integrate_light(const OfLight& g, bool even) const;
    /// What the screening draws did not meet of the light; looked for once.
    const Unmet& unmet(bool even) const;
    /// int f |cos| of one channel over what counts.
    Integral albedo_of(int channel) const;

    Verdict verdict(std::string_view name, State state, std::string say) const;
    /// Of the keys of what is measured of each technique: "_1", "_2"; "" where there is one alone.
    std::string suffix(int technique) const {
        return subject.techniques() > 1 ? "_" + std::to_string(technique + 1) : "";
    }
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

    mutable std::array<std::shared_ptr<const WarpFinding>, 2> warps;  // by technique; see study_warp
    mutable std::array<std::shared_ptr<const Reached>, 2> reached;    // by technique; see preimages_of
    mutable std::array<std::vector<double>, 2> claimed;               // pdf(w) at the points of `warps`, once asked
    std::vector<BinMap> maps;
    std::vector<WeightPicture> pictures;
    void measure_density();  // fills density(); apart, since an invalid sampler has none

private:
    std::uint32_t index_, seed_;
    std::uint64_t asked_before_ = 0;  // when this trial began
    std::vector<SampleBatch> first_;
    mutable std::array<std::optional<SampleBatch>, 2> confirming_;  // of a limited sampler, by technique
    std::vector<Density> density_;
    /// Questions for the verdicts after the density and its confirmation.
    std::size_t for_later() const;
    /// Questions that may still be asked at this w_o.
    std::size_t left() const;
    std::uint64_t confirming_draws() const;
    std::vector<Vec3d> pilot_directions_, support_boundary_;
    std::size_t drawn_pilots_ = 0;  // the first of the pilot directions
    std::optional<Vec3d> circle_;   // the axis of a rim that is a circle
    std::optional<double> pole_;    // 1 - cos of that rim, where p has a pole along it
    std::optional<Vec3d> banded_;   // the axis about which p jumps at heights alone
    std::vector<double> heights_;   // these, as 1 - cos
    double direction_resolution_ = 0;
    Scatter scatter_;
    void note_unconfirmed(double p_first) const;
    mutable double unconfirmed_ = 1;
    void count_nothing(SampleBatch& b) const;
    void settle_zeros(SampleBatch& b) const;
    void ask_again_at_zeros(std::span<const Vec3d> wi, std::span<const double> value, std::span<double> p) const;
    mutable std::array<std::optional<Integral>, 6> incoming_;   // by Where and even
    mutable std::array<std::optional<Unmet>, 2> unmet_;         // by even
    mutable std::array<std::vector<double>, 2> first_weights_;  // by even
    Integral integrate_incoming(Where where, bool even, int channel = -1) const;
    Below below_;
    void look_below();
    void find_pilot_directions();
    void find_support_boundary(int technique);
    bool has_pole_at(const SphereMap& map, double height) const;
    void add_edges_of_support(Density& d) const;
    struct Lobe;
    static Lobe lobe_of(const SampleBatch& b);
    Density density_of(int technique);
    std::optional<Integral> mass_by_caps(int technique, const Density& bins) const;
    bool measure_by_caps(int technique, Density& d) const;
    void measure_about_others(int technique, const Lobe& lobe, Density& d) const;
    void measure_further(int technique, Density& d) const;
    std::optional<Density> table_density(int technique);
    Density density_of_estimates(int technique, Vec3d axis);
    std::vector<Rect> cells_of(const Density& d) const;
    void refine_table(int technique, Density& d) const;
    SamplesPerBin samples_per_bin_of(int technique, const Density& d) const;
    Density density_about(
        int technique, Vec3d axis, bool about_n, std::size_t evaluations, double edge_mass = 4e-4) const;
    Density bins_about(Vec3d axis, bool about_n) const;
    Batch batch_of(int technique, const SphereMap& map) const;
    Integral mass_inside_pole(int technique, const Density& d, std::vector<Rect> cells, const Effort& effort) const;
    void grant_tabulation_error(int technique, Density& d) const;
    void share_nothing(int technique, Density& d) const;
    void estimate_null_fraction(int technique, Density& d, std::uint64_t points, std::optional<double> told) const;
    bool all_alike_below(int technique) const;
};

}  // namespace crescent::inline trials
