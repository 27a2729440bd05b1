// report.html of a comparison: what was found, the numbers with their doubt, the pictures, the spectra, the files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pages/base64.h"
#include "compare/judge.h"
#include "compare/outputs.h"
#include "compare/page.h"
#include "pages/html.h"
#include "pages/numbers.h"
#include "pages/page.h"

namespace crescent::inline comparing {

namespace {

using html::words;

std::string lead(const CompareResult& result) {
    std::string out;
    if (!result.sentence.empty())
        out += html::element("p",
                   result.state == CompareResult::State::fails ? "class=\"verdict bad\"" : "class=\"verdict\"",
                   escape(result.sentence)) +
            "\n";
    else if (!result.assertions.empty()) out += "<p class=\"verdict good\">All assertions hold.</p>\n";
    std::vector<std::string> found;
    for (const std::string& sentence : found_about_means(result))
        if (sentence != result.sentence) found.push_back(escape(sentence));
    return out + (found.empty() ? "" : html::list(found));
}

/// All but the ladders, whose chart stands in a section of its own.
std::string pictures(const std::map<std::string, std::vector<unsigned char>>& plates) {
    std::string out;
    for (const auto& [name, png] : plates)
        if (name != "ladders")
            out += fmt::format(
                "<figure id=\"{0}\"><img alt=\"{0}\" width=\"1280\" height=\"720\" src=\"data:image/png;base64,{1}\" "
                "/></figure>\n",
                escape(name), base64(png));
    return out;
}

std::string assertions(const CompareResult& result) {
    if (result.assertions.empty()) return {};
    html::Table table("Assertions", {words("name"), words("claim"), {"left", true}, {"right", true}, words("verdict")});
    for (const AssertionResult& a : result.assertions)
        table.row({html::heading(escape(a.name)), words(html::code(a.text)), html::figure(figures(a.measured)),
            html::figure(figures(a.bound)), words(a.pass ? "holds" : "<b class=\"bad\">FAILS</b>")});
    return table.str();
}

}  // namespace

std::string compare_html(const ComparePlan& plan, const Readings& all, const CompareResult& result,
    const Provenance& provenance, const std::map<std::string, std::vector<unsigned char>>& plates) {
    PageFrame frame;
    frame.title_text = plan.title;
    frame.kicker_text = "renders compared";
    frame.version_text = provenance.version;
    frame.lead_html = lead(result);
    frame.footer_html =
        fmt::format("Made by crescent {}: {}", escape(provenance.version), html::code(provenance.command));
    return page_html(frame,
        {{"numbers", "How large the error is", numbers_section(plan, all, result)},
            {"rankings", "Which is better?", rankings_section(result)},
            {"bias", "Do they agree on the mean?", means_section(result)}, {"pictures", "Where", pictures(plates)},
            {"noise", "Where did the noise move?", noise_section(result)},
            {"ladders", "Over samples a pixel", ladders_section(result)},
            {"spectra", "What the noise is like", spectra_section(all, result)},
            {"assertions", "Assertions", assertions(result)}, {"files", "What was read", files_section(all, result)}});
}

}  // namespace crescent::inline comparing
