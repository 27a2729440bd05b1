// Strings composed by {fmt}. A table opens a <tbody> at its first row and at each group; heading cells declare their
// `scope`, and a true minus is set only before digits.
#include "output/html.h"

#include <fmt/format.h>

namespace crescent::html {
namespace {

std::string cell(const Cell& c, std::string_view scope) {
    std::string attributes;
    if (!scope.empty()) attributes += fmt::format(" scope=\"{}\"", scope);
    if (c.number) attributes += " class=\"n\"";
    if (c.rows > 1) attributes += fmt::format(" rowspan=\"{}\"", c.rows);
    if (c.across > 1) attributes += fmt::format(" colspan=\"{}\"", c.across);
    const std::string_view tag = scope.empty() ? "td" : "th";
    return fmt::format("<{}{}>{}</{}>", tag, attributes, c.html, tag);
}

}  // namespace

std::string element(std::string_view tag, std::string_view attributes, std::string_view html) {
    return fmt::format("<{}{}{}>{}</{}>", tag, attributes.empty() ? "" : " ", attributes, html, tag);
}

std::string list(const std::vector<std::string>& html_items) {
    std::string items;
    for (const std::string& item : html_items) items += element("li", item) + "\n";
    return element("ul", "\n" + items) + "\n";
}

std::string join(const std::vector<std::string>& html_items) {
    std::string out;
    for (std::size_t i = 0; i < html_items.size(); ++i)
        out += (i == 0 ? "" : i + 1 == html_items.size() ? " and " : ", ") + html_items[i];
    return out;
}

std::string number(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool minus = text[i] == '-' && i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
        out += minus ? "−" : std::string(1, text[i]);
    }
    return escape(out);
}

std::string heavy_tail() { return element("span", "class=\"heavy\"", "heavy tail"); }

Cell words(std::string html) { return {std::move(html), false, false, 1, 1}; }
Cell figure(std::string_view text) { return {text.empty() ? "–" : number(text), true, false, 1, 1}; }
Cell heading(std::string html, int rows) { return {std::move(html), false, true, rows, 1}; }

void Table::row(const std::vector<Cell>& cells) {
    if (!grouped_ && rows_ == 0) body_ += "<tbody>\n";
    body_ += "<tr>";
    for (const Cell& c : cells) body_ += cell(c, c.head ? "row" : "");
    body_ += "</tr>\n";
    ++rows_;
}

void Table::group(std::string_view html) {
    if (grouped_ || rows_ > 0) body_ += "</tbody>\n";
    body_ += fmt::format(
        "<tbody>\n<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n", head_.size(), html);
    grouped_ = true;
}

std::string Table::str() const {
    std::string head;
    for (const Cell& c : head_) head += cell(c, "col");
    const std::string end = grouped_ || rows_ > 0 ? "</tbody>" : "";
    return fmt::format(
        "<div class=\"table\" tabindex=\"0\" role=\"region\" aria-label=\"table, may scroll sideways\"><table>\n"
        "<caption>{}</caption>\n<thead><tr>{}</tr></thead>\n{}{}</table></div>\n",
        caption_, head, body_, end);
}

}  // namespace crescent::html

// ---- One template, filled by name; contents and sections are written in one pass over the sections that have html.

namespace crescent::inline output {

namespace {

constexpr const char* frame_html = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8" />
<meta name="viewport" content="width=device-width, initial-scale=1" />
<meta name="color-scheme" content="light dark" />
<meta name="generator" content="crescent {version}" />
<title>{title}</title>
<style>{style}</style>
{head}</head>
<body>
<a class="skip" href="#main">Skip to the text</a>
<header>
<p class="kicker">crescent · {kicker}</p>
<h1>{title}</h1>
{lead}{contents}</header>
<main id="main">
{sections}</main>
<footer>
<p class="footnote">{footer}</p>
</footer>
</body>
</html>
)";

}  // namespace

std::string page_html(const PageFrame& frame, const std::vector<PageSection>& sections) {
    std::string contents, all;
    std::size_t number = 0;
    for (const PageSection& s : sections) {
        if (s.html.empty()) continue;
        contents += fmt::format("<li>{}</li>\n", html::link(s.id, s.title));
        const std::string before = frame.contents ? fmt::format("<span class=\"number\">{}</span>", ++number) : "";
        all += fmt::format(
            "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}<a "
            "href=\"#{0}\">{2}</a></h2>\n"
            "{3}</section>\n",
            s.id, before, s.title, s.html);
    }
    if (frame.contents)
        contents = "<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n" + contents + "</ol>\n</nav>\n";
    return fmt::format(fmt::runtime(frame_html), fmt::arg("version", escape(frame.version_text)),
        fmt::arg("title", escape(frame.title_text)), fmt::arg("style", style_sheet), fmt::arg("head", frame.head_html),
        fmt::arg("kicker", escape(frame.kicker_text)), fmt::arg("lead", frame.lead_html),
        fmt::arg("contents", frame.contents ? contents : ""), fmt::arg("sections", all),
        fmt::arg("footer", frame.footer_html));
}

