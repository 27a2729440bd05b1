// A ComparePlan from a compare file, flags, or both. Flags are inserted into the file's tree before it is parsed, so
// that the same checks apply to both.
#include "compare/plan.h"
#include "compare/file_pattern.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

#include "experiment/experiment.h"
#include "experiment/json_schema.h"
#include "experiment/parser.h"
#include "experiment/schema.h"
#include "experiment/tree.h"
#include "experiment/value.h"

namespace crescent {

namespace {

Node text_node(const std::string& text, const SourceLocation& place) {
    Node node;
    node.kind = Node::Kind::text;
    node.text = text;
    node.location = place;
    return node;
}

void move_to(Node& node, const SourceLocation& place) {
    node.location = place;
    for (Member& member : node.members) {
        member.location = place;
        move_to(member.value, place);
    }
}

/// Returns the value of a flag: parsed as TOML if the flag has it and it is valid, else as text, for which the parser
/// reports what was expected.
Node value_of(const CompareFlag& flag, const SourceLocation& place) {
    if (!flag.toml) return text_node(flag.value, place);
    try {
        Node tree = read_toml("value = " + flag.value, flag.typed);
        if (tree.members.size() == 1) {
            move_to(tree.members[0].value, place);
            return std::move(tree.members[0].value);
        }
    } catch (const InputError&) {}
    return text_node(flag.value, place);
}

Node& child(Node& parent, const std::string& key, const SourceLocation& place) {
    if (Member* member = parent.find(key)) return member->value;
    parent.members.push_back({key, place, Node{}});
    parent.members.back().value.location = place;
    return parent.members.back().value;
}

/// Flags extend lists ("--arm a=x.exr --arm a=y.exr") and replace all other values.
void put(Node& root, const CompareFlag& flag, std::set<std::string>& begun) {
    const SourceLocation place{flag.typed, 0, 0};
    Node* node = &root;
    for (std::size_t i = 0; i + 1 < flag.path.size(); ++i) node = &child(*node, flag.path[i], place);
    Node value = value_of(flag, place);
    const bool grows = flag.path.back() == "files" || flag.path == std::vector<std::string>{"reference"};
    Node& to = child(*node, flag.path.back(), place);
    if (!grows) {
        to = std::move(value);
        return;
    }
    if (begun.insert(fmt::format("{}", fmt::join(flag.path, "."))).second) {
        to = Node{};
        to.kind = Node::Kind::array;
        to.location = place;
    }
    to.members.push_back({"", place, std::move(value)});
}

/// Paths in a file are relative to its folder, whose name is no pattern; those of flags to the current folder.
void from_folder(Node* node, const std::filesystem::path& folder, bool pattern) {
    if (!node) return;
    if (node->kind == Node::Kind::text && !node->text.empty()) {
        const std::filesystem::path path = folder / node->text;
        std::error_code ignored;
        const bool exists = pattern && std::filesystem::exists(path, ignored);  // "render[1].exr" may be a name
        if (!pattern) node->text = path.string();
        else node->text = exists ? escape_pattern(path.string()) : pattern_in(folder.string(), node->text);
    }
    for (Member& member : node->members)
        if (node->kind == Node::Kind::array) from_folder(&member.value, folder, pattern);
}
void from_folder(Node& root, const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    if (folder.empty()) return;
    const auto member_of = [](Node& node, const char* key) {
        Member* member = node.find(key);
        return member ? &member->value : nullptr;
    };
    from_folder(member_of(root, "reference"), folder, true);
    for (const auto& [table, key] : {std::pair{"arms", "files"}, std::pair{"masks", "file"}})
        if (Node* node = member_of(root, table))
            for (Member& member : node->members)
                from_folder(member_of(member.value, key), folder, std::string_view(key) == "files");
}

void check_names(ParseContext& context, ComparePlan& plan) {
    std::vector<std::string> regions{whole_frame}, arms;
    for (const Region& r : plan.regions) regions.push_back(r.name);
    for (const MaskPlan& m : plan.masks) {
        if (std::count(regions.begin(), regions.end(), m.name))
            context.report("masks." + m.name, m.location, fmt::format("the name '{}' is a region already", m.name));
        regions.push_back(m.name);
    }
    for (const Region& r : plan.regions)
        if (r.name == whole_frame)
            context.report("regions.frame", r.location, "the name 'frame' stands for all pixels: expected another");
    for (const RenderArm& a : plan.arms) arms.push_back(a.name);
    for (AssertionPlan& a : plan.assertions) {
        std::string why;
        const auto check = parse_comparison(a.text, why, compare_words());
        if (!check) {
            context.report(a.name, a.location, fmt::format("assertions.{}.check: {}", a.name, why));
            continue;
        }
        a.check = *check;
        for (const ParsedQuantity* q : {&a.check.left, &a.check.right}) {
            if (q->number) continue;
            if (!std::count(arms.begin(), arms.end(), q->adapter))
                context.report(a.name, a.location,
                    fmt::format("{}: no arm '{}': expected one of {}{}", a.text, q->adapter, listed(arms, ", "),
                        hint(q->adapter, arms)));
            if (!std::count(regions.begin(), regions.end(), q->region))
                context.report(a.name, a.location,
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
    put_flags(root, flags);
    ComparePlan plan;
    plan.file = context.e.file;
    read_tree(context, compare_schema(), root, &plan);
    if (context.diagnostics.empty()) check_names(context, plan);
    throw_if_any(std::move(context.diagnostics));
    return plan;
}

}  // namespace

void put_flags(Node& root, const std::vector<CompareFlag>& flags) {
    std::set<std::string> begun;
    for (const CompareFlag& flag : flags) put(root, flag, begun);
}

ComparePlan plan_of(const std::vector<CompareFlag>& flags, const std::string& file) {
    ParseContext context;
    context.e.file = file.empty() ? "crescent compare" : file;
    Node root;
    if (!file.empty()) {
        root = read_toml(read_text(file, "a compare file"), file);
        from_folder(root, file);
    }
    return read_plan(std::move(root), context, flags);
}

std::vector<std::string> compare_arms(const std::string& file) {
    std::vector<std::string> out;
    Node root = read_toml(read_text(file, "a compare file"), file);
    if (const Member* arms = root.find("arms"))
        for (const Member& arm : arms->value.members) out.push_back(arm.key);
    return out;
}

// ---- The table of a compare file: the same kind as an experiment's, with keys, places in the file, hints and manual.

namespace {

constexpr Range none{}, share{.low = 0, .high = 1, .low_open = false, .high_open = true}, positive{0, 1e12, true},
    pixel_range{0, 65535};
constexpr Requirement required = Requirement::required, optional = Requirement::optional,
                      defaulted = Requirement::defaulted;

Section arms() {
    return {"arms", Multiplicity::named, required,
        "Sets of independent renders of one view: several seeds of A, several of B.", in<&ComparePlan::arms>,
        {{"files", Type::texts, none, "", required, "",
             "Paths or patterns (*, ?, [a-z], %d for digits) of the renders, relative to this file.",
             to<&RenderArm::files>},
            {"layer", Type::text, none, "", defaulted, "\"\"", "Which part or layer of each file; else the beauty.",
                to<&RenderArm::layer>},
            {"spp", Type::number, positive, "samples/pixel", optional, "what the files state",
                "Samples a pixel of one render.", to<&RenderArm::spp>},
            {"seconds", Type::number, positive, "s", optional, "what the files state", "What one render took.",
                to<&RenderArm::seconds>}},
        {}};
}

Section regions() {
    return {"regions", Multiplicity::named, optional, "Boxes in which errors are measured.", in<&ComparePlan::regions>,
        {{"box", Type::box, pixel_range, "pixels", required, "",
            "[x0, y0, x1, y1], both ends inside, origin bottom-left.", to<&Region::box>}},
        {}};
}

Section masks() {
    return {"masks", Multiplicity::named, optional, "Sets of pixels in which errors are measured.",
        in<&ComparePlan::masks>,
        {{"file", Type::text, none, "", required, "",
            "A picture of the renders' size, relative to this file; pixels above 0 belong to it.",
            to<&MaskPlan::file>}},
        {}};
}

Section assertions() {
    return {"assertions", Multiplicity::titled, optional, "Claims that must hold, for a build server.",
        in<&ComparePlan::assertions>,
        {{"check", Type::check, none, "", required, "", "Two quantities, e.g. \"rmse.H(a) < rmse.H(b)\".",
            to<&AssertionPlan::text>}},
        {}};
}

}  // namespace

const Section& compare_schema() {
    static const Section root = {"", Multiplicity::one, required, "Renders of other programs, compared.", {},
        {{"title", Type::text, none, "", defaulted, "\"renders compared\"", "One line.", to<&ComparePlan::title>},
            {"reference", Type::texts, none, "", optional, "none",
                "Paths or patterns of the converged image, relative to this file.", to<&ComparePlan::reference>},
            {"reference_layer", Type::text, none, "", defaulted, "\"\"", "Which part or layer of it.",
                to<&ComparePlan::reference_layer>},
            {"pair", Type::flag, none, "", defaulted, "false",
                "Renders of two arms with the same number in their names share their random numbers.",
                to<&ComparePlan::pair>},
            {"encoding", Type::word, none, "", defaulted, "\"auto\"",
                "How the numbers of PNG, JPEG, BMP, TGA and PNM encode radiance: srgb or linear; auto: as the file "
                "states it, "
                "else srgb.",
                to<&ComparePlan::encoding>, {"auto", "srgb", "linear"}},
            {"space", Type::word, none, "", defaulted, "\"radiance\"",
                "What is tested of such files: radiance, or display: the numbers over the largest one.",
                to<&ComparePlan::space>, {"radiance", "display"}},
            {"channels", Type::word, none, "", defaulted, "\"rgb\"", "rgba: the alpha channel is tested too.",
                to<&ComparePlan::channels>, {"rgb", "rgba"}},
            {"channel", Type::text, none, "", defaulted, "\"\"",
                "This channel alone is tested, by its name in the file; else the colours.", to<&ComparePlan::channel>},
            {"align", Type::word, none, "", defaulted, "\"windows\"",
                "windows: renders whose data windows differ are refused; display: each is placed in its display "
                "window, with 0 outside of its data window.",
                to<&ComparePlan::align>, {"windows", "display"}},
            {"crop", Type::flag, none, "", defaulted, "false",
                "Compare the pixels that the data windows of all renders share; regions are counted from their "
                "bottom-left.",
                to<&ComparePlan::crop>},
            {"exposure", Type::number, {0, 1e6, true}, "", defaulted, "1", "Of photographs.",
                to<&ComparePlan::exposure>},
            {"theme", Type::word, none, "", defaulted, "\"dark\"", "Ground and inks of plates.",
                to<&ComparePlan::theme>, {"dark", "light"}},
            {"alpha", Type::number, {1e-9, 0.5}, "", defaulted, "0.01",
                "Probability that a call reports a difference if there is none.", to<&ComparePlan::alpha>},
            {"brightest", Type::number, positive, "", optional, "not known",
                "The largest possible Y of a pixel of one render, if it is bounded, for example by a clamp. A "
                "difference that rarer events up to it could explain is not reported.",
                to<&ComparePlan::brightest>},
            {"firefly_k", Type::number, {0, 1e6, true}, "", defaulted, "4",
                "A firefly is a pixel with |Y - Y_ref| > firefly_k Y_ref.", to<&ComparePlan::firefly_k>},
            {"trim", Type::number, share, "", defaulted, "0",
                "Share of pixels that relMSE and MAPE leave out, the largest first.", to<&ComparePlan::trim>},
            {"pixels_per_degree", Type::number, {1, 1000}, "", defaulted, "67.0206",
                "Of the viewer of FLIP: 0.7 m from a display 0.7 m wide with 3840 pixels.",
                to<&ComparePlan::pixels_per_degree>},
            {"flip", Type::flag, none, "", defaulted, "true", "Whether FLIP is measured: it takes longest.",
                to<&ComparePlan::flip>},
            {"expect", Type::word, none, "", defaulted, "\"nothing\"",
                "same: a difference between arms fails the call.", to<&ComparePlan::expect>, {"nothing", "same"}},
            {"smallest", Type::number, {1e-6, 10}, "", defaulted, "0.01",
                "With expect = \"same\": the relative difference of mean Y that must be detectable.",
                to<&ComparePlan::smallest>}},
        {arms(), regions(), masks(), assertions()}};
    return root;
}

const std::vector<QuantityWord>& compare_words() {
    static const std::vector<QuantityWord> words = {
        {"rmse", true, QuantityOf::compared, "root mean square error of Y of one render against the reference"},
        {"var", true, QuantityOf::compared, "mean variance of Y of one render, over renders"},
        {"bias2", true, QuantityOf::compared, "squared bias of Y, MSE less variance; may be below 0 by noise"},
        {"relmse", true, QuantityOf::compared, "mean of (Y - Y_ref)^2 / (Y_ref^2 + 0.01)"},
        {"mape", true, QuantityOf::compared, "mean of |Y - Y_ref| / (|Y_ref| + 0.01)"},
        {"fireflies", true, QuantityOf::compared, "pixels with |Y - Y_ref| > firefly_k Y_ref, of one render"},
        {"y_mean", true, QuantityOf::compared, "mean Y"},
        {"flip", true, QuantityOf::compared, "mean HDR-FLIP of the arm's first render against the reference"},
        {"flip_ldr", true, QuantityOf::compared, "mean LDR-FLIP of the two photographs, at the exposure of the plates"},
        {"efficiency", true, QuantityOf::compared, "1 / (variance x seconds)"},
        {"unit_time", true, QuantityOf::compared,
            "seconds after which the mean of renders has a variance of 1: variance x seconds"},
        {"sample_var", true, QuantityOf::compared, "variance of one sample: variance x samples a pixel"},
    };
    return words;
}

std::string compare_schema_text() {
    std::string out = manual_of(compare_schema());
    out += "\nQuantities of a check; REGION may also be a mask, or 'frame', the whole image\n";
    for (const QuantityWord& word : compare_words())
        out += "  " + form_of(word) + "\n      " + std::string(word.means) + "\n";
    return out;
}

std::string compare_schema_json() { return json_schema_of(compare_schema(), "crescent comparison"); }

}  // namespace crescent
