// Look-ups in the table and its description in words.
#include "experiment/schema.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "experiment/assertion.h"
#include "experiment/combinations.h"
#include "experiment/schema_table.h"
#include "samplers/info.h"

namespace crescent {

namespace {

std::string bounds(const Key& key) {
    switch (key.type) {
        case Type::integer:
        case Type::number:
        case Type::point:
        case Type::factors:
        case Type::matrix:
        case Type::color:
        case Type::gray:
        case Type::numbers:
        case Type::integers:
        case Type::counts: return to_string(key.range);
        default: return "";
    }
}

std::string noun(const Key& key) {
    switch (key.type) {
        case Type::text: return "a line of text";
        case Type::texts: return "a text or a list of texts";
        case Type::check: return "a comparison of two quantities";
        case Type::word: return fmt::format("one of {}", listed(key.words, ", "));
        case Type::flag: return "true or false";
        case Type::integer: return "an integer";
        case Type::number: return "a number";
        case Type::point: return "3 numbers [x, y, z]";
        case Type::factors: return "a number, or 3 numbers [x, y, z],";
        case Type::matrix: return "12 numbers, 3 rows of 4,";
        case Type::direction: return "a unit vector [x, y, z]";
        case Type::color: return "3 numbers [r, g, b]";
        case Type::gray: return "a number, or 3 numbers [r, g, b],";
        case Type::numbers: return "ascending numbers";
        case Type::integers: return "ascending integers";
        case Type::counts: return "integers";
        case Type::formulas: return "a list of numbers or formulas";
        case Type::box: return "4 integers [x0, y0, x1, y1]";
        case Type::sampler: return "the name of a sampler";
        case Type::arm: return "the name of an arm";
        case Type::shape: return "the name of a shape or mesh";
    }
    return "";
}

}  // namespace

std::string to_string(const Range& range) {
    if (!range.low_open && !range.high_open) return fmt::format("from {} to {}", range.low, range.high);
    if (range.low_open && range.high_open) return fmt::format("above {} and below {}", range.low, range.high);
    return range.low_open ? fmt::format("above {}, up to {}", range.low, range.high)
                          : fmt::format("from {}, below {}", range.low, range.high);
}

std::string expectation(const Key& key) {
    std::string text = noun(key);
    if (const std::string range = bounds(key); !range.empty()) text += " " + range;
    if (!key.unit.empty()) text += fmt::format(" ({})", key.unit);
    return text;
}

bool has_kind(const Key& key, std::string_view kind) {
    if (key.kinds.empty() || kind.empty()) return true;
    return fmt::format(" {} ", key.kinds).find(fmt::format(" {} ", kind)) != std::string::npos;
}

const Key* Section::find_key(std::string_view key) const {
    const auto it = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == key; });
    return it == keys.end() ? nullptr : &*it;
}

const Section* Section::find_section(std::string_view section) const {
    const auto it = std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == section; });
    return it == sections.end() ? nullptr : &*it;
}

std::vector<std::string> words_of(const Section& section, std::string_view kind) {
    std::vector<std::string> words;
    for (const Key& key : section.keys)
        if (has_kind(key, kind)) words.emplace_back(key.name);
    for (const Section& sub : section.sections) words.emplace_back(sub.name);
    return words;
}

// ---- `crescent schema`: the table as text of at most 80 columns. json_schema.cpp prints it for editors.

namespace {

constexpr std::size_t columns = 80;

std::string section_path(const std::string& path, std::string_view name) {
    return path.empty() ? std::string(name) : fmt::format("{}.{}", path, name);
}

std::string path_of(const Section& section, const std::string& parent) {
    std::string path = section_path(parent, section.name);
    if (section.many == Multiplicity::named || section.many == Multiplicity::titled) path += ".NAME";
    if (section.many == Multiplicity::list) path += ".INDEX";
    return path;
}

/// Wraps words to lines of at most 80 columns, every line indented, the second and later ones by `hang` more.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t hang = 0) {
    std::string out, line(indent, ' ');
    for (std::size_t start = 0; start < text.size();) {
        const std::size_t end = std::min(text.find(' ', start), text.size());
        const std::string_view word = text.substr(start, end - start);
        if (line.size() > indent && line.size() + 1 + word.size() > columns) {
            out += line + "\n";
            indent += std::exchange(hang, 0);
            line.assign(indent, ' ');
        }
        if (line.size() > indent) line += ' ';
        line += word;
        start = end + 1;
    }
    return out + line + "\n";
}

std::string need_text(const Key& key) {
    if (key.need == Requirement::required) return "required";
    return fmt::format("default {}", key.default_value);
}

std::string key_text(const Key& key) {
    std::string line = fmt::format("{}: {}; {}", key.name, expectation(key), need_text(key));
    if (!key.kinds.empty()) line += "; of a " + alternatives(key.kinds);
    return wrapped(line, 2, 2) + wrapped(key.means, 6);
}

void print(const Section& section, const std::string& parent, std::string& out) {
    const std::string path = path_of(section, parent);
    if (!path.empty()) {
        const std::string header =
            section.many == Multiplicity::list ? "[[" + section_path(parent, section.name) + "]]" : "[" + path + "]";
        out += fmt::format("\n{}{}\n", header, section.need == Requirement::required ? "  (required)" : "");
    }
    out += wrapped(section.means, 0);
    for (const Key& key : section.keys) out += key_text(key);
    for (const Section& sub : section.sections) print(sub, path, out);
}

}  // namespace

std::string alternatives(std::string_view kinds) {
    std::string out;
    for (std::size_t start = 0; start < kinds.size();) {
        const std::size_t end = std::min(kinds.find(' ', start), kinds.size());
        if (start > 0) out += end == kinds.size() ? " or " : ", ";
        out += kinds.substr(start, end - start);
        start = end + 1;
    }
    return out;
}

std::string manual_of(const Section& root) {
    std::string out;
    print(root, "", out);
    return out;
}

std::string schema_text() {
    std::string out = manual_of(schema());
    out += "\nSamplers\n" + wrapped(listed(sampler_words(), ", "), 2);
    out += "\nQuantities of a check\n";
    for (const QuantityWord& word : quantity_words()) out += wrapped(form_of(word), 2) + wrapped(word.means, 6);
    return out;
}

}  // namespace crescent
