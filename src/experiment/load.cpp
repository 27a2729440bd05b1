// A file, or text, and its overrides -> Experiment; every mistake in one InputError, in file order.
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <tuple>

#include "experiment/parse_context.h"
#include "experiment/published.h"

namespace crescent::inline experiment {

namespace {

ParseContext draft_of(std::string_view text, const std::string& name, const std::vector<std::string>& overrides) {
    ParseContext context;
    context.e.file = name;
    context.e.overrides = overrides;
    Node root = read_toml(text, name, &context.diagnostics);
    apply_overrides(context, root, overrides);
    read_tree(context, root);
    check_geometry(context);
    check_names(context);
    resolve_runs(context);
    resolve_assertions(context);
    Experiment& e = context.e;
    const std::filesystem::path folder = std::filesystem::path(name).parent_path();
    if (e.published) e.published = (folder / *e.published).string();
    for (ArmPlan& arm : e.arms)
        if (arm.plugin) arm.plugin = (folder / *arm.plugin).string();
    return context;
}

}  // namespace

/// In file order; overrides come after the file, as given.
void throw_if_any(std::vector<Diagnostic> all) {
    if (all.empty()) return;
    std::multimap<std::tuple<bool, unsigned, unsigned>, Diagnostic> sorted;  // equals keep their order
    for (Diagnostic& c : all) sorted.emplace(std::tuple(c.at.line == 0, c.at.line, c.at.column), std::move(c));
    all.clear();
    for (auto& [key, diagnostic] : sorted) all.push_back(std::move(diagnostic));
    throw InputError(std::move(all));
}

Experiment parse(std::string_view text, const std::string& name, const std::vector<std::string>& overrides) {
    ParseContext context = draft_of(text, name, overrides);
    throw_if_any(std::move(context.diagnostics));
    return std::move(context.e);
}

Experiment load(const std::string& path, const std::vector<std::string>& overrides) {
    for (const char* foreign : {".pbrt", ".xml", ".obj", ".ply", ".gltf", ".glb", ".usd", ".usda", ".usdz", ".blend"})
        if (path.ends_with(foreign))
            throw InputError({path, 0, 0},
                "expected an experiment, a TOML file: scenes of other programs cannot be read; README.md says what a "
                "scene "
                "can be");
    ParseContext context = draft_of(read_text(path, "an experiment file"), path, overrides);
    if (context.e.published) {
        try {
            context.e.figures = load_published(*context.e.published);
        } catch (const InputError& error) { context.report("published", fmt::format("published: {}", error.what())); }
    }
    throw_if_any(std::move(context.diagnostics));
    return std::move(context.e);
}

Experiment with_figures(Experiment experiment) {
    if (experiment.published && !experiment.figures) experiment.figures = load_published(*experiment.published);
    return experiment;
}

std::string read_text(const std::string& path, std::string_view what) {
    constexpr std::streamsize most = (std::streamsize{4} << 20) + 1;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError({path, 0, 0}, fmt::format("expected {}, found a folder", what));
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InputError(
            {path, 0, 0}, fmt::format("expected {} that can be read: {}", what, std::strerror(errno ? errno : ENOENT)));
    std::string text(static_cast<std::size_t>(most), '\0');
    file.read(text.data(), most);
    if (file.bad())
        throw InputError({path, 0, 0}, fmt::format("expected {} that can be read: {}", what, std::strerror(errno)));
    text.resize(static_cast<std::size_t>(file.gcount()));
    if (text.size() == static_cast<std::size_t>(most))
        throw InputError({path, 0, 0}, fmt::format("expected {} of at most 4 MiB, found more", what));
    return text;
}

}  // namespace crescent::inline experiment
