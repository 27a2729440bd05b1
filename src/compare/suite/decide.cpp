// All views together: Holm's method over the p-values of the views, then one state and one sentence for each.
#include "compare/suite/decide.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/text.h"
#include "compare/renders.h"
#include "compare/suite/suite.h"
#include "math/functions.h"
#include "output/format.h"

namespace crescent {

namespace {

/// Divides the level of the suite between the numbers of outlier pixels and all else. Whether a number is tested
/// depends on the sum over both sides alone, which says nothing about a difference.
void share_level(std::vector<ViewResult>& views, double alpha) {
    const auto test_count =
        std::count_if(views.begin(), views.end(), [](const ViewResult& view) { return !std::isnan(view.outliers.p); });
    for (ViewResult& view : views) {
        view.outlier_level = alpha * share_of_outliers / static_cast<double>(std::max<std::ptrdiff_t>(1, test_count));
        view.share_of_variances = 1 - share_of_means - (test_count > 0 ? share_of_outliers : 0) -
            (std::isnan(view.outlier_render.p) ? 0 : share_of_render);
    }
}

/// Returns p of "neither the means nor the variances differ, and no render deviates"; the level is shared as in
/// suite.h.
double view_p(const ViewResult& view) {
    const double noise = std::fmin(view.variance_p / view.share_of_variances, view.outlier_render.p / share_of_render);
    return std::fmin(view.mean_p / share_of_means, noise);
}

/// Sets the level of each view by Holm 1979; all views that are not rejected have the level at which the method
/// stopped.
void set_levels(std::vector<ViewResult*>& views, double alpha) {
    std::sort(views.begin(), views.end(), [](const ViewResult* a, const ViewResult* b) {
        const double p = view_p(*a), q = view_p(*b);
        return p != q ? p < q : a->name < b->name;
    });
    bool rejected = true;
    double level = 0;
    for (std::size_t k = 0; k < views.size(); ++k) {
        if (rejected) level = alpha / static_cast<double>(views.size() - k);
        rejected &= view_p(*views[k]) <= level;
        views[k]->level = level;
    }
}

/// Removes the places of a view in which no difference was decided.
void forget_places(ViewResult& view) {
    view.pictures.significance.clear();
    BiasResult& means = *view.means;
    for (MeanTest& t : means.regions) {
        t.differs = false;
        for (MeanTest& c : t.channels) c.differs = false;
    }
    means.tiles.different = 0;
    means.tiles_found.clear();
    means.tiles_by.clear();
    means.pixels_different = 0;
    means.pixels_found.clear();
    means.pixels_by.clear();
    for (FailedGroups& g : means.non_finite.groups) g.differs = false;
    means.missed_events.reset();
}

/// Returns +1: more variance somewhere, -1: less somewhere and more nowhere, 0: neither.
int compare_variances(ViewResult& view) {
    int sign = 0;
    const double tests = static_cast<double>(
        std::count_if(view.variances.begin(), view.variances.end(), [](const auto& t) { return t.why.empty(); }));
    for (VarianceTest& t : view.variances) {
        t.different = t.why.empty() && t.welch.p * tests / view.share_of_variances <= view.level;
        if (!t.different) continue;
        if (t.candidate > t.baseline) sign = 1;
        else if (sign == 0) sign = -1;
    }
    return sign;
}

std::string variance_sentence(const ViewResult& view, int sign) {
    const VarianceTest* test = nullptr;
    for (const VarianceTest& t : view.variances)
        if (t.different && (t.candidate > t.baseline) == (sign > 0) && (!test || t.welch.p < test->welch.p)) test = &t;
    std::string out = fmt::format("The variance of a pixel in {} is {} times that of the baseline (p = {:.2g}).",
        test->region, figures(test->candidate / test->baseline, 3), test->welch.p);
    if (sign > 0 && !view.noisiest.empty()) out += fmt::format(" It grew the most in {}.", view.noisiest);
    if (test->smallest > 1 && std::isfinite(test->smallest))
        out += fmt::format(" {} times would be found with a probability of 90 %.", figures(test->smallest, 3));
    return out;
}

/// States the largest of the differences that would be found.
std::string power_sentence(const BiasResult& means) {
    const MeanTest* largest = nullptr;
    for (const MeanTest& t : means.regions)
        if (t.why.empty() && (!largest || t.smallest > largest->smallest)) largest = &t;
    if (!largest) return "";
    return fmt::format("A difference of {} of mean Y in {} would be found with a probability of 90 %.",
        percent(largest->smallest, 2), largest->region);
}

std::string too_few_sentence(const ViewResult& view) {
    if (!view.untestable.empty()) return fmt::format("Undecided: {}. {}", view.untestable, view.remedy);
    std::string out =
        fmt::format("Too few renders ({} and {}): {}.", view.baseline_renders, view.candidate_renders, view.too_few);
    if (view.renders_needed && static_cast<double>(*view.renders_needed) >= renders_beyond)
        out += " More than a million renders of each side would be needed.";
    else if (view.renders_needed) out += fmt::format(" {} renders of each side would do.", *view.renders_needed);
    if (view.baseline_renders == 1 && view.candidate_renders == 1)
        out += " A view without noise needs one: state tolerance = \"0 ulp\", or a larger one.";
    return out;
}

/// "1 of them is finite on one side only"; "" if none is.
std::string one_sided_text(const ExactDifference& e) {
    return e.one_sided == 0
        ? ""
        : fmt::format("{} of them {} finite on one side only", e.one_sided, e.one_sided == 1 ? "is" : "are");
}

/// "5 of 255 steps", "1.00 ulp"
std::string steps_text(const ExactDifference& e) {
    return e.step_name.empty() ? fmt::format("{} ulp", figures(e.steps, 3))
                               : fmt::format("{} of {} steps", e.steps, e.step_name);
}

std::string exact_sentence(const ViewResult& view) {
    const BiasResult& means = *view.means;
    if (means.identical) return "Deterministic: every render has the same value in every tested channel.";
    if (!view.exact_difference) return "Deterministic, and its pixels changed.";
    const ExactDifference& e = *view.exact_difference;
    std::string out = fmt::format(
        "Deterministic, and {} of {} pixels changed; the largest difference of a channel is {} at ({}, {}), {} of a "
        "value and {} at most.",
        e.different, e.pixels, steps_text(e), e.x, e.y, std::isfinite(e.share) ? percent(e.share, 2) : "all",
        figures(e.absolute, 3));
    if (e.one_sided > 0) out += fmt::format(" {}.", one_sided_text(e));
    if (view.tolerated) out += " That is within the tolerance.";
    else if (e.excess > 0) out += fmt::format(" Beyond the tolerance: {}.", plural(e.excess, "pixel"));
    return out;
}

/// The same in the shortest form, of a view whose pixels differ.
std::string exact_headline(const ViewResult& view) {
    const ExactDifference& e = *view.exact_difference;
    std::string out = fmt::format("{}: {} of {} pixels differ, by at most {}, at ({}, {})",
        view.tolerated ? "Within the tolerance" : "Changed", e.different, e.pixels, steps_text(e), e.x, e.y);
    if (e.one_sided > 0) out += "; " + one_sided_text(e);
    if (e.excess > 0) out += fmt::format("; {} beyond the tolerance", e.excess);
    return out + ".";
}

/// States that other channels differ; "" if none does.
std::string other_channels_sentence(const ViewResult& view) {
    if (view.other_channels.empty()) return "";
    return fmt::format("Channels that are not tested differ: {} (channels = \"rgba\" tests alpha, --channel NAME any).",
        view.other_channels);
}

/// "Candidate states 12 spp, baseline 16."; "" unless both state their samples a pixel and these differ.
std::string samples_sentence(const ViewResult& view) {
    if (!view.spp_baseline || !view.spp_candidate || *view.spp_baseline == *view.spp_candidate) return "";
    return fmt::format("Candidate states {:g} spp, baseline {:g}.", *view.spp_candidate, *view.spp_baseline);
}

std::string outlier_place(const ViewOutliers::Place& outlier) {
    return fmt::format("({}, {}) of {} is {}{} where the other renders have {}", outlier.x, outlier.y, outlier.file,
        outlier.quantity == 0 ? "" : fmt::format("{} ", quantity_names[outlier.quantity]), figures(outlier.value, 3),
        figures(outlier.others, 3));
}

/// Returns the smallest number of outlier pixels of the candidate, against none of the baseline, that is a change.
int least_outliers_found(const ViewResult& view) {
    const double renders = static_cast<double>(view.baseline_renders + view.candidate_renders),
                 share = static_cast<double>(view.candidate_renders) / renders;
    return static_cast<int>(std::ceil(math::log(view.outlier_level / 2) / math::log(share)));
}

/// States the numbers of outlier pixels, whether they differ, and whether the pixels are left out; "" if there are
/// none.
std::string outliers_sentence(const ViewResult& view, bool differ) {
    const ViewOutliers& o = view.outliers;
    if (o.baseline + o.candidate == 0) return "";
    std::vector<std::string> places;
    for (const ViewOutliers::Place& outlier : o.first) places.push_back(outlier_place(outlier));
    std::string out = fmt::format("{} in {} of the candidate and {} in {} of the baseline ({}): {}{}.",
        plural(o.candidate, "outlier pixel"), plural(view.candidate_renders, "render"), o.baseline,
        view.baseline_renders, std::isnan(o.p) ? "too few to differ" : fmt::format("p = {:.2g}", o.p),
        fmt::join(places, "; "), o.baseline + o.candidate > places.size() ? "; and more" : "");
    if (o.set_apart) out += " These pixels are left out of the tests of means and variances.";
    if (!differ && o.baseline == 0) out += fmt::format(" {} would be a change.", least_outliers_found(view));
    return out;
}

/// Names the render that does not belong to the others.
std::string outlier_render_sentence(const ViewOutlierRender& r, bool differs) {
    const std::string reason = r.pixels > 0
        ? fmt::format("it has {} outlier pixels, more than renders of equal noise have", r.pixels)
        : fmt::format("it deviates by {} of their standard deviations, and its mean Y is {} times theirs",
              figures(r.deviation, 2), figures(r.ratio, 3));
    return fmt::format("{} {} to the other renders of the {}: {} (p = {:.2g}).", r.file,
        differs ? "does not belong" : "may not belong", r.candidate ? "candidate" : "baseline", reason, r.p);
}

void add_sentence(std::string& to, const std::string& sentence) {
    if (sentence.empty()) return;
    to += to.empty() ? sentence : " " + sentence;
}

void decide_compared(ViewResult& view) {
    BiasResult& means = *view.means;
    const bool means_differ = view.mean_p / share_of_means <= view.level;
    const bool outliers_differ = view.outliers.p <= view.outlier_level;
    const bool render_deviates = view.outlier_render.p / share_of_render <= view.level;
    constexpr double rare_p = 0.01;  // a deviation this rare is named at any level: it widens the variance
    const bool is_doubtful = !view.exact && (render_deviates || view.outlier_render.p <= rare_p);
    if (is_doubtful) view.renders_needed.reset();
    const int sign = view.noise == NoiseDemand::ignore ? 0 : compare_variances(view);
    if (!means_differ) forget_places(view);
    if (sign == 0) view.pictures.noise.clear();
    if (!view.non_finite.empty()) {
        view.state = ViewState::changed;
        view.sentence = view.non_finite + (means_differ && !view.exact ? " " + means.sentence : "");
    } else if (!view.untestable.empty()) {
        forget_places(view);
        view.renders_needed.reset();
        view.state = ViewState::too_few;
        view.sentence = too_few_sentence(view);
        return;
    } else if (view.exact) {
        view.state = means_differ ? ViewState::changed : ViewState::same;
        view.sentence = exact_sentence(view);
    } else if (means_differ || outliers_differ || render_deviates) {
        view.state = ViewState::changed;
        view.sentence = means_differ ? means.sentence : "";
    } else if (sign > 0) {
        view.state = ViewState::noisier;
        view.sentence = variance_sentence(view, 1) + " The mean held.";
        add_sentence(view.sentence, power_sentence(means));
    } else if (sign < 0 && view.noise == NoiseDemand::same) {
        view.state = ViewState::changed;
        view.sentence = variance_sentence(view, -1) + " The same noise is asked (noise = \"same\").";
        add_sentence(view.sentence, power_sentence(means));
    } else if (!view.too_few.empty()) {
        view.state = ViewState::too_few;
        view.sentence = too_few_sentence(view);
    } else if (sign < 0) {
        view.state = ViewState::improved;
        view.sentence = "Same mean. " + variance_sentence(view, -1) + " " + power_sentence(means);
    } else if (means.identical) {
        view.state = ViewState::same;
        view.sentence = "Identical: every render has the same value in every tested channel.";
    } else {
        view.state = ViewState::same;
        view.sentence = power_sentence(means);
    }
    if (is_doubtful) add_sentence(view.sentence, outlier_render_sentence(view.outlier_render, render_deviates));
    if (!view.exact) add_sentence(view.sentence, outliers_sentence(view, outliers_differ));
    add_sentence(view.sentence, other_channels_sentence(view));
    if (const std::string samples = samples_sentence(view); !samples.empty())
        view.sentence = samples + (view.sentence.empty() ? "" : " " + view.sentence);
    if (view.noise == NoiseDemand::ignore && !view.exact) add_sentence(view.sentence, "The noise was not tested.");
    if (view.candidate_renders == 1 && view.baseline_renders > 1 && !view.exact)
        view.sentence +=
            " The one render of the candidate was tested with the variance of the baseline; its noise was not "
            "tested.";
    if (!view.too_few.empty() && view.state == ViewState::noisier) view.sentence += " " + too_few_sentence(view);
}

/// "+5 %", or a mean of 0 in words.
std::string relative_change(double candidate, double baseline) {
    if (!(baseline > 0)) return fmt::format("{} instead of {}", figures(candidate, 2), figures(baseline, 2));
    return (candidate < baseline ? "−" : "+") + percent(std::fabs(candidate / baseline - 1), 2);
}

/// What changed in the means, in the shortest form: the region with the smallest p, of Y if Y differs there, else the
/// first place.
std::string changed_means(const ViewResult& view) {
    const MeanTest *test = nullptr, *region = nullptr;
    for (const MeanTest& t : view.means->regions)
        if (t.differs && (!test || t.welch.p < test->welch.p)) test = region = &t;
    for (const MeanTest& t : view.means->regions)
        for (const MeanTest& c : t.channels)
            if (!test && c.differs) {
                test = &c;
                region = &t;
            }
    constexpr std::size_t longest_name = 30;
    if (test)
        return fmt::format("mean {} in {} {} (p = {:.1g})", region == test ? "Y" : test->region,
            printable(region->region, longest_name), relative_change(test->a, test->b), test->welch.p);
    const Found* place = !view.means->tiles_found.empty() ? &view.means->tiles_found[0]
        : !view.means->pixels_found.empty()               ? &view.means->pixels_found[0]
                                                          : nullptr;
    if (!place) return "values that are not finite";
    return fmt::format("{} and {}, most at x {}–{} y {}–{}: {} {}", plural(view.means->tiles.different, "tile"),
        plural(view.means->pixels_different, "pixel"), place->box.x0, place->box.x1, place->box.y0, place->box.y1,
        quantity_names[place->quantity], relative_change(place->a, place->b));
}

std::string changed_headline(const ViewResult& view) {
    if (!view.non_finite.empty()) return view.non_finite;
    if (view.mean_p / share_of_means <= view.level) return fmt::format("Changed: {}.", changed_means(view));
    if (view.outliers.p <= view.outlier_level)
        return fmt::format("Changed: {} of the candidate, {} of the baseline (p = {:.1g}).",
            plural(view.outliers.candidate, "outlier pixel"), view.outliers.baseline, view.outliers.p);
    if (view.outlier_render.p / share_of_render <= view.level)
        return fmt::format("Changed: {} does not belong to the other renders.", view.outlier_render.file);
    return "Changed: less noise, and the same is asked.";
}

/// "" without a variance that is larger.
std::string noisier_headline(const ViewResult& view) {
    for (const VarianceTest& t : view.variances)
        if (t.different && t.candidate > t.baseline)
            return fmt::format("Noisier: the variance is {} times the baseline's (p = {:.1g}); the mean held.",
                figures(t.candidate / t.baseline, 3), t.welch.p);
    return "";
}

std::string too_few_headline(const ViewResult& view) {
    if (!view.untestable.empty()) return fmt::format("Undecided: {}.", view.untestable);
    if (!view.renders_needed) return fmt::format("Undecided: {}.", view.too_few);
    return fmt::format("Undecided: {} of each side would do.", plural(*view.renders_needed, "render"));
}

/// The result in a shorter form than that of the sentence; "" if there is none.
std::string brief_result(const ViewResult& view) {
    const bool exact = view.exact_difference && view.non_finite.empty() &&
        (view.state == ViewState::changed || view.state == ViewState::same);
    return exact                           ? exact_headline(view)
        : view.state == ViewState::changed ? changed_headline(view)
        : view.state == ViewState::noisier ? noisier_headline(view)
        : view.state == ViewState::too_few ? too_few_headline(view)
                                           : "";
}

/// The result of a view in one sentence of at most `longest_headline` characters, after its samples.
std::string headline_of(const ViewResult& view) {
    std::string out = brief_result(view);
    if (out.empty()) out = view.sentence;
    else if (const std::string samples = samples_sentence(view); !samples.empty()) out = samples + " " + out;
    constexpr std::size_t dots = 3;  // that printable() puts behind what it cuts
    const std::string line = printable(out);
    return line.size() <= longest_headline ? line : printable(line, longest_headline - dots);
}

std::string suite_sentence(const Suite& suite, const SuiteResult& result) {
    std::vector<std::string> counts;
    for (std::size_t k = 0; k < view_state_names.size(); ++k)
        if (const std::size_t n = result.count(static_cast<ViewState>(k)))
            counts.push_back(fmt::format("{} {}", n, view_state_names[k]));
    return fmt::format("{}: {}. A suite without any change reports one with a probability of at most {} ({}).",
        plural(result.views.size(), "view"), fmt::join(counts, ", "), percent(suite.options.alpha, 2),
        result.tested_views ? fmt::format("alpha = {}, Holm's method over {}", compact(suite.options.alpha),
                                  plural(result.tested_views, "view"))
                            : "no view was tested");
}

}  // namespace

std::size_t SuiteResult::count(ViewState state) const {
    return static_cast<std::size_t>(
        std::count_if(views.begin(), views.end(), [&](const ViewResult& view) { return view.state == state; }));
}

int exit_code(const SuiteResult& result, bool new_baseline) {
    const auto occurs = [&](ViewState state) { return result.count(state) > 0; };
    if (occurs(ViewState::unreadable)) return 2;
    if (occurs(ViewState::changed) || occurs(ViewState::noisier) || occurs(ViewState::missing)) return 1;
    if (!new_baseline && occurs(ViewState::added)) return 1;
    return occurs(ViewState::too_few) ? 4 : 0;
}

void decide(const Suite& suite, SuiteResult& result) {
    std::vector<ViewResult*> views;
    for (ViewResult& view : result.views)
        if (view.means && !view.exact && view.untestable.empty() && !std::isnan(view_p(view))) views.push_back(&view);
    result.tested_views = views.size();
    share_level(result.views, suite.options.alpha);
    set_levels(views, suite.options.alpha);
    for (ViewResult& view : result.views) {
        if (view.state == ViewState::unreadable) continue;
        if (view.state == ViewState::added)
            view.sentence = fmt::format(
                "New: no baseline was found; --accept {} makes {} the baseline, --new-baseline allows new views.",
                view.name,
                view.candidate_renders == 1 ? "this render" : fmt::format("these {} renders", view.candidate_renders));
        else if (view.state == ViewState::missing)
            view.sentence = fmt::format(
                "Missing: the baseline has {}, the candidate none.", plural(view.baseline_renders, "render"));
        else if (!view.means) view.sentence = too_few_sentence(view);
        else decide_compared(view);
    }
    for (ViewResult& view : result.views) view.headline = headline_of(view);
    result.sentence = suite_sentence(suite, result);
}

}  // namespace crescent