// ---- CSS in one string: custom properties for light, dark and paper, then text, tables, figures and the classes of
// charts; lengths mostly in rem, in charts in pixels.

// Colours of c0..c5: Okabe and Ito's palette for colour-blind readers, darkened for light ground and lightened for
// dark.
const char* const style_sheet = R"css(
:root { color-scheme: light dark;
  --ground: #fdfdfb; --ink: #1d2125; --soft: #575f68; --line: #d9dbd7; --tint: #f2f2ee; --accent: #7a4a00;
  --bad: #b3261e; --good: #14683a;
  --c0: #5d6770; --c1: #0062a3; --c2: #b34a00; --c3: #00775a; --c4: #96306f; --c5: #7d6a00; }
@media (prefers-color-scheme: dark) { :root {
  --ground: #15181b; --ink: #e7e8e6; --soft: #a5adb4; --line: #363c41; --tint: #1e2226; --accent: #f0b45a;
  --bad: #ff8a7d; --good: #7fd6a2;
  --c0: #a9b3bb; --c1: #64b8f2; --c2: #f39a4d; --c3: #3fc8a0; --c4: #e38bc1; --c5: #d8c24a; } }
* { box-sizing: border-box; }
html { font: 17px/1.62 Inter, system-ui, -apple-system, "Segoe UI", "Helvetica Neue", Arial, sans-serif;
  background: var(--ground); color: var(--ink);
  -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
body { margin: 0; padding: 0 1.25rem 5rem; }
main, header, footer { max-width: 38rem; margin: 0 auto; }
h1, h2, h3 { line-height: 1.22; letter-spacing: -0.012em; text-wrap: balance; }
h1 { font-size: 2.35rem; margin: 0.2rem 0 0.6rem; font-weight: 700; }
h2 { font-size: 1.5rem; margin: 4rem 0 1rem; padding-top: 1.2rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.1rem; margin: 2.2rem 0 0.6rem; }
h2 .number { color: var(--soft); font-weight: 400; margin-right: 0.55em; font-variant-numeric: tabular-nums; }
h2 a { color: inherit; text-decoration: none; }
h2 a:hover, h2 a:focus { text-decoration: underline; text-decoration-thickness: 1px; }
main section:first-child h2 { border-top: 0; margin-top: 1.5rem; }
sub, sup { line-height: 0; }
p { margin: 0 0 1rem; hyphens: auto; }
a { color: var(--accent); text-underline-offset: 0.16em; }
ul { padding-left: 1.2rem; } li { margin-bottom: 0.55rem; }
code, pre { font: 0.86em/1.5 ui-monospace, "JetBrains Mono", "DejaVu Sans Mono", Menlo, Consolas, monospace;
  overflow-wrap: anywhere; }
pre { background: var(--tint); padding: 0.55rem 0.8rem; border-radius: 4px; margin: 0.3rem 0; white-space: pre-wrap; }
.v { font-variant-numeric: tabular-nums; white-space: nowrap; }
.heavy { font-style: italic; color: var(--accent); white-space: nowrap; }
.bad { color: var(--bad); } .good { color: var(--good); }
.kicker { margin: 4rem 0 0; font-size: 0.8rem; letter-spacing: 0.09em; text-transform: uppercase; color: var(--soft); }
.lead { font-size: 1.16rem; line-height: 1.55; }
.verdict { font-weight: 600; }
.footnote { font-size: 0.84rem; color: var(--soft); }
.skip { position: absolute; left: -100rem; } .skip:focus { left: 1rem; top: 1rem; background: var(--ground); }
nav { margin: 2.5rem 0 0; padding: 1rem 0; border-top: 1px solid var(--line); border-bottom: 1px solid var(--line); }
nav h2 { font-size: 0.8rem; letter-spacing: 0.09em; text-transform: uppercase; color: var(--soft); margin: 0 0 0.5rem;
  padding: 0; border: 0; }
nav ol { columns: 2; column-gap: 2.5rem; margin: 0; padding-left: 1.7rem; font-size: 0.94rem; }
nav li { margin-bottom: 0.2rem; }
nav li::marker { color: var(--soft); font-variant-numeric: tabular-nums; }
nav a { color: inherit; text-decoration: none; } nav a:hover, nav a:focus { text-decoration: underline; }
.equation { overflow-x: auto; overflow-y: hidden; margin: 1.2rem 0; padding: 0.1rem 0; }
math { font-family: "STIX Two Math", "Latin Modern Math", "Cambria Math", "DejaVu Math TeX Gyre", math; }
math[display="block"] { font-size: 1.12em; }
figure, .table, .wide { margin: 2rem 0; }
figure img, figure svg.chart { display: block; width: 100%; height: auto; }
figure img { border-radius: 3px; background: #000; }
figcaption, caption { font-size: 0.84rem; line-height: 1.5; color: var(--soft); text-align: left; }
figcaption { margin-top: 0.6rem; } figcaption b, caption b { color: var(--ink); }
.kind { display: inline-block; font-size: 0.7rem; letter-spacing: 0.05em; text-transform: uppercase;
  border: 1px solid var(--line); border-radius: 3px; padding: 0 0.4em; }
.made { display: block; margin-top: 0.15rem; font-size: 0.94em; } .made code { color: var(--soft); }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 1rem; }
.pair .panel-title { margin: 0; font-size: 0.8rem; font-weight: 600; }
.table { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 0.82rem; line-height: 1.4;
  font-variant-numeric: tabular-nums lining-nums; }
caption { padding-bottom: 0.5rem; caption-side: top; }
th, td { padding: 0.38rem 0.7rem 0.38rem 0; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--line); }
th:last-child, td:last-child { padding-right: 0; }
thead th { vertical-align: bottom; font-weight: 600; border-bottom: 1.5px solid var(--soft); }
tbody th { font-weight: 500; }
td math { font-size: 1.1em; }
.n { text-align: right; } td.n, td.n .v { white-space: nowrap; }
td small, th small { display: block; color: var(--soft); font-size: 0.9em; font-weight: 400; }
tr.group th { padding-top: 1.3rem; font-weight: 700; border-bottom: 1.5px solid var(--line); }
dl.what-if dt { font-weight: 600; margin-top: 1.2rem; } dl.what-if dd { margin: 0; }
dl.what-if dd p { color: var(--soft); font-size: 0.92rem; margin: 0; }
svg text { font-family: inherit; font-size: 12px; fill: var(--soft); } svg .tick { font-variant-numeric: tabular-nums; }
svg .label { fill: var(--ink); }
svg .grid { stroke: var(--line); stroke-width: 1; fill: none; }
svg .axis { stroke: var(--soft); stroke-width: 1; fill: none; }
svg .line { fill: none; stroke: currentColor; stroke-width: 1.8; stroke-linejoin: round; }
svg .dot { fill: currentColor; stroke: var(--ground); stroke-width: 1; }
svg .diamond { fill: var(--ground); stroke: currentColor; stroke-width: 1.6; }
svg .area { fill: currentColor; opacity: 0.3; } svg .area.faint { opacity: 0.14; }
svg .rule { stroke: currentColor; stroke-width: 1.3; fill: none; }
svg .dashed { stroke-dasharray: 5 4; stroke-width: 1.2; } svg .strong { color: var(--ink); }
svg .name { fill: currentColor; font-size: 11.5px; font-weight: 600; paint-order: stroke; stroke: var(--ground);
  stroke-width: 3px; }
svg .c0 { color: var(--c0); } svg .c1 { color: var(--c1); } svg .c2 { color: var(--c2); } svg .c3 { color: var(--c3); }
svg .c4 { color: var(--c4); } svg .c5 { color: var(--c5); }
svg.strip { vertical-align: middle; } svg .reach { fill: var(--c1); opacity: 0.25; }
svg .median { stroke: var(--c1); stroke-width: 2; } svg .meas { color: var(--c1); } svg .pub { color: var(--c2); }
@media (min-width: 64rem) { figure, .wide, .table { width: 58rem; margin-left: calc((38rem - 58rem) / 2); }
  figure.narrow { width: auto; margin-left: 0; } .wide .table { margin: 0; width: auto; }
  .table table { width: auto; min-width: 38rem; margin: 0 auto; } }
@media (max-width: 40rem) { html { font-size: 16px; } nav ol { columns: 1; } .pair { grid-template-columns: 1fr; }
  h1 { font-size: 1.9rem; } }
@media print {
  @page { size: A4; margin: 18mm 16mm; }
  :root { color-scheme: light; --ground: #fff; --ink: #000; --soft: #444; --line: #bbb; --tint: #f2f2f2;
    --accent: #5a3600;
    --c0: #5d6770; --c1: #0062a3; --c2: #b34a00; --c3: #00775a; --c4: #96306f; --c5: #7d6a00; }
  html { font-size: 10pt; line-height: 1.45; } body { padding: 0; } main, header, footer { max-width: none; }
  .skip { display: none; }
  figure, .wide, .table { width: auto; margin-left: 0; } .table { overflow: visible; } table { font-size: 7.4pt; }
  th, td { padding-right: 0.45rem; }
  td.n, td.n .v { white-space: normal; } svg.strip { width: 86px; }
  h2, h3 { break-after: avoid; } h2 { margin-top: 2.2rem; } figure, tr, .equation, dd { break-inside: avoid; }
  thead { display: table-header-group; } tr.group, dt { break-after: avoid; }
  a { color: inherit; } .equation { overflow: visible; } figure.narrow svg { max-width: 130mm; margin: 0 auto; }
}
)css";

}  // namespace crescent::inline output
