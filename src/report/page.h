// The report as a model for its templates: one value per section, false if its data are missing. Sections take plates,
// so the order of the calls decides which section shows one that several could.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/text.h"
#include "output/charts.h"
#include "output/format.h"
#include "report/findings.h"
#include "report/report.h"

namespace crescent {

/// Plates that are embedded in the page, or linked if the page would be too large.
class Figures {
public:
    explicit Figures(const ReportInputs& in);

    /// Returns every plate of a kind that has not been taken yet; `accepts` may select among them.
    Json plates(PlateKind kind, const std::function<bool(const PlatePlan&)>& accepts = {});
    /// Returns the plates that no section has taken.
    Json remaining_plates();

private:
    Json plate(const std::string& name, const PlatePlan* plan);

    const ReportInputs& in_;
    std::set<std::string> placed_plates_, linked_plates_;
};

struct Page {
    const ReportInputs& in;
    Findings find;
    Figures figures;

    explicit Page(const ReportInputs& inputs) : in(inputs), find(inputs), figures(inputs) {}
    /// Returns the name of the first seed: "published" if values were published for it.
    std::string seed_name() const { return in.metrics.published_seed == in.experiment.seed ? "published" : "first"; }
    /// Returns the class of an arm's colour, the same in every chart.
    std::string colour(const std::string& arm) const;
    /// Returns "3 seeds".
    std::string seeds() const { return plural(static_cast<std::uint64_t>(in.experiment.seeds), "seed"); }
};

// theory.html
Json question(const Page& page);
Json estimator_equation(const Page& page);
Json scene_section(Page& page);  // `scene` is a namespace: clang 19 would mangle what follows apart
Json densities(Page& page);
// measurements.html
Json results(Page& page);
Json failure_a(Page& page);
Json failure_b(Page& page);
Json ladders(Page& page);
Json exponent_control(Page& page);
Json furnaces(const Page& page);
Json all_metrics(Page& page);
Json reference(Page& page);
// interpretation.html
Json where_wrong(const Page& page);
Json disagreements(const Page& page);
Json limits(const Page& page);
Json more_plates(Page& page);
Json assertions(const Page& page);
Json provenance(const Page& page);

// Parts that several sections share. Those named html are markup, the others are text.

/// Returns "RMSE_H" with a real subscript for "rmse.H", and so on for every metric.
std::string metric_html(const std::string& metric);
/// Returns the name without markup, for the labels of charts: "RMSE, region H".
std::string metric_text(const std::string& metric);
/// Returns "0.71 ± 0.02", or "" if there is no tail.
std::string tail_text(const std::optional<Tail>& tail);
/// Returns "7.218 … 8.277", or the words heavy tail; an en dash for a single seed.
std::string interval_html(const std::string& metric, const Band& band);
/// A run as a column of a table of metrics.
struct Column {
    Json head;  // name, exponent, rays, biased
    std::string arm;
    std::uint64_t n = 0;
    double s = 0;
};
/// Returns a table for metrics_rows.html: metrics are rows; false if no run has any.
Json metrics_table(const Page& page, const std::vector<Column>& columns);
/// Returns which arm has the larger RMSE in a region, by how much, in how many seeds, and whether that ranks them.
std::string ordering_html(
    const Page& page, const std::string& a, const std::string& b, std::uint64_t n, const std::string& region);
/// Returns "3.1", "12": a factor.
std::string times(double ratio);
/// Adds to each object what follows it in "a, b, c", as `comma`.
Json with_commas(Json objects);

}  // namespace crescent

// ---- The arms that a report compares, and sentences about them. All of it follows from SamplerInfo and from the
// measurements.

// The few pieces of markup that sentences contain.
namespace crescent::html {

/// A number in a sentence keeps its digits together and in tabular figures.
inline std::string value(std::string_view text) { return "<span class=\"v\">" + escape(with_minus(text)) + "</span>"; }
/// In the place of an interval.
inline std::string heavy_tail() { return "<span class=\"heavy\">heavy tail</span>"; }

}  // namespace crescent::html

namespace crescent {

/// An arm about the normal and one about the mirror direction that ran at one N; among several about the normal, the
/// one that shares most sample counts with the other, then the one with the smallest errors.
struct ArmPair {
    const ArmPlan *broad = nullptr, *narrow = nullptr;
    std::uint64_t n = 0;
    explicit operator bool() const { return broad && narrow && n > 0; }
};
/// Returns the narrow and the broad arm that the report compares.
ArmPair arm_pair(const Page& page);

/// Returns the arms about the normal that combine no others.
std::vector<const ArmPlan*> arms_about_normal(const Experiment& experiment);

/// Returns the first arm about the mirror direction; null if there is none.
const ArmPlan* arm_about_mirror(const Experiment& experiment);

/// Returns "phong, N = 64, s = 32"; s only if it identifies a run.
std::string run_html(const RunKey& key, const Experiment& experiment);

/// Returns remarks on arms whose N counts pairs, and on those that cannot reach all light; "" if there are none.
std::string ray_words(const Experiment& experiment);
std::string bias_words(const Experiment& experiment);
/// The text after a space, for what follows a sentence; "" if it is empty.
std::string after_space(const std::string& text);

}  // namespace crescent
