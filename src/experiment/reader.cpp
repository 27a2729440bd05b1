// The table walked over the tree: which tables and keys there are, which are missing, what each value is.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiment/parse_context.h"

namespace crescent::inline experiment {

namespace {

constexpr std::size_t most_elements = 4096;  // of a family of tables; a film counts shapes in 16 bits

bool file_safe(std::string_view name) {
    const auto plain = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '_'); };
    return !name.empty() && name.size() <= 64 && plain(static_cast<unsigned char>(name[0])) &&
        std::all_of(name.begin(), name.end(), [&](unsigned char c) { return plain(c) || c == '.' || c == '-'; });
}

bool one_line(std::string_view name) {
    return !name.empty() && name.size() <= 200 &&
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return c >= 0x20 && c != 0x7f; });
}

std::string join(const std::string& path, std::string_view name) {
    return path.empty() ? std::string(name) : fmt::format("{}.{}", path, name);
}

std::string where(const std::string& path) { return path.empty() ? "the file" : "[" + path + "]"; }

class TreeReader {
public:
    explicit TreeReader(ParseContext& context) : draft_(context) {}

    void table(
        const Section& section, const Node& node, const std::string& path, const SourceLocation& at, void* object) {
        const std::string kind = kind_of(section, node);
        unknown_keys(section, node, path, kind);
        for (const Key& key : section.keys) {
            if (!has_kind(key, kind)) continue;
            const Member* member = node.find(key.name);
            if (member) value(key, member->value, join(path, key.name), object);
            else if (key.need == Requirement::required) missing_key(key, path, at, kind);
            else if (key.need == Requirement::defaulted) default_value(key, join(path, key.name), object);
        }
        for (const Section& sub : section.sections) family(sub, node, join(path, sub.name), at, object);
    }

    std::vector<std::string> siblings;  // names beside the table that is being read

private:
    static std::string kind_of(const Section& section, const Node& node) {
        const Key* key = section.find_key("kind");
        const Member* member = node.find("kind");
        if (!key || !member || member->value.kind != Node::Kind::text) return "";
        return std::count(key->words.begin(), key->words.end(), member->value.text) ? member->value.text : "";
    }

    void unknown_keys(const Section& section, const Node& node, const std::string& path, const std::string& kind) {
        for (const Member& member : node.members) {
            const Key* key = section.find_key(member.key);
            if ((key && has_kind(*key, kind)) || section.find_section(member.key)) continue;
            if (section.many == Multiplicity::titled && in_list_ && member.key == "name") continue;
            const std::vector<std::string> valid = words_of(section, kind);
            const std::string whose = key ? fmt::format("a {} has no key '{}'", kind, member.key)
                                          : fmt::format("unknown key '{}'", member.key.substr(0, 64));
            draft_.report(join(path, member.key), member.at,
                fmt::format(
                    "{} in {}: expected {}{}", whose, where(path), listed(valid, ", "), hint(member.key, valid)));
        }
    }

    void missing_key(const Key& key, const std::string& path, const SourceLocation& at, const std::string& kind) {
        if (kind.empty() && !key.kinds.empty()) return;  // not known yet whether it is needed
        const std::string name = path.substr(path.rfind('.') + 1);
        const bool made_by_override = at.line == 0 && !siblings.empty();
        draft_.report(join(path, key.name), at,
            fmt::format("missing key '{}' in {}: expected {}{}", key.name, where(path), expectation(key),
                made_by_override ? hint(name, siblings) : ""));
    }

    void value(const Key& key, const Node& node, const std::string& path, void* object) {
        place(node, path);
        store(key, node, path, object);
    }

    void place(const Node& node, const std::string& path) {
        draft_.e.places[path] = node.at;
        if (node.is_array())
            for (std::size_t i = 0; i < node.members.size() && i < most_elements; ++i)
                draft_.e.places[fmt::format("{}.{}", path, i)] = node.members[i].value.at;
    }

    void store(const Key& key, const Node& node, const std::string& path, void* object) {
        Value value;
        if (!read_value(draft_, key, node, path, value)) return;
        key.slot.store(object, value);
        if (key.type == Type::sampler || key.type == Type::arm || key.type == Type::shape)
            draft_.references.push_back({key.type, path, value.text});
    }

    void default_value(const Key& key, const std::string& path, void* object) {
        if (key.type == Type::sampler) {  // the arm's own name, where nothing stands in its place
            const auto& arm = *static_cast<const ArmPlan*>(object);
            if (arm.exec || arm.plugin) return;
            Node name;
            name.kind = Node::Kind::text;
            name.text = static_cast<const ArmPlan*>(object)->name;
            return store(key, name, path, object);
        }
        store(key, read_toml(fmt::format("default = {}", key.default_value), "default").members.front().value, path,
            object);
    }

