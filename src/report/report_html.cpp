// report.html: the whole write-up in one file that opens offline. Prose and numbers come from the sections; here is the
// order in which they are told, the head of the page and its contents.
#include <algorithm>

#include <fmt/format.h>

#include "report/arm_words.h"

namespace crescent::inline report {
namespace {

std::vector<PageSection> all_sections(Page& page) {
    return {question(page), estimator(page), scene(page), densities(page), results(page), failure_a(page),
        failure_b(page), ladders(page), exponent(page), furnaces(page), published(page), reference(page),
        where_wrong(page), disagreements(page), what_ifs(page), limits(page), more_plates(page), assertions(page),
        provenance(page)};
}

std::string verdict(const std::vector<AssertionResult>& all) {
    if (all.empty()) return {};
    const auto failed = std::count_if(all.begin(), all.end(), [](const AssertionResult& a) { return a.failed(); });
    const auto empty = std::ranges::count_if(all, [](const AssertionResult& a) { return a.cannot_fail; });
    const std::string without = empty > 0 ? fmt::format(", {} of them whatever it measures", empty) : "";
    if (failed == 0)
        return fmt::format(
            "<p class=\"verdict good\">All {} assertions of this run hold{}.</p>\n", all.size(), without);
    return fmt::format("<p class=\"verdict bad\">{} of {} assertions of this run FAIL. See {}.</p>\n", failed,
        all.size(), html::link("assertions", "which"));
}

/// What an arm about the normal and one about the mirror direction read in each region, in one sentence.
std::string story(const Page& page) {
    const ArmPair pair = arm_pair(page);
    if (!pair) return {};
    const ArmPlan *broad = pair.broad, *narrow = pair.narrow;
    const std::uint64_t n = pair.n;
    std::string out;
    for (const Region& region : page.in.experiment.regions) {
        const auto a = page.find.rmse(broad->name, n, region.name), b = page.find.rmse(narrow->name, n, region.name);
        if (!a || !b) continue;
        const RatioOfErrors c = compare(broad->name, *a, narrow->name, *b);
        out += out.empty() ? fmt::format(" At <i>N</i> = {} and the {} seed", n, page.seed_name()) : ";";
        const std::string where = " in region " + escape(region.name);
        out += c.equal
            ? where + " the two err alike"
            : fmt::format("{} {}’s error is {} times {}’s", where, escape(c.larger), times(c.ratio), escape(c.smaller));
    }
    return out.empty()
        ? out
        : "One integral, one number of samples, one stream of random numbers: only the aim differs." + out + ".";
}

std::string lead(const Page& page) {
    const std::string words = story(page);
    return (words.empty() ? "" : html::element("p", "class=\"lead\"", words) + "\n") +
        verdict(page.in.metrics.assertions);
}

}  // namespace

std::string report_html(const ReportInputs& in) {
    Page page(in);
    PageFrame frame;
    frame.title_text = in.experiment.title;
    frame.kicker_text = "a bench for importance samplers";
    frame.version_text = in.provenance.version;
    frame.lead_html = lead(page) + page.figures.plates(PlateKind::hero) + "\n";  // the first figure
    frame.footer_html = fmt::format("Made by crescent {} from <code>{}</code>, hash <code>{}</code>.",
        escape(in.provenance.version), escape(in.provenance.experiment_file), escape(in.provenance.experiment_hash));
    frame.contents = true;
    return page_html(frame, all_sections(page));
}

}  // namespace crescent::inline report
