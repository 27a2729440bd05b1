// --set path=value: the tree is changed before it is read, so that an override passes the same checks as the file. A
// path is a full one (shapes.sphere.s) or starts at a name (sphere.s); list items are .0 or [0].
#include "experiment/overrides.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "experiment/identity.h"
#include "experiment/parser.h"
#include "experiment/schema_table.h"
#include "experiment/tree.h"
#include "experiment/value.h"

namespace crescent {

namespace {

using Segments = std::vector<std::string>;

/// "a.'b c'.d[2]" -> a, b c, d, 2.
Segments split(std::string_view path) {
    Segments segments(1);
    char quote = 0;
    for (const char c : path) {
        if (quote) {
            if (c == quote) quote = 0;
            else segments.back() += c;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '.' || c == '[') {
            segments.emplace_back();
        } else if (c != ']') {
            segments.back() += c;
        }
    }
    return segments;
}

std::string_view trim(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

std::optional<std::size_t> index_of(const std::string& segment) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(segment.data(), segment.data() + segment.size(), index);
    return error == std::errc{} && end == segment.data() + segment.size() ? std::optional(index) : std::nullopt;
}

/// Returns whether the table has this path; names of the user's choice are accepted as they are.
bool in_table(const Section& section, const Segments& path, std::size_t i) {
    if (i >= path.size()) return true;
    if (section.find_key(path[i])) return i + 1 == path.size() || (i + 2 == path.size() && index_of(path[i + 1]));
    const Section* sub = section.find_section(path[i]);
    return sub && in_table(*sub, path, i + (sub->many == Multiplicity::one ? 1 : 2));
}

std::string name_of(const Member& member) {
    const Member* name = member.key.empty() ? member.value.find("name") : nullptr;
    return name ? name->value.text : member.key;
}

Member* step(Node& node, const std::string& segment) {
    if (node.is_table()) return node.find(segment);
    if (const auto index = index_of(segment)) return *index < node.members.size() ? &node.members[*index] : nullptr;
    const auto match =
        std::find_if(node.members.begin(), node.members.end(), [&](const Member& m) { return name_of(m) == segment; });
    return match == node.members.end() ? nullptr : &*match;
}

void move_to(Node& node, const SourceLocation& place) {
    node.location = place;
    for (Member& member : node.members) {
        member.location = place;
        move_to(member.value, place);
    }
}

class Override {
public:
    Override(ParseContext& context, Node& root, const std::string& text)
        : draft_(context), root_(root), place_{"--set " + text, 0, 0} {}

    void apply(const std::string& text) {
        const std::size_t equals = end_of_path(text);
        if (equals == std::string::npos) return fail("expected path=value, e.g. sphere.s=64");
        path_text_ = std::string(trim(std::string_view(text).substr(0, equals)));
        Node value;
        if (!parse_value(std::string(trim(std::string_view(text).substr(equals + 1))), value)) return;
        Segments path = split(path_text_);
        if (std::any_of(path.begin(), path.end(), [](const std::string& s) { return s.empty(); }) || path.size() > 8)
            return fail(fmt::format("expected a path such as sphere.s or shapes.sphere.s, found '{}'", path_text_));
        if (resolve(path)) set(path, std::move(value));
    }

private:
    void fail(const std::string& message, Diagnostic::Kind kind = Diagnostic::Kind::other) {
        draft_.report(path_text_, place_, message, kind);
    }

    /// Parses a value as TOML if it is TOML, else as bare text.
    bool parse_value(const std::string& text, Node& value) {
        try {
            Node tree = read_toml("value = " + text, place_.file);
            if (tree.members.size() == 1 && tree.members[0].key == "value") value = std::move(tree.members[0].value);
            else {
                value.kind = Node::Kind::text;
                value.text = text;
            }
        } catch (const InputError& error) {
            if (text.empty()) return fail("expected a value after '='"), false;
            if (std::string_view("[{\"'").find(text[0]) != std::string_view::npos)
                return fail(fmt::format("the value: {}", error.diagnostics().front().message)), false;
            value.kind = Node::Kind::text;
            value.text = text;
        }
        move_to(value, place_);
        return true;
    }