    /// A table, or all tables of a family.
    void family(const Section& section, const Node& parent, const std::string& path, const SourceLocation& parent_at,
        void* object) {
        const Member* member = parent.find(section.name);
        if (!member) return absent(section, path, parent_at, object);
        const Node& node = member->value;
        draft_.e.places[path] = member->at;
        const bool listed = section.many == Multiplicity::list || section.many == Multiplicity::titled;
        if (!node.is_table() && !(listed && node.is_array()))
            return draft_.report(
                path, node.at, fmt::format("{}: expected {}, found {}", path, form(section, path), describe(node)));
        if (section.many == Multiplicity::list && node.is_table())
            return draft_.report(
                path, node.at, fmt::format("{}: expected {}, found a table", path, form(section, path)));
        if (section.many == Multiplicity::one)
            return table(section, node, path, member->at,
                section.family.add ? section.family.add(object, "", member->at) : object);
        if (section.need == Requirement::required && node.members.empty())
            return draft_.report(
                path, member->at, fmt::format("{}: expected one or more {}, found none", path, form(section, path)));
        elements(section, node, path, object);
    }

    static std::string form(const Section& section, const std::string& path) {
        if (section.many == Multiplicity::one) return fmt::format("a table [{}]", path);
        if (section.many == Multiplicity::list) return "a list of tables";
        return fmt::format("tables [{}.NAME]", path);
    }

    void absent(const Section& section, const std::string& path, const SourceLocation& parent_at, void* object) {
        if (section.need == Requirement::required)
            return draft_.report(path, parent_at, fmt::format("missing {}: {}", form(section, path), section.means));
        const bool all_default = std::none_of(
            section.keys.begin(), section.keys.end(), [](const Key& k) { return k.need == Requirement::required; });
        if (section.many == Multiplicity::one && all_default)
            table(section, Node{}, path, parent_at,
                section.family.add ? section.family.add(object, "", parent_at) : object);
    }

    void elements(const Section& section, const Node& node, const std::string& path, void* object) {
        if (node.members.size() > most_elements)
            return draft_.report(path, node.at,
                fmt::format("{}: expected at most {}, found {}", path, most_elements, node.members.size()));
        std::vector<std::string> names;
        for (const Member& member : node.members) names.push_back(member.key);
        titles_.clear();
        for (std::size_t i = 0; i < node.members.size(); ++i) {
            const Member& member = node.members[i];
            siblings = names;
            std::erase(siblings, member.key);
            element(section, node, member, path, i, object);
        }
        siblings.clear();
    }

    void element(const Section& section, const Node& node, const Member& member, const std::string& path,
        std::size_t index, void* object) {
        const std::string label = node.is_array() ? fmt::format("{}.{}", path, index) : join(path, member.key);
        if (!member.value.is_table())
            return draft_.report(label, node.is_array() ? member.value.at : member.at,
                fmt::format("{}: expected {}, found {}", label,
                    node.is_array() ? "a table" : fmt::format("a table [{}]", label), describe(member.value)));
        std::string name = member.key;
        SourceLocation at = member.at;
        if (section.many == Multiplicity::titled && node.is_array() && !title(member, path, index, name, at)) return;
        const std::string own =
            section.many == Multiplicity::list ? fmt::format("{}.{}", path, index) : join(path, name);
        if (section.many == Multiplicity::named && !file_safe(name))
            draft_.report(own, at,
                fmt::format("the name '{}' in {}: expected letters, digits, '_', '.' and '-', at most 64, a "
                            "letter, digit or '_' first: names become file names",
                    name.substr(0, 64), where(path)));
        if (section.many == Multiplicity::titled && !one_line(name))
            draft_.report(own, at, fmt::format("a name in {}: expected one line of at most 200 bytes", where(path)));
        draft_.e.places[own] = at;
        in_list_ = node.is_array();
        table(section, member.value, own, at, section.family.add(object, name, at));
    }

    /// The name of a table in a list; false where it has none that is new.
    bool title(
        const Member& member, const std::string& path, std::size_t index, std::string& name, SourceLocation& at) {
        const Member* own = member.value.find("name");
        at = member.value.at;
        if (!own || own->value.kind != Node::Kind::text) {
            draft_.report(fmt::format("{}.{}", path, index), own ? own->value.at : at,
                fmt::format("{} in [[{}]]: expected a line of text{}", own ? "the key 'name'" : "missing key 'name'",
                    path, own ? ", found " + describe(own->value) : ""));
            return false;
        }
        name = own->value.text;
        at = own->value.at;
        const auto [first, fresh] = titles_.emplace(name, at);
        if (!fresh)
            draft_.report(fmt::format("{}.{}", path, index), at,
                fmt::format("duplicate name '{}' in [[{}]]: expected a new one, the first stands at {}", name, path,
                    to_string(first->second)));
        return fresh;
    }

    ParseContext& draft_;
    std::map<std::string, SourceLocation> titles_;  // names of a list so far
    bool in_list_ = false;                          // the table that is being read stands in one, and says its own name
};

}  // namespace

void read_tree(ParseContext& context, const Section& table, const Node& root, void* object) {
    const SourceLocation top{context.e.file, root.at.line ? root.at.line : 1, root.at.column ? root.at.column : 1};
    TreeReader(context).table(table, root, "", top, object);
}

void read_tree(ParseContext& context, const Node& root) { read_tree(context, schema(), root, &context.e); }

}  // namespace crescent::inline experiment
