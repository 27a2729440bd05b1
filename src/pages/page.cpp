// One template, filled by name; contents and sections are written in one walk over the sections that have html.
#include "pages/page.h"

#include <fmt/format.h>

#include "pages/html.h"
#include "pages/style.h"

namespace crescent::inline pages {

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

}  // namespace crescent::inline pages
