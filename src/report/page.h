// The page being written: its run, its figures and their numbers, and the sections in their order. A section with empty
// html is omitted, also from the contents.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "output/charts.h"
#include "output/format.h"
#include "output/html.h"
#include "report/findings.h"
#include "report/mathml.h"
#include "report/report.h"

namespace crescent::inline report {

/// Numbers the figures, embeds plates, and writes under each what it is and the command that makes it.
class Figures {
public:
    explicit Figures(const ReportInputs& in);

    /// Returns every plate of a kind that has not been shown yet; `only` may select among them.
    std::string plates(PlateKind kind, const std::function<bool(const PlatePlan&)>& only = {});
    /// Returns the plates that no section has shown.
    std::string rest();
    /// Adds a chart drawn from the numbers; `source` names the part of metrics.json it shows.
    std::string chart(const std::string& svg, const std::string& caption_html, const std::string& source);
    /// Returns the names of plates that are linked because the page would be too large.
    const std::set<std::string>& outside() const { return outside_; }

private:
    std::string plate(const std::string& name, const PlatePlan* plan);
    std::string figure(
        const std::string& id, const std::string& picture, const std::string& caption, const std::string& made);

    const ReportInputs& in_;
    std::set<std::string> shown_, outside_;
    int count_ = 0;
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
};

// Theory.
PageSection question(Page& page);
PageSection estimator_equation(Page& page);
PageSection scene(Page& page);
PageSection densities(Page& page);
// Measurements.
PageSection results(Page& page);
PageSection failure_a(Page& page);
PageSection failure_b(Page& page);
PageSection ladders(Page& page);
PageSection exponent(Page& page);
PageSection furnaces(Page& page);
PageSection published(Page& page);
PageSection reference(Page& page);
// Interpretation.
PageSection where_wrong(Page& page);
PageSection disagreements(Page& page);
PageSection more_plates(Page& page);
PageSection what_ifs(Page& page);
PageSection limits(Page& page);
PageSection assertions(Page& page);
PageSection provenance(Page& page);

// Parts that several sections share.

/// Returns "RMSE_H" with a real subscript for "rmse.H", and so on for every metric.
std::string metric_html(const std::string& metric);
/// Returns the name without markup, for the labels of charts: "RMSE, region H".
std::string metric_text(const std::string& metric);
/// Returns "k = 0.71 ± 0.02", or an en dash.
std::string tail_html(const std::optional<Tail>& tail);
/// Returns "7.218 … 8.277", or the words heavy tail; nothing for a single seed.
std::string interval_html(const std::string& metric, const Band& band);
/// Metrics are rows, runs are columns: the value of the first seed in large type, the median, its band and the tail
/// index in small type.
struct Column {
    std::string title_html, arm;
    std::uint64_t n = 0;
    double s = 0;
};
/// Rows are arms and sample counts; each column a metric with its band.
std::string metrics_table(const Page& page, const std::string& caption_html, const std::vector<Column>& columns);
/// Returns which arm has the larger RMSE in a region, by how much, in how many seeds, and whether that ranks them.
std::string ordering_sentence(
    const Page& page, const std::string& a, const std::string& b, std::uint64_t n, const std::string& region);
/// Returns "3.1", "12": a factor.
std::string times(double ratio);

}  // namespace crescent::inline report
