// A compare file, flags, or both -> ComparePlan. Flags are put into the file's tree before it is read, so that they
// meet the same checks as the file.
#include "compare/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "compare/schema.h"
#include "experiment/parse_context.h"
#include "experiment/published.h"

namespace crescent::inline comparing {

namespace {

Node text_node(const std::string& text, const SourceLocation& at) {
    Node node;
    node.kind = Node::Kind::text;
    node.text = text;
    node.at = at;
    return node;
}

void move_to(Node& node, const SourceLocation& at) {
    node.at = at;
    for (Member& member : node.members) member.at = at, move_to(member.value, at);
}

/// The value of a flag: TOML where it says so and is some, else text as it is; the reader says what was expected.
Node value_of(const CompareFlag& flag, const SourceLocation& at) {
    if (!flag.toml) return text_node(flag.value, at);
    try {
        Node tree = read_toml("value = " + flag.value, flag.typed);
        if (tree.members.size() == 1) {
            move_to(tree.members[0].value, at);
            return std::move(tree.members[0].value);
        }
    } catch (const InputError&) {}
    return text_node(flag.value, at);
}

Node& child(Node& parent, const std::string& key, const SourceLocation& at) {
    if (Member* found = parent.find(key)) return found->value;
    parent.members.push_back({key, at, Node{}});
    parent.members.back().value.at = at;
    return parent.members.back().value;
}

/// Lists grow with every flag that names them ("--arm a=x.exr --arm a=y.exr"); all else is replaced.
void put(Node& root, const CompareFlag& flag, std::set<std::string>& begun) {
    const SourceLocation at{flag.typed, 0, 0};
    Node* node = &root;
    for (std::size_t i = 0; i + 1 < flag.path.size(); ++i) node = &child(*node, flag.path[i], at);
    Node value = value_of(flag, at);
    const bool grows = flag.path.back() == "files" || flag.path == std::vector<std::string>{"reference"};
    Node& to = child(*node, flag.path.back(), at);
    if (!grows) {
        to = std::move(value);
        return;
    }
    if (begun.insert(fmt::format("{}", fmt::join(flag.path, "."))).second) {
        to = Node{};
        to.kind = Node::Kind::array, to.at = at;
    }
    to.members.push_back({"", at, std::move(value)});
}

/// Paths of a file are read from its own folder; those of flags from where the command runs.
void from_folder(Node* node, const std::filesystem::path& folder) {
    if (!node) return;
    if (node->kind == Node::Kind::text && !node->text.empty()) node->text = (folder / node->text).string();
    for (Member& member : node->members)
        if (node->kind == Node::Kind::array) from_folder(&member.value, folder);
}
void from_folder(Node& root, const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    if (folder.empty()) return;
    const auto at = [](Node& node, const char* key) {
        Member* found = node.find(key);
        return found ? &found->value : nullptr;
    };
    from_folder(at(root, "reference"), folder);
    for (const auto& [table, key] : {std::pair{"arms", "files"}, std::pair{"masks", "file"}})
        if (Node* named = at(root, table))
            for (Member& member : named->members) from_folder(at(member.value, key), folder);
}

void check_names(ParseContext& context, ComparePlan& plan) {
    std::vector<std::string> regions{whole_frame}, arms;
    for (const Region& r : plan.regions) regions.push_back(r.name);
    for (const MaskPlan& m : plan.masks) {
        if (std::count(regions.begin(), regions.end(), m.name))
            context.report("masks." + m.name, m.at, fmt::format("the name '{}' is a region already", m.name));
        regions.push_back(m.name);
    }
    for (const Region& r : plan.regions)
        if (r.name == whole_frame)
            context.report("regions.frame", r.at, "the name 'frame' stands for all pixels: expected another");
    for (const RenderArm& a : plan.arms) arms.push_back(a.name);
    for (AssertionPlan& a : plan.assertions) {
        std::string why;
        const auto check = parse_comparison(a.text, why, compare_words());
        if (!check) {
            context.report(a.name, a.at, fmt::format("assertions.{}.check: {}", a.name, why));
            continue;
        }
        a.check = *check;
        for (const ParsedQuantity* q : {&a.check.left, &a.check.right}) {
            if (q->number) continue;
            if (!std::count(arms.begin(), arms.end(), q->subject))
                context.report(a.name, a.at,
                    fmt::format("{}: no arm '{}': expected one of {}{}", a.text, q->subject, listed(arms, ", "),
                        hint(q->subject, arms)));
            if (!std::count(regions.begin(), regions.end(), q->region))
                context.report(a.name, a.at,
                    fmt::format("{}: no region '{}': expected one of {}{}", a.text, q->region, listed(regions, ", "),
                        hint(q->region, regions)));
        }
    }
    if (plan.crop && plan.align == Alignment::display)
        context.report("crop", "crop and align = \"display\": expected one of them");
    if (plan.expect == Expectation::same && plan.arms.size() < 2 && plan.reference.empty())
        context.report("expect", "expect = \"same\": expected two arms, or an arm and a reference");
}

ComparePlan read_plan(Node root, ParseContext& context, const std::vector<CompareFlag>& flags) {
    std::set<std::string> begun;
    for (const CompareFlag& flag : flags) put(root, flag, begun);
    ComparePlan plan;
    plan.file = context.e.file;
    read_tree(context, compare_schema(), root, &plan);
    if (context.diagnostics.empty()) check_names(context, plan);
    throw_if_any(std::move(context.diagnostics));
    return plan;
}

}  // namespace

ComparePlan plan_of(const std::vector<CompareFlag>& flags, const std::string& file) {
    ParseContext context;
    context.e.file = file.empty() ? "crescent compare" : file;
    Node root;
    if (!file.empty()) {
        root = read_toml(read_text(file, "a compare file"), file, &context.diagnostics);
        from_folder(root, file);
    }
    return read_plan(std::move(root), context, flags);
}

std::vector<std::string> compare_arms(const std::string& file) {
    std::vector<std::string> out;
    std::vector<Diagnostic> ignored;
    Node root = read_toml(read_text(file, "a compare file"), file, &ignored);
    if (const Member* arms = root.find("arms"))
        for (const Member& arm : arms->value.members) out.push_back(arm.key);
    return out;
}

}  // namespace crescent::inline comparing
