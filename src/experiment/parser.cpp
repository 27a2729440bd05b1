// Mistakes found so far, each under the path of its value.
#include "experiment/parser.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <tuple>

#include "base/input.h"
#include "experiment/checks.h"
#include "experiment/combinations.h"
#include "experiment/experiment.h"
#include "experiment/input_files.h"
#include "experiment/overrides.h"
#include "experiment/published.h"
#include "experiment/schema_table.h"
#include "experiment/tree.h"
#include "experiment/value.h"
#include "samplers/info.h"

namespace crescent {

void ParseContext::report(
    const std::string& path, const SourceLocation& place, const std::string& message, Diagnostic::Kind kind) {
    diagnostics.push_back({.location = place, .message = message, .kind = kind, .path = path});
    invalid_paths.insert(path);
}

void ParseContext::report(const std::string& path, const std::string& message, Diagnostic::Kind kind) {
    report(path, e.place_of(path), message, kind);
}

// ---- Walks the table over the tree: which tables and keys there are, which are missing, the type of each value.

namespace {

constexpr std::size_t most_elements = 4096;  // of a family of tables; a film counts shapes in 16 bits

bool file_safe(std::string_view name) {
    const auto is_plain = [](unsigned char c) { return c < 0x80 && (std::isalnum(c) || c == '_'); };
    return !name.empty() && name.size() <= 64 && is_plain(static_cast<unsigned char>(name[0])) &&
        std::all_of(name.begin(), name.end(), [&](unsigned char c) { return is_plain(c) || c == '.' || c == '-'; });
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
        const Section& section, const Node& node, const std::string& path, const SourceLocation& place, void* object) {
        const std::string kind = kind_of(section, node);
        unknown_keys(section, node, path, kind);
        for (const Key& key : section.keys) {
            if (!has_kind(key, kind)) continue;
            const Member* member = node.find(key.name);
            if (member) value(key, member->value, join(path, key.name), object);
            else if (key.need == Requirement::required) missing_key(key, path, place, kind);
            else if (key.need == Requirement::defaulted) default_value(key, join(path, key.name), object);
        }
        for (const Section& sub : section.sections) family(sub, node, join(path, sub.name), place, object);
    }

