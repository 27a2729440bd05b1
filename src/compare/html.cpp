// report.html of a comparison: what was found, the numbers with their doubt, the pictures, the spectra, the files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/base64.h"
#include "compare/outputs.h"
#include "compare/page.h"
#include "report/html.h"
#include "report/numbers.h"
#include "report/style.h"

namespace crescent {

namespace {

using html::words;

constexpr const char* frame = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8" />
<meta name="viewport" content="width=device-width, initial-scale=1" />
<meta name="color-scheme" content="light dark" />
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<header>
<p class="kicker">crescent · renders compared</p>
<h1>{title}</h1>
{lead}
</header>
<main id="main">
{sections}</main>
<footer>
<p class="footnote">Made by crescent {version}: <code>{command}</code></p>
</footer>
</body>
</html>
)";

std::string section(const std::string& id, const std::string& title, const std::string& html) {
    if (html.empty()) return {};
    return fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n{2}</section>\n", id, title,
        html);
}

std::string lead(const CompareResult& result) {
    std::string out;
    if (!result.say.empty())
        out += html::element("p",
                   result.state == CompareResult::State::fails ? "class=\"verdict bad\"" : "class=\"verdict\"",
                   escape(result.say)) +
            "\n";
    else if (!result.assertions.empty()) out += "<p class=\"verdict good\">All assertions hold.</p>\n";
    std::vector<std::string> found;
    for (const BiasResult& b : result.bias) found.push_back(escape(b.sentence));
    return out + (found.empty() ? "" : html::list(found));
}

std::string pictures(const std::map<std::string, std::vector<unsigned char>>& plates) {
    std::string out;
    for (const auto& [name, png] : plates)
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
    const std::string sections = section("numbers", "How large the error is", numbers_section(plan, all, result)) +
        section("rankings", "Which is better?", rankings_section(result)) +
        section("bias", "Do they agree on the mean?", means_section(result)) +
        section("pictures", "Where", pictures(plates)) +
        section("noise", "Where did the noise move?", noise_section(result)) +
        section("ladders", "Over samples a pixel", ladders_section(result)) +
        section("spectra", "What the noise is like", spectra_section(all, result)) +
        section("assertions", "Assertions", assertions(result)) +
        section("files", "What was read", files_section(all, result));
    return fmt::format(frame, fmt::arg("title", escape(plan.title)), fmt::arg("style", style_sheet),
        fmt::arg("lead", lead(result)), fmt::arg("sections", sections), fmt::arg("version", escape(provenance.version)),
        fmt::arg("command", escape(provenance.command)));
}

}  // namespace crescent
