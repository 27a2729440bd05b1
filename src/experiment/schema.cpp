// Look-ups in the table and what it says of itself in words.
#include "experiment/schema.h"

#include <fmt/format.h>

#include <algorithm>

namespace crescent::inline experiment {

namespace {

std::string bounds(const Key& key) {
    switch (key.type) {
        case Type::integer:
        case Type::number:
        case Type::point:
        case Type::color:
        case Type::gray:
        case Type::numbers:
        case Type::integers: return to_string(key.range);
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
        case Type::direction: return "a unit vector [x, y, z]";
        case Type::color: return "3 numbers [r, g, b]";
        case Type::gray: return "a number, or 3 numbers [r, g, b],";
        case Type::numbers: return "ascending numbers";
        case Type::integers: return "ascending integers";
        case Type::box: return "4 integers [x0, y0, x1, y1]";
        case Type::sampler: return "the name of a sampler";
        case Type::arm: return "the name of an arm";
        case Type::shape: return "the name of a shape";
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

}  // namespace crescent::inline experiment