    std::vector<std::string> siblings;  // names in the same list as the table that is being read

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
            draft_.report(join(path, member.key), member.location,
                fmt::format(
                    "{} in {}: expected {}{}", whose, where(path), listed(valid, ", "), hint(member.key, valid)));
        }
    }

    void missing_key(const Key& key, const std::string& path, const SourceLocation& place, const std::string& kind) {
        if (kind.empty() && !key.kinds.empty()) return;  // not known yet whether it is required
        const std::string name = path.substr(path.rfind('.') + 1);
        const bool made_by_override = place.line == 0 && !siblings.empty();
        draft_.report(join(path, key.name), place,
            fmt::format("missing key '{}' in {}: expected {}{}", key.name, where(path), expectation(key),
                made_by_override ? hint(name, siblings) : ""));
    }

    void value(const Key& key, const Node& node, const std::string& path, void* object) {
        place(node, path);
        store(key, node, path, object);
    }

    void place(const Node& node, const std::string& path) {
        draft_.e.places[path] = node.location;
        if (node.is_array())
            for (std::size_t i = 0; i < node.members.size() && i < most_elements; ++i)
                draft_.e.places[fmt::format("{}.{}", path, i)] = node.members[i].value.location;
    }

    void store(const Key& key, const Node& node, const std::string& path, void* object) {
        Value value;
        if (!read_value(draft_, key, node, path, value)) return;
        key.slot.store(object, value);
        if (key.type == Type::sampler || key.type == Type::arm || key.type == Type::shape)
            draft_.references.push_back({key.type, path, value.text});
    }

    void default_value(const Key& key, const std::string& path, void* object) {
        if (key.type == Type::sampler) {  // the arm's own name, unless exec or plugin is given
            const auto& arm = *static_cast<const ArmPlan*>(object);
            if (arm.is_external() || arm.is_combination()) return;
            Node name;
            name.kind = Node::Kind::text;
            name.text = static_cast<const ArmPlan*>(object)->name;
            return store(key, name, path, object);
        }
        store(key, read_toml(fmt::format("default = {}", key.default_value), "default").members.front().value, path,
            object);
    }

    /// Reads a table, or all tables of a family.
    void family(const Section& section, const Node& parent, const std::string& path, const SourceLocation& parent_at,
        void* object) {
        const Member* member = parent.find(section.name);
        if (!member) return absent(section, path, parent_at, object);
        const Node& node = member->value;
        draft_.e.places[path] = member->location;
        const bool is_list = section.many == Multiplicity::list || section.many == Multiplicity::titled;
        if (!node.is_table() && !(is_list && node.is_array()))
            return draft_.report(path, node.location,
                fmt::format("{}: expected {}, found {}", path, form(section, path), describe(node)));
        if (section.many == Multiplicity::list && node.is_table())
            return draft_.report(
                path, node.location, fmt::format("{}: expected {}, found a table", path, form(section, path)));
        if (section.many == Multiplicity::one)
            return table(section, node, path, member->location,
                section.family.add ? section.family.add(object, "", member->location) : object);
        if (section.need == Requirement::required && node.members.empty())
            return draft_.report(path, member->location,
                fmt::format("{}: expected one or more {}, found none", path, form(section, path)));
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
            return draft_.report(path, node.location,
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
            return draft_.report(label, node.is_array() ? member.value.location : member.location,
                fmt::format("{}: expected {}, found {}", label,
                    node.is_array() ? "a table" : fmt::format("a table [{}]", label), describe(member.value)));
        std::string name = member.key;
        SourceLocation place = member.location;
        if (section.many == Multiplicity::titled && node.is_array() && !title(member, path, index, name, place)) return;
        const std::string own_path =
            section.many == Multiplicity::list ? fmt::format("{}.{}", path, index) : join(path, name);
        if (section.many == Multiplicity::named && !file_safe(name))
            draft_.report(own_path, place,
                fmt::format("the name '{}' in {}: expected letters, digits, '_', '.' and '-', at most 64, a "
                            "letter, digit or '_' first: names become file names",
                    name.substr(0, 64), where(path)));
        if (section.many == Multiplicity::titled && !one_line(name))
            draft_.report(
                own_path, place, fmt::format("a name in {}: expected one line of at most 200 bytes", where(path)));
        draft_.e.places[own_path] = place;
        in_list_ = node.is_array();
        table(section, member.value, own_path, place, section.family.add(object, name, place));
    }

    /// Reads the name of a table in a list; returns false if it has no new name.
    bool title(
        const Member& member, const std::string& path, std::size_t index, std::string& name, SourceLocation& place) {
        const Member* name_member = member.value.find("name");
        place = member.value.location;
        if (!name_member || name_member->value.kind != Node::Kind::text) {
            draft_.report(fmt::format("{}.{}", path, index), name_member ? name_member->value.location : place,
                fmt::format("{} in [[{}]]: expected a line of text{}",
                    name_member ? "the key 'name'" : "missing key 'name'", path,
                    name_member ? ", found " + describe(name_member->value) : ""));
            return false;
        }
        name = name_member->value.text;
        place = name_member->value.location;
        const auto [first, fresh] = titles_.emplace(name, place);
        if (!fresh)
            draft_.report(fmt::format("{}.{}", path, index), place,
                fmt::format("duplicate name '{}' in [[{}]]: expected a new one, the first is at {}", name, path,
                    to_string(first->second)));
        return fresh;
    }

    ParseContext& draft_;
    std::map<std::string, SourceLocation> titles_;  // names of a list so far
    bool in_list_ = false;                          // the table that is read is in a list with its own name
};

}  // namespace

void read_tree(ParseContext& context, const Section& table, const Node& root, void* object) {
    const SourceLocation top{
        context.e.file, root.location.line ? root.location.line : 1, root.location.column ? root.location.column : 1};
    TreeReader(context).table(table, root, "", top, object);
}

void read_tree(ParseContext& context, const Node& root) { read_tree(context, schema(), root, &context.e); }

// ---- Fills in values that depend on other keys: every Lambert surface's s, every arm's sample counts, the n of runs
// that name none. Then checks that each run requested by a plate or the exponent control is one that the experiment
// makes.

