// TOML text -> Node, by toml++. TOML v1.0.0; lines and columns counted from 1.
#include "experiment/tree.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace crescent {

namespace {

// The deepest key is plates.NAME.runs.0.arm; deeper ones are ignored.
constexpr int deepest = 8;
// The parser builds one table per dot of a key and destroys them recursively: this bounds the stack it needs.
constexpr int most_dots = 32;
constexpr std::size_t most_bytes = std::size_t{4} << 20;

SourceLocation place_of(const toml::source_region& region, const std::string& file) {
    return {file, static_cast<unsigned>(region.begin.line), static_cast<unsigned>(region.begin.column)};
}

Node convert(const toml::node& from, const std::string& file, int depth);

void convert_members(const toml::table& table, Node& to, const std::string& file, int depth) {
    for (const auto& [key, value] : table)
        to.members.push_back({std::string(key.str()), place_of(key.source(), file), convert(value, file, depth + 1)});
    std::sort(to.members.begin(), to.members.end(), [](const Member& a, const Member& b) {
        return std::tie(a.location.line, a.location.column, a.key) <
            std::tie(b.location.line, b.location.column, b.key);
    });
    if (to.location.line == 0 && !to.members.empty()) to.location = to.members.front().location;
}

Node convert(const toml::node& from, const std::string& file, int depth) {
    Node to;
    to.location = place_of(from.source(), file);
    if (const auto* table = from.as_table()) {
        if (depth < deepest) convert_members(*table, to, file, depth);
    } else if (const auto* array = from.as_array()) {
        to.kind = Node::Kind::array;
        if (depth < deepest)
            for (const auto& item : *array)
                to.members.push_back({"", place_of(item.source(), file), convert(item, file, depth + 1)});
    } else if (const auto* text = from.as_string()) {
        to.kind = Node::Kind::text;
        to.text = text->get();
    } else if (const auto* integer = from.as_integer()) {
        to.kind = Node::Kind::integer;
        to.integer = integer->get();
        to.number = static_cast<double>(to.integer);
    } else if (const auto* number = from.as_floating_point()) {
        to.kind = Node::Kind::number;
        to.number = number->get();
    } else if (const auto* flag = from.as_boolean()) {
        to.kind = Node::Kind::flag;
        to.flag = flag->get();
    } else {
        to.kind = Node::Kind::date;
    }
    return to;
}

/// Rejects text for which the parser would need unbounded stack or time.
void refuse_junk(std::string_view text, const std::string& file) {
    if (text.size() > most_bytes)
        throw InputError(
            {file, 0, 0}, fmt::format("expected an experiment of at most {} MiB, found more", most_bytes >> 20));
    unsigned line = 1, column = 1;
    int dots = 0;
    for (const char c : text) {
        if (c == '.' && ++dots > most_dots)
            throw InputError({file, line, column},
                fmt::format("expected a key of at most 5 names, found more than {} dots in one run", most_dots));
        if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) dots = 0;
        if (c == '\n') {
            ++line;
            column = 0;
        }
        ++column;
    }
}

}  // namespace

const Member* Node::find(std::string_view key) const {
    const auto it = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.key == key; });
    return it == members.end() ? nullptr : &*it;
}
Member* Node::find(std::string_view key) { return const_cast<Member*>(static_cast<const Node*>(this)->find(key)); }

std::string describe(const Node& node) {
    switch (node.kind) {
        case Node::Kind::table: return "a table";
        case Node::Kind::array: return fmt::format("a list of {}", node.members.size());
        case Node::Kind::text:
            return node.text.size() > 60 ? fmt::format("the text '{}...'", node.text.substr(0, 57))
                                         : fmt::format("the text '{}'", node.text);
        case Node::Kind::integer: return fmt::format("{}", node.integer);
        case Node::Kind::number:
            return node.number == std::floor(node.number) && std::fabs(node.number) < 1e15
                ? fmt::format("{:.1f}", node.number)
                : fmt::format("{}", node.number);
        case Node::Kind::flag: return node.flag ? "true" : "false";
        case Node::Kind::date: return "a date or time";
    }
    return "";
}

Node read_toml(std::string_view text, const std::string& file) {
    refuse_junk(text, file);
    try {
        return convert(toml::parse(text, std::string_view(file)), file, 0);
    } catch (const toml::parse_error& error) {
        const bool is_redefined = error.description().find("cannot redefine") != std::string_view::npos;
        throw InputError(place_of(error.source(), file),
            fmt::format("{}{}",
                is_redefined ? "duplicate name; expected each to be given once: " : "not TOML: ", error.description()));
    }
}

}  // namespace crescent
