// The frame of every page of crescent's: head, title, contents, sections, footer; one style sheet, light and dark, on
// paper and on a telephone.
#pragma once

#include <string>
#include <vector>

namespace crescent::inline pages {

struct PageSection {
    std::string id, title, html;  // a section whose html is empty has nothing to say and is left out
};

/// Parts named `html` and `text` as in pages/html.h: the former are passed on, the latter escaped.
struct PageFrame {
    std::string title_text, kicker_text, version_text;
    std::string lead_html;    // under the title
    std::string footer_html;  // the last line
    std::string head_html;    // styles and scripts of this kind of page
    bool contents = false;    // numbers the sections and lists them
};

/// The whole page, XHTML-compatible where its parts are.
std::string page_html(const PageFrame& frame, const std::vector<PageSection>& sections);

}  // namespace crescent::inline pages