namespace {

void resolve_s(ParseContext& context) {
    Experiment& e = context.e;
    if (e.exponent && context.is_valid("exponent.shape")) {
        const auto surface = e.find_surface(e.exponent->shape);
        if (surface && !e.material(*surface).s && context.is_valid(e.surface_path(*surface) + ".s"))
            context.report("exponent.shape",
                fmt::format("exponent.shape: expected a shape with an s of its own, found '{}' without one",
                    e.exponent->shape));
    }
    if (e.exponent) e.s_of = e.exponent->shape;
    const double s = e.s();
    bool valid = true;
    for (std::size_t k = 0; k < e.surface_count(); ++k) {
        Material& material = e.material(k);
        if (!material.s && s > 0) {
            material.s = s;
            material.inherits_s = true;
        }
        valid = valid && context.is_valid(e.surface_path(k) + ".s");
    }
    if (s > 0 || !valid) return;
    for (const ArmPlan& arm : e.arms)
        if (const SamplerInfo* info = find_arm_info(arm.sampler); info && info->needs_s)
            context.report("arms." + arm.name,
                fmt::format("the arm '{}' needs an exponent: expected a key 's' in one of the shapes", arm.name));
}

void resolve_ladders(ParseContext& context) {
    for (ArmPlan& arm : context.e.arms) {
        const std::string path = "arms." + arm.name;
        if (!arm.n.empty() || !context.is_valid(path + ".n") || !context.is_valid("n")) continue;
        if (context.e.n > 0) arm.n = {context.e.n};
        else
            context.report(path + ".n",
                fmt::format("missing key 'n' in [{}]: expected ascending integers from 1 to "
                            "16777216 (samples/pixel), or an n for the whole experiment",
                    path));
    }
}

/// Returns the n of a run, by default its arm's; reports an error if the arm has no such sample count.
std::uint64_t sample_count(
    ParseContext& context, const std::string& path, const std::string& arm_name, std::uint64_t n) {
    const ArmPlan* arm = context.e.find_arm(arm_name);
    if (!arm || arm->n.empty()) return n;
    if (n == 0) return context.e.n_of(*arm);
    if (!std::count(arm->n.begin(), arm->n.end(), n))
        context.report(path,
            fmt::format("{}: the arm '{}' has no sample count n = {}: expected one of {}", path, arm_name, n,
                listed(arm->n, ", ")));
    return n;
}

void check_s(ParseContext& context, const std::string& path, const PlateRun& run) {
    std::string reason = why_not_run(context.e, run.arm, run.n, run.s);
    if (!reason.empty()) context.report(path, fmt::format("{}: {}", path, reason));
}

void resolve_plate(ParseContext& context, PlatePlan& plate) {
    const std::string path = "plates." + plate.name;
    if (!context.is_valid(path + ".kind") || !context.is_valid(path + ".runs")) return;
    const PlateInfo& kind = plate_info(plate.kind);
    if (plate.runs.size() < kind.least || plate.runs.size() > kind.most) {
        const std::string range =
            kind.least == kind.most ? fmt::format("{}", kind.least) : fmt::format("{} to {}", kind.least, kind.most);
        context.report(path + ".runs",
            fmt::format(
                "{}.runs: expected {} for a plate of kind {}, found {}", path, range, kind.name, plate.runs.size()));
    }
    std::vector<PlateRun> runs;
    for (std::size_t i = 0; i < plate.runs.size(); ++i) {
        PlateRun run = plate.runs[i];
        const std::string run_path = fmt::format("{}.runs.{}", path, i);
        const ArmPlan* arm = context.e.find_arm(run.arm);
        const bool is_open = run.n == 0 && context.is_valid(run_path + ".n") && arm && !arm->n.empty();
        if (is_open && plate.kind == PlateKind::ladder) {
            for (const std::uint64_t n : arm->n) runs.push_back({run.arm, n, run.s});
            continue;
        }
        const auto& control = context.e.exponent;
        if (plate.kind == PlateKind::exponent && run.n == 0 && run.s == 0 && context.is_valid(run_path + ".s") &&
            control && control->arm == run.arm) {
            for (const double s : control->s) runs.push_back({run.arm, control->n, s});
            continue;
        }
        run.n = is_open && plate.kind == PlateKind::hero ? arm->n.back()
                                                         : sample_count(context, run_path + ".n", run.arm, run.n);
        if (context.is_valid(run_path + ".n") && context.is_valid(run_path + ".s"))
            check_s(context, run_path + ".s", run);
        runs.push_back(run);
    }
    plate.runs = std::move(runs);
}

}  // namespace

