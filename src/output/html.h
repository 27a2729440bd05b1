// XHTML-compatible HTML5 in small pieces: every tag is closed, every attribute quoted, every name escaped. A function
// that takes `html` passes it on unchanged; one that takes `text` escapes it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace crescent::html {

/// <tag attributes>html</tag>; attributes as written, e.g. R"(class="note")".
std::string element(std::string_view tag, std::string_view attributes, std::string_view html);
inline std::string element(std::string_view tag, std::string_view html) { return element(tag, "", html); }

/// A paragraph, and text as code.
inline std::string p(std::string_view html) { return element("p", html) + "\n"; }
inline std::string code(std::string_view text) { return element("code", escape(text)); }
/// One command on a line of its own.
inline std::string command(std::string_view text) { return element("pre", element("code", escape(text))) + "\n"; }
inline std::string link(std::string_view id, std::string_view html) {
    return element("a", "href=\"#" + std::string(id) + "\"", html);
}
/// <ul> of items that are HTML already.
std::string list(const std::vector<std::string>& html_items);

/// "a, b and c".
std::string join(const std::vector<std::string>& html_items);
/// Escaped, with a true minus sign before digits.
std::string number(std::string_view text);
/// A number in a sentence keeps its digits together and in tabular figures.
inline std::string value(std::string_view text) { return element("span", "class=\"v\"", number(text)); }

/// "heavy tail", in the place of an interval.
std::string heavy_tail();

/// One cell; `head` makes it a row's heading, `number` aligns it to the right.
struct Cell {
    std::string html;
    bool number = false;
    bool head = false;
    int rows = 1;    // rowspan
    int across = 1;  // colspan
};
/// Cells of words, of a number, and a heading of rows.
Cell words(std::string html);
Cell figure(std::string_view text);  // number(), right-aligned; "" becomes an en dash
Cell heading(std::string html, int rows = 1);

/// A table that scrolls separately on a narrow screen and is never cut inside a row on paper.
class Table {
public:
    Table(std::string caption_html, std::vector<Cell> head)
        : caption_(std::move(caption_html)), head_(std::move(head)) {}
    void row(const std::vector<Cell>& cells);
    /// Adds a heading across the table for the rows that follow.
    void group(std::string_view html);
    bool empty() const { return rows_ == 0; }
    std::string str() const;

private:
    std::string caption_;
    std::vector<Cell> head_;
    std::string body_;
    std::size_t rows_ = 0;
    bool grouped_ = false;
};

}  // namespace crescent::html

// ---- The frame of every page: head, title, contents, sections, footer; one style sheet, light and dark, on paper and
// on small screens.

namespace crescent::inline output {

struct PageSection {
    std::string id, title, html;  // a section with empty html is omitted
};

/// Parts named `html` and `text` as above: the former are passed on, the latter escaped.
struct PageFrame {
    std::string title_text, kicker_text, version_text;
    std::string lead_html;    // under the title
    std::string footer_html;  // the last line
    std::string head_html;    // styles and scripts of this kind of page
    bool contents = false;    // numbers the sections and lists them
};

/// The whole page, XHTML-compatible where its parts are.
std::string page_html(const PageFrame& frame, const std::vector<PageSection>& sections);

}  // namespace crescent::inline output