    /// Completes a path that starts at a name with the family of that name.
    bool resolve(Segments& path) {
        if (in_table(schema(), path, 0)) return true;
        std::vector<Segments> valid, paths;
        std::vector<std::string> words = words_of(schema());
        const bool is_top = std::count(words.begin(), words.end(), path[0]);
        for (const Section& section : schema().sections) {
            const Member* family = root_.find(section.name);
            if (section.many == Multiplicity::one || !family) continue;
            for (const Member& member : family->value.members) {
                words.push_back(name_of(member));
                if (words.back() != path[0]) continue;
                paths.push_back(path);
                paths.back().insert(paths.back().begin(), std::string(section.name));
                if (in_table(schema(), paths.back(), 0)) valid.push_back(paths.back());
            }
        }
        if (valid.size() > 1)
            return fail(fmt::format("'{}' is ambiguous: expected {}.{} or {}.{}", path_text_, valid[0][0], path_text_,
                       valid[1][0], path_text_)),
                   false;
        if (valid.empty() && !is_top && paths.empty()) {
            const std::string suggestion = hint(path[0], words);
            fail(fmt::format(
                     "no key or name '{}': expected a key of the schema or the name of a shape, disk, arm, ...{}",
                     path[0], suggestion),
                suggestion.empty() ? Diagnostic::Kind::unknown_name : Diagnostic::Kind::misspelt_name);
            return false;
        }
        if (!valid.empty()) path = valid[0];
        else if (!is_top) path = paths[0];  // the parser reports what is wrong with its key
        return true;
    }

    void set(const Segments& path, Node value) {
        Node* node = &root_;
        for (std::size_t i = 0; i < path.size(); ++i) {
            // `content` is the hash of the files of its table: it does not hold for another file.
            if (i + 1 == path.size() && (path[i] == "file" || path[i].ends_with("_texture")))
                std::erase_if(node->members, [](const Member& member) { return member.key == "content"; });
            Member* child = node->is_table() || node->is_array() ? step(*node, path[i]) : nullptr;
            if (!child) {
                if (!node->is_table())
                    return fail(fmt::format("no '{}' in '{}': expected {}", path[i],
                        listed(Segments(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(i)), "."),
                        node->is_array() && !node->members.empty()
                            ? fmt::format("an index from 0 to {}", node->members.size() - 1)
                            : "no more keys after it"));
                node->members.push_back({path[i], place_, Node{}});
                child = &node->members.back();
                child->value.location = place_;
            }
            if (i + 1 == path.size()) child->location = place_;
            node = &child->value;
        }
        *node = std::move(value);
    }

    ParseContext& draft_;
    Node& root_;
    SourceLocation place_;
    std::string path_text_;
};

// ---- The tree as TOML: tables of tables are inline.

std::string toml_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') out += '\\';
        if (byte < 0x20 || byte == 0x7f) out += fmt::format("\\u{:04x}", byte);
        else out += c;
    }
    return out + '"';
}

std::string number_text(double x) {
    if (std::isnan(x)) return "nan";
    if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
    const std::string text = fmt::format("{}", x);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string toml_text(const Node& node) {
    switch (node.kind) {
        case Node::Kind::text: return toml_string(node.text);
        case Node::Kind::integer: return fmt::format("{}", node.integer);
        case Node::Kind::number: return number_text(node.number);
        case Node::Kind::flag: return node.flag ? "true" : "false";
        case Node::Kind::date: return node.text;
        case Node::Kind::table:
        case Node::Kind::array: break;
    }
    std::string entries;
    for (const Member& member : node.members)
        entries += (entries.empty() ? "" : ", ") + (node.is_table() ? toml_string(member.key) + " = " : "") +
            toml_text(member.value);
    return node.is_table() ? "{" + entries + "}" : "[" + entries + "]";
}

}  // namespace

std::string text_with_overrides(
    std::string_view text, const std::string& name, const std::vector<std::string>& overrides) {
    ParseContext context;
    Node root = read_toml(text, name);
    apply_overrides(context, root, overrides);
    throw_if_any(std::move(context.diagnostics));
    std::string out;
    for (const Member& member : root.members) out += toml_string(member.key) + " = " + toml_text(member.value) + "\n";
    return out;
}

void apply_overrides(ParseContext& context, Node& root, const std::vector<std::string>& overrides) {
    for (const std::string& text : overrides) Override(context, root, text).apply(text);
}

}  // namespace crescent
