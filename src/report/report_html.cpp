// report.html: the whole write-up in one file that opens offline. Prose and numbers come from the sections; here is the
// order in which they are told, the head of the page and its contents.
#include <algorithm>

#include <fmt/format.h>

#include "report/page.h"
#include "report/style.h"

namespace crescent {
namespace {

constexpr const char* page_frame = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8" />
<meta name="viewport" content="width=device-width, initial-scale=1" />
<meta name="color-scheme" content="light dark" />
<meta name="generator" content="crescent {version}" />
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<a class="skip" href="#main">Skip to the text</a>
<header>
<p class="kicker">crescent · a bench for importance samplers</p>
<h1>{title}</h1>
{lead}
{hero}
<nav aria-label="Contents">
<h2>Contents</h2>
<ol>
{contents}</ol>
</nav>
</header>
<main id="main">
{sections}</main>
<footer>
<p class="footnote">Made by crescent {version} from <code>{file}</code>, hash <code>{hash}</code>.</p>
</footer>
</body>
</html>
)";

std::vector<PageSection> all_sections(Page& page) {
    std::vector<PageSection> all{question(page), estimator(page), scene(page), densities(page), results(page),
        failure_a(page), failure_b(page), ladders(page), exponent(page), furnaces(page), published(page),
        reference(page), where_wrong(page), disagreements(page), what_ifs(page), limits(page), more_plates(page),
        assertions(page), provenance(page)};
    std::erase_if(all, [](const PageSection& s) { return s.html.empty(); });
    return all;
}

std::string verdict(const std::vector<AssertionResult>& all) {
    if (all.empty()) return {};
    const auto failed = std::count_if(all.begin(), all.end(), [](const AssertionResult& a) { return a.failed(); });
    if (failed == 0)
        return fmt::format("<p class=\"verdict good\">All {} assertions of this run hold.</p>\n", all.size());
    return fmt::format("<p class=\"verdict bad\">{} of {} assertions of this run FAIL. See {}.</p>\n", failed,
        all.size(), html::link("assertions", "which"));
}

/// What the arms with a cosine and a Phong density read in each region, in one sentence.
std::string story(const Page& page) {
    const ArmPlan *broad = page.find.arm_with("cosine"), *narrow = page.find.arm_with("phong");
    if (!broad || !narrow) return {};
    const std::uint64_t n = page.find.headline_n();
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
    const std::string hero = page.figures.plates(PlateKind::hero);
    std::string contents, sections;
    std::size_t number = 0;
    for (const PageSection& s : all_sections(page)) {
        ++number;
        contents += fmt::format("<li>{}</li>\n", html::link(s.id, s.title));
        sections += fmt::format(
            "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\"><span class=\"number\">{1}</span>"
            "<a href=\"#{0}\">{2}</a></h2>\n{3}</section>\n",
            s.id, number, s.title, s.html);
    }
    return fmt::format(page_frame, fmt::arg("version", escape(in.provenance.version)),
        fmt::arg("title", escape(in.experiment.title)), fmt::arg("style", style_sheet), fmt::arg("lead", lead(page)),
        fmt::arg("hero", hero), fmt::arg("contents", contents), fmt::arg("sections", sections),
        fmt::arg("file", escape(in.provenance.experiment_file)),
        fmt::arg("hash", escape(in.provenance.experiment_hash)));
}

}  // namespace crescent