std::string why_not_run(const Experiment& e, const std::string& arm, std::uint64_t n, double s) {
    if (s == 0 || s == e.s() || n == 0 || !e.find_arm(arm)) return "";
    if (!e.exponent)
        return fmt::format(
            "no run at s = {}: expected the experiment's own s = {}; there is no [exponent] control", s, e.s());
    const ExponentControl& control = *e.exponent;
    if (control.arm == arm && control.n == n && std::count(control.s.begin(), control.s.end(), s)) return "";
    return fmt::format(
        "no run {} n={} s={}: expected the experiment's own s = {}, or a run of the exponent control: {} n={} s = {}",
        arm, n, s, e.s(), control.arm, control.n, listed(control.s, ", "));
}

/// The quadrature integrates lights of one radiance behind bodies in closed form; it cannot integrate an image or
/// meshes.
void resolve_reference(ParseContext& context) {
    Experiment& e = context.e;
    ReferencePlan& plan = e.reference;
    if (!context.is_valid("reference") || !context.is_valid("reference.kind")) return;
    const bool is_given = e.places.contains("reference.kind");
    const bool needs_paired = e.sky || !e.meshes.empty();
    if (needs_paired && !is_given) plan.kind = ReferenceKind::paired;
    const bool is_paired = plan.kind == ReferenceKind::paired;
    if (needs_paired && !is_paired)
        context.report("reference.kind",
            "reference.kind: a scene with a sky or meshes has no such reference: expected \"paired\", or no 'kind'");
    if (is_paired && plan.monte_carlo)
        context.report("reference.monte_carlo",
            "reference.monte_carlo: expected false with reference.kind = \"paired\", which takes its place");
    if (!is_paired && plan.n > 0)
        context.report(
            "reference.n", "reference.n: expected reference.kind = \"paired\", the only reference that has an n");
    if (is_paired && plan.n == 0 && context.is_valid("reference.n")) plan.n = paired_samples;
}

void resolve_regions(ParseContext& context) {
    const Image& image = context.e.image;
    for (Region& region : context.e.regions) {
        const std::string path = "regions." + region.name;
        const bool is_valid = context.is_valid(path) && context.is_valid(path + ".box") &&
            context.is_valid(path + ".mesh") && context.is_valid(path + ".shape");
        region.has_box = context.e.places.contains(path + ".box");
        if (!region.has_box) region.box = {0, 0, image.width - 1, image.height - 1};
        if (is_valid && !region.mesh.empty() && !region.shape.empty())
            context.report(path + ".shape",
                fmt::format("{}.shape: expected 'mesh' or 'shape', found both: a region has one object", path));
        if (const auto surface = context.e.find_surface(region.object()); surface && !region.object().empty()) {
            region.surface = static_cast<int>(*surface);
            const bool is_shape = *surface < context.e.shapes.size();
            if (is_shape == region.shape.empty())
                context.report(path + (is_shape ? ".mesh" : ".shape"),
                    fmt::format("{0}.{1}: '{2}' is a {3}: expected {3} = \"{2}\"", path, is_shape ? "mesh" : "shape",
                        region.object(), is_shape ? "shape" : "mesh"));
        }
    }
}

void resolve_runs(ParseContext& context) {
    resolve_s(context);
    resolve_reference(context);
    resolve_ladders(context);
    if (context.e.exponent) {
        ExponentControl& control = *context.e.exponent;
        if (context.is_valid("exponent.n")) control.n = sample_count(context, "exponent.n", control.arm, control.n);
    }
    for (PlatePlan& plate : context.e.plates) resolve_plate(context, plate);
}

// ---- Reads a file, or text, and its overrides into an Experiment; every mistake is in one InputError, in file order.

