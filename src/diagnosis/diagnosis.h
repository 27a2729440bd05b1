// What would explain a wrong verdict: the ratio of what was observed to what was claimed, over the sphere, held against
// the factors that people forget, double or exchange.
#pragma once

#include <functional>
#include <optional>

#include "trials/trial_context.h"
#include "warps/jacobian.h"

namespace crescent::inline diagnosis {

/// Observed over claimed at one direction, and what that is known to, relative.
struct Ratio {
    Vec3d wi{};
    double value = 0, error = 0;
};

/// A factor g of observed / claimed; g <= 0 where it says nothing.
struct Factor {
    std::string name;  // "cos theta_i"
    std::function<double(Vec3d wi)> g;
    bool whole = false;     // it explains the ratios with the constant 1 alone
    std::string details{};  // ", of roughness 0.15"
};

struct Diagnosis {
    std::string name;                     // "cos theta_i", "a constant", "x and y exchanged"
    double constant = 1;                  // observed = constant * factor * claimed
    double explained = 0;                 // share of the difference, in the logarithm
    std::string means;                    // "a constant 0.9706 = (s+1)/(s+2)"
    std::function<double(Vec3d wi)> g{};  // the factor itself, where it is one of w_i
};

/// The factors that people forget, double or exchange, at the work's w_o.
std::vector<Factor> usual_factors(const TrialContext& work);
/// Fresnel where it does not belong, a coat's passes, G2 for G1 G1: whole factors, see fresnel_factors.cpp.
void add_whole_factors(std::vector<Factor>& out, const TrialContext& work);
/// Factors with a parameter that is read off the ratios; see fitted_factors.cpp.
std::vector<Factor> fitted_factors(const TrialContext& work, std::span<const Ratio> ratios);
/// Those of what is reflected alone (across: of what is refracted), where the index is told.
std::vector<Factor> factors_of_side(const TrialContext& work, bool across);
/// The microfacet's normal that leads from wo to wi, or its opposite: of a reflection, or of what goes through a
/// boundary, eta = index beyond over here (Walter et al. 2007, (13), (16)). Unit; n where the two are opposite.
Vec3d half_vector(Vec3d wo, Vec3d wi, double eta);
/// "1/2", "(s+1)/(s+2)", "1/pi"; "" where it is no constant that one knows. known_to: relative.
std::string name_of_constant(const TrialContext& work, double constant, double known_to = 1e-3);
/// "4 (w_o.m) and a constant 0.5 = 1/2".
std::string factor_text(const TrialContext& work, const std::string& name, double constant);
/// The first factor that explains nine of ten ratios; none where nothing differs, or nothing explains it.
std::optional<Diagnosis> explain(const TrialContext& work, std::span<const Ratio> ratios);
/// What one ratio may differ from a factor by, in the logarithm: 0.2 %, a fiftieth of how far the ratios are from one
/// (`all`), and its error. What is nearly constant is no constant where its own spread shows.
double may_differ(double all, double error);
/// What is drawn, 1 / |J|, over pdf(w) at points of the warp; less than that where several u reach one direction.
std::vector<Ratio> drawn_over_claimed(const TrialContext& work, int technique);
/// Those that are known to a twentieth.
std::vector<Ratio> usable(std::vector<Ratio> all);
/// ": what is drawn is pdf(w) times 0.924 on average, 0.873 to 0.975 at nine of ten directions"; "" where they agree.
std::string spread_told(const TrialContext& work, Verdict& v);
/// Nothing differs that could be explained: half of all ratios are one.
bool mostly_one(std::span<const Ratio> ratios);
/// What is drawn is pdf(w) of another w_o, another w_i or both, at nine of ten points of the warp; as_it_is: drawn over
/// claimed at these.
std::optional<Diagnosis> turned(
    const TrialContext& work, int technique, std::span<const WarpPoint> points, std::span<const Ratio> as_it_is);
/// What is drawn against pdf(w), by the warp's Jacobian, or by bins where there is none: a factor, or another frame.
std::optional<Diagnosis> diagnose_density(const TrialContext& work, int technique);
std::optional<Diagnosis> diagnose_by_bins(const TrialContext& work, int technique);
/// c g p comes to what is drawn: a p that is right on half of the sphere and drawn nowhere else is not off by 2 there.
bool comes_to_one(const TrialContext& work, int technique, const Diagnosis& found);
/// The weight of one channel is f cos / p of another, or of their luminance.
std::optional<Diagnosis> exchanged_channels(const TrialContext& work, const SampleBatch& b, std::size_t most);
/// The weights of one or two channels are f cos / p times a factor, the others are right.
std::optional<Diagnosis> scaled_channels(const TrialContext& work, const SampleBatch& b, std::size_t most);
/// The weights of the channels are off by unlike factors: their luminance tells nothing.
bool channels_differ(const TrialContext& work, const SampleBatch& b, std::size_t most);
/// Two lobes of a mixture are drawn with other probabilities than pdf(w) has; see diagnosis_lobes.cpp.
std::optional<Diagnosis> diagnose_lobes(const TrialContext& work, int technique);
/// What explains it of lobes that one number chooses among, by what each of them draws; see diagnosis_within.cpp.
std::optional<Diagnosis> diagnose_several_lobes(const TrialContext& work, int technique);
struct LobeDraws;
/// Of these lobes, what they are chosen with; see diagnosis_shares.cpp.
std::optional<Diagnosis> diagnose_shares(const TrialContext& work, int technique, const LobeDraws& of);
/// What comes with the draws against what is asked: pdf, weight, f.
std::optional<Diagnosis> diagnose_identity(const TrialContext& work, int technique);
/// Says of the first verdict that is wrong what explains it, or that nothing usual does; the later ones refer to it.
void diagnose(const TrialContext& work, std::span<Verdict> verdicts);

}  // namespace crescent::inline diagnosis
