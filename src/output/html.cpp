// Strings composed by {fmt}. A table opens a <tbody> at its first row and at each group; heading cells declare their
// `scope`, and a true minus is set only before digits.
#include "output/html.h"

#include <fmt/format.h>

#include "output/templates.h"

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
        fmt::arg("title", escape(frame.title_text)),
        fmt::arg("style", render_page(output_templates(), "style.css", {})), fmt::arg("head", frame.head_html),
        fmt::arg("kicker", escape(frame.kicker_text)), fmt::arg("lead", frame.lead_html),
        fmt::arg("contents", frame.contents ? contents : ""), fmt::arg("sections", all),
        fmt::arg("footer", frame.footer_html));
}

}  // namespace crescent::inline output
