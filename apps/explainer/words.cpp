// Numbers are formatted by report/plates/sheet.h and carry their source. Markup is read character by character: literal
// words are searched for digits outside tags, and plain text is the text outside them, with entities resolved last.
#include "words.h"

#include <fmt/format.h>

#include <cmath>

namespace crescent::explainer {

Number figure(double value, int digits, const std::string& source) { return {plates::figure(value, digits), source}; }
Number number(double value, int digits, const std::string& source) { return {plates::number(value, digits), source}; }
Number count(std::uint64_t value, const std::string& source) { return {plates::count(value), source}; }
Number percent(double part, int digits, const std::string& source) {
    return {plates::number(100 * part, digits) + " %", source};
}
Number name(const std::string& text) { return {plates::escaped(text), "name in the experiment"}; }

namespace {

template <class Visit> void outside_tags(std::string_view markup, Visit visit) {
    bool in_tag = false;
    for (const char c : markup) {
        if (c == '<') in_tag = true;
        if (!in_tag) visit(c);
        if (c == '>') in_tag = false;
    }
}

void replace_all(std::string& text, std::string_view what, std::string_view replacement) {
    for (auto position = text.find(what); position != std::string::npos;
        position = text.find(what, position + replacement.size()))
        text.replace(position, what.size(), replacement);
}

}  // namespace

void Words::add(std::string_view words) {
    bool has_digit = false;
    outside_tags(words, [&](char c) { has_digit |= c >= '0' && c <= '9'; });
    ensure(!has_digit, "words of the film are typed without digits: a number comes in as a Number");
    parts_.push_back({std::string(words), ""});
}

std::string Words::markup() const {
    std::string text;
    for (const Part& part : parts_) text += part.markup;
    return text;
}

std::string plain_of(const std::string& markup) {
    std::string text = markup, plain;
    replace_all(text, "<sup>", "^");
    replace_all(text, "<sub>", "_");
    outside_tags(text, [&](char c) { plain += c; });
    const std::pair<const char*, const char*> entities[] = {
        {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&#39;", "'"}, {"&amp;", "&"}};
    for (const auto& [entity, character] : entities) replace_all(plain, entity, character);
    return plain;
}

std::string Words::plain() const { return plain_of(markup()); }

Words tinted(const Words& words, const plates::Colour& ink) {
    const auto byte = [](double v) { return static_cast<int>(std::lround(255 * v)); };
    const std::string tag =
        fmt::format("<span foreground='#{:02x}{:02x}{:02x}'>", byte(ink.r), byte(ink.g), byte(ink.b));
    return Words(tag.c_str(), words, "</span>");
}

Words strong(const Words& words) { return Words("<span weight='600'>", words, "</span>"); }

}  // namespace crescent::explainer