namespace {

ParseContext draft_of(std::string_view text, const std::string& name, const std::vector<std::string>& overrides) {
    ParseContext context;
    context.e.file = name;
    context.e.overrides = overrides;
    Node root = read_toml(text, name);
    apply_overrides(context, root, overrides);
    read_tree(context, root);
    resolve_regions(context);
    expand_renderers(context);
    check_geometry(context);
    check_names(context);
    resolve_runs(context);
    check_combinations(context);
    resolve_assertions(context);
    Experiment& e = context.e;
    const std::filesystem::path folder = std::filesystem::path(name).parent_path();
    if (e.published) e.published = (folder / *e.published).string();
    if (e.sky && !e.sky->file.empty()) e.sky->file = (folder / e.sky->file).string();
    for (ArmPlan& arm : e.arms) {
        if (arm.plugin) arm.plugin = (folder / *arm.plugin).string();
        for (std::optional<std::string>* python : {&arm.python, &arm.combination.weights_python})
            if (*python && !python_file(**python).empty()) *python = (folder / **python).string();
    }
    return context;
}

}  // namespace

/// In file order; overrides follow the file, as given.
void throw_if_any(std::vector<Diagnostic> diagnostics) {
    if (diagnostics.empty()) return;
    std::multimap<std::tuple<bool, unsigned, unsigned>, Diagnostic> sorted_diagnostics;  // equals keep their order
    for (Diagnostic& c : diagnostics)
        sorted_diagnostics.emplace(std::tuple(c.location.line == 0, c.location.line, c.location.column), std::move(c));
    diagnostics.clear();
    for (auto& [key, diagnostic] : sorted_diagnostics) diagnostics.push_back(std::move(diagnostic));
    throw InputError(std::move(diagnostics));
}

Experiment parse(std::string_view text, const std::string& name, const std::vector<std::string>& overrides) {
    ParseContext context = draft_of(text, name, overrides);
    throw_if_any(std::move(context.diagnostics));
    return std::move(context.e);
}

Experiment load(const std::string& path, const std::vector<std::string>& overrides) {
    for (const char* model : {".obj", ".ply", ".gltf", ".glb", ".stl"})
        if (path.ends_with(model))
            throw InputError({path, 0, 0},
                "expected an experiment, a TOML file: `crescent import` makes a mesh of a model, for an experiment");
    for (const char* foreign : {".pbrt", ".xml", ".usd", ".usda", ".usdz", ".blend"})
        if (path.ends_with(foreign))
            throw InputError({path, 0, 0},
                "expected an experiment, a TOML file: scenes of other programs cannot be read; docs/run.md says what a "
                "scene can be");
    ParseContext context = draft_of(read_text(path, "an experiment file"), path, overrides);
    if (context.e.published) {
        try {
            context.e.figures = load_published(*context.e.published);
        } catch (const InputError& error) { context.report("published", fmt::format("published: {}", error.what())); }
    }
    if (context.e.sky && context.is_valid("sky.file") && context.is_valid("sky.layer")) {
        try {
            if (leads_out(std::filesystem::path(path).parent_path().string(), context.e.sky->file))
                throw InputError({context.e.sky->file, 0, 0},
                    "expected a file in the folder of the experiment or below it, found one in another place");
            load_sky(*context.e.sky);
        } catch (const LayerError& error) {
            context.report("sky.layer", fmt::format("sky.layer: {}", error.what()));
        } catch (const InputError& error) { context.report("sky.file", fmt::format("sky.file: {}", error.what())); }
    }
    if (context.diagnostics.empty()) {
        try {
            read_meshes(context.e);
        } catch (const InputError& error) { context.diagnostics = error.diagnostics(); }
    }
    throw_if_any(std::move(context.diagnostics));
    return std::move(context.e);
}

Experiment with_files(Experiment experiment) {
    if (experiment.published && !experiment.figures) experiment.figures = load_published(*experiment.published);
    if (experiment.sky && !experiment.sky->image) load_sky(*experiment.sky);
    read_meshes(experiment);
    return experiment;
}

std::string read_text(const std::string& path, std::string_view what) {
    return read_input(path, std::size_t{4} << 20, what);
}

}  // namespace crescent
