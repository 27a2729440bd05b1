// Reads a suite file: the table of its keys, and the files of each view.
#include "compare/suite/suite_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <set>
#include <tuple>

#include "compare/suite/suite.h"
#include "experiment/parser.h"
#include "experiment/schema.h"
#include "experiment/tree.h"
#include "experiment/value.h"

namespace crescent {

namespace {

namespace fs = std::filesystem;

constexpr Range none{}, positive{0, 1e12, true}, pixel_range{0, 65535}, share{1e-6, 10};
constexpr Requirement required = Requirement::required, optional = Requirement::optional,
                      defaulted = Requirement::defaulted;

Section suite_table() {
    return {"suite", Multiplicity::one, required, "What all views share.", in<&Suite::options>,
        {{"title", Type::text, none, "", defaulted, "\"golden images\"", "One line.", to<&SuiteOptions::title>},
            {"alpha", Type::number, {1e-9, 0.5}, "", defaulted, "0.01",
                "Probability that a suite without any change reports one.", to<&SuiteOptions::alpha>},
            {"baseline", Type::texts, none, "", optional, "--baseline",
                "Patterns of the baseline's renders, relative to this file; {view} is the name of the view.",
                to<&SuiteOptions::baseline>},
            {"candidate", Type::texts, none, "", optional, "--candidate", "The same of the renders to be compared.",
                to<&SuiteOptions::candidate>},
            {"smallest", Type::number, share, "", defaulted, "0.01",
                "Relative difference of mean Y that must be found: a number, or text such as \"2 %\".",
                to<&SuiteOptions::smallest>},
            {"layer", Type::text, none, "", defaulted, "\"\"", "Which part or layer of each file; else the beauty.",
                to<&SuiteOptions::layer>},
            {"encoding", Type::word, none, "", defaulted, "\"auto\"",
                "How the numbers of PNG, JPEG, BMP, TGA and PNM encode radiance: srgb or linear; auto: as the file "
                "states it, "
                "else srgb.",
                to<&SuiteOptions::encoding>, {"auto", "srgb", "linear"}},
            {"space", Type::word, none, "", defaulted, "\"radiance\"",
                "What is tested of such files: radiance, or display: the numbers over the largest one.",
                to<&SuiteOptions::space>, {"radiance", "display"}},
            {"channels", Type::word, none, "", defaulted, "\"rgb\"", "rgba: the alpha channel is tested too.",
                to<&SuiteOptions::channels>, {"rgb", "rgba"}},
            {"channel", Type::text, none, "", defaulted, "\"\"",
                "This channel alone is tested, by its name in the file; else the colours.", to<&SuiteOptions::channel>},
            {"exposure", Type::number, {0, 1e6, true}, "", defaulted, "1", "Of the pictures in the report.",
                to<&SuiteOptions::exposure>},
            {"brightest", Type::number, positive, "", optional, "not known",
                "The largest possible Y of a pixel of one render, such as a clamp.", to<&SuiteOptions::brightest>},
            {"store", Type::word, none, "", defaulted, "\"renders\"",
                "What --accept stores: the renders, or the mean and the variance of each pixel.",
                to<&SuiteOptions::store>, {"renders", "moments"}},
            {"pair", Type::word, none, "", defaulted, "\"auto\"",
                "Renders are compared in pairs if they share random numbers; true: those with the same number in their "
                "names; false: never.",
                to<&SuiteOptions::pair>, {"auto", "true", "false"}},
            {"noise", Type::word, none, "", defaulted, "\"not more\"",
                "What is asked of the noise: not more of it, the same, or nothing (ignore).", to<&SuiteOptions::noise>,
                {"not more", "same", "ignore"}},
            {"outliers", Type::word, none, "", defaulted, "\"test\"",
                "test: the numbers of outlier pixels are compared; ignore: they are not.", to<&SuiteOptions::outliers>,
                {"test", "ignore"}},
            {"tolerance", Type::text, none, "", defaulted, "\"\"",
                "Of views without noise, for each channel of a pixel: \"1 ulp\" (a step of the files), \"0.5 %\" or "
                "\"2/255\"; else every bit must be equal.",
                to<&SuiteOptions::tolerance_text>}},
        {}};
}

Section view_table() {
    return {"view", Multiplicity::titled, optional, "What differs for one view.", in<&Suite::views>,
        {{"smallest", Type::number, share, "", optional, "that of [suite]",
             "Relative difference of mean Y that must be found in this view.", to<&SuiteView::smallest>},
            {"pair", Type::word, none, "", optional, "that of [suite]", "As in [suite].", to<&SuiteView::pair>,
                {"auto", "true", "false"}},
            {"noise", Type::word, none, "", optional, "that of [suite]", "As in [suite].", to<&SuiteView::noise>,
                {"not more", "same", "ignore"}},
            {"outliers", Type::word, none, "", optional, "that of [suite]", "As in [suite].", to<&SuiteView::outliers>,
                {"test", "ignore"}},
            {"tolerance", Type::text, none, "", optional, "that of [suite]", "As in [suite].",
                to<&SuiteView::tolerance_text>}},
        {{"regions", Multiplicity::named, optional, "Boxes that are tested besides the whole image.",
            in<&SuiteView::regions>,
            {{"box", Type::box, pixel_range, "pixels", required, "",
                "[x0, y0, x1, y1], both ends inclusive, origin bottom-left; regions.NAME = [x0, y0, x1, y1] is short "
                "for it.",
                to<&Region::box>}},
            {}}}};
}

const Section& suite_schema() {
    static const Section root = {
        "", Multiplicity::one, required, "Golden images of several views.", {}, {}, {suite_table(), view_table()}};
    return root;
}

/// "2 %" -> 0.02; other text is unchanged, and the parser reports it.
void read_percent(Node* table) {
    Member* member = table ? table->find("smallest") : nullptr;
    if (!member || member->value.kind != Node::Kind::text) return;
    std::string_view text = member->value.text;
    const auto trim_end = [&] { text = text.substr(0, text.find_last_not_of(" \t") + 1); };
    trim_end();
    if (!text.ends_with('%')) return;
    text.remove_suffix(1);
    trim_end();
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    double percents = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), percents);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(percents)) return;
    member->value.kind = Node::Kind::number;
    member->value.number = percents / 100;
}

/// regions.NAME = [...] -> regions.NAME.box = [...].
void expand_regions(Node& view) {
    Member* regions = view.find("regions");
    if (!regions || !regions->value.is_table()) return;
    for (Member& region : regions->value.members) {
        if (!region.value.is_array()) continue;
        Node table;
        table.location = region.location;
        table.members.push_back({"box", region.location, std::move(region.value)});
        region.value = std::move(table);
    }
}

/// true -> "true", false -> "false".
void read_pair(Node* table) {
    Member* member = table ? table->find("pair") : nullptr;
    if (!member || member->value.kind != Node::Kind::flag) return;
    member->value.kind = Node::Kind::text;
    member->value.text = member->value.flag ? "true" : "false";
}

void normalize(Node& root) {
    Member* suite = root.find("suite");
    read_pair(suite ? &suite->value : nullptr);
    read_percent(suite ? &suite->value : nullptr);
    Member* views = root.find("view");
    if (!views) return;
    for (Member& view : views->value.members) {
        read_percent(&view.value);
        read_pair(&view.value);
        expand_regions(view.value);
    }
}

SourceLocation place_of(const Node& root, const char* key, const std::string& file) {
    const Member* suite = root.find("suite");
    const Member* member = suite ? suite->value.find(key) : nullptr;
    return member ? member->value.location : SourceLocation{file, 0, 0};
}

/// Reads the tolerance of [suite].
void read_tolerance(SuiteOptions& options, const SourceLocation& place, std::vector<Diagnostic>& diagnostics) {
    if (options.tolerance_text.empty()) return;
    options.tolerance = parse_tolerance(options.tolerance_text);
    if (!options.tolerance)
        diagnostics.push_back({place,
            fmt::format("suite.tolerance: expected {}, found \"{}\"", tolerance_forms, options.tolerance_text)});
}

SourceLocation place_of_tolerance(const Node& root, const std::string& view, const std::string& file) {
    const Member* views = root.find("view");
    const Member* entry = views ? views->value.find(view) : nullptr;
    const Member* tolerance = entry ? entry->value.find("tolerance") : nullptr;
    return tolerance ? tolerance->value.location : SourceLocation{file, 0, 0};
}

/// Returns the files of one side by view, from its patterns.
std::map<std::string, std::vector<std::string>> files_by_view(const std::vector<FilePattern>& patterns) {
    std::map<std::string, std::vector<std::string>> out;
    for (const FilePattern& pattern : patterns) {
        if (!pattern.has_view())
            throw InputError(pattern.location(), fmt::format("expected {{view}} in the pattern '{}'", pattern.text()));
    }
    for (const std::vector<MatchedFile>& files : files_of_patterns(patterns))
        for (const MatchedFile& file : files) out[file.view].push_back(file.path);
    for (auto& [view, paths] : out) std::sort(paths.begin(), paths.end());
    return out;
}

/// Throws InputError if a file is on both sides.
void check_sides(const Suite& suite, const SourceLocation& place) {
    const auto name = [](const std::string& path) {
        std::error_code ignored;
        const fs::path folder = fs::path(path).parent_path();
        return (fs::weakly_canonical(folder.empty() ? "." : folder, ignored) / fs::path(path).filename()).string();
    };
    for (const SuiteView& view : suite.views) {
        std::set<std::string> baseline;
        for (const std::string& path : view.baseline) baseline.insert(name(path));
        for (const std::string& path : view.candidate)
            if (baseline.contains(name(path)))
                throw InputError(place,
                    fmt::format("expected other files than those of the baseline, found {} on both sides", path));
    }
}

void check_region_names(const Suite& suite, std::vector<Diagnostic>& diagnostics) {
    for (const SuiteView& view : suite.views)
        for (const Region& region : view.regions)
            if (region.name == whole_frame)
                diagnostics.push_back({region.location, "the name 'frame' stands for all pixels: expected another"});
}

void find_renders(Suite& suite, const SourceLocation& candidate_place, bool baseline_only) {
    auto baseline = files_by_view(suite.baseline), candidate = files_by_view(suite.candidate);
    if (candidate.empty() && !baseline_only)
        throw InputError(candidate_place,
            fmt::format("expected renders of the candidate, found no file that matches '{}'",
                fmt::join(suite.options.candidate, "', '")));
    std::vector<std::string> names;
    for (const auto* side : {&baseline, &candidate})
        for (const auto& [name, files] : *side) names.push_back(name);
    if (suite.manifest)
        for (const auto& [name, entry] : suite.manifest->views) names.push_back(name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::vector<Diagnostic> unknown;
    check_region_names(suite, unknown);
    for (const SuiteView& view : suite.views)
        if (!std::binary_search(names.begin(), names.end(), view.name))
            unknown.push_back({view.location,
                fmt::format("no render of a view '{}': expected one of {}{}", view.name, listed(names, ", "),
                    hint(view.name, names))});
    throw_if_any(std::move(unknown));
    std::vector<SuiteView> views;
    for (const std::string& name : names) {
        const auto entry = std::find_if(
            suite.views.begin(), suite.views.end(), [&](const SuiteView& view) { return view.name == name; });
        SuiteView& view = views.emplace_back(entry == suite.views.end() ? SuiteView{} : *entry);
        view.name = name;
        view.baseline = baseline[name];
        view.candidate = candidate[name];
    }
    suite.views = std::move(views);
}

/// Returns the patterns of a folder with VIEW/*.exr, VIEW-SEED.exr or VIEW.exr, and those of other endings. A seed ends
/// with a digit, because names of views may have a '-'.
std::vector<std::string> patterns_in(const std::string& folder, const std::vector<std::string>& endings) {
    std::vector<std::string> out;
    for (const std::string& ending : endings)
        for (const char* file : {"{view}/*", "{view}-*[0-9]", "{view}"})
            out.push_back(pattern_in(folder, file + ending));
    return out;
}

/// Whether a folder has a file that one of its patterns of this ending matches.
bool has_images(const std::string& folder, const std::string& ending) {
    return std::ranges::any_of(patterns_in(folder, {ending}),
        [](const std::string& pattern) { return !FilePattern(pattern, {}, true).find().empty(); });
}

/// Replaces patterns by those of the folders that are given. Renders of the candidate come first: they are stored under
/// the first pattern. Moments are OpenEXR.
void use_folders(const SuiteFlags& flags, SuiteOptions& options) {
    std::vector<std::string> endings;
    const auto add = [&](const std::string& ending) {
        const bool is_plain = !ending.empty() && ending.find_first_of("*?[{%") == std::string::npos;
        if (is_plain && std::ranges::find(endings, ending) == endings.end()) endings.push_back(ending);
    };
    for (const auto& [flag, folder, patterns] : {std::tuple("--candidate", flags.candidate, &options.candidate),
             std::tuple("--baseline", flags.baseline, &options.baseline)}) {
        if (!folder.empty() && !fs::is_directory(folder))
            throw InputError({fmt::format("{} {}", flag, folder), 0, 0}, "expected a folder");
        if (folder.empty())
            for (const std::string& pattern : *patterns) add(fs::path(pattern).extension().string());
        else
            for (const char* ending : image_endings)
                if (has_images(folder, ending)) add(ending);
    }
    add(".exr");
    if (!flags.baseline.empty()) options.baseline = patterns_in(flags.baseline, endings);
    if (!flags.candidate.empty()) options.candidate = patterns_in(flags.candidate, endings);
}

/// Returns the folder that all paths of the patterns are in; nothing if there is none.
std::optional<std::string> common_folder(const std::vector<FilePattern>& patterns) {
    const std::string folder = patterns.front().folder();
    for (const FilePattern& pattern : patterns)
        if (folder != "." && pattern.folder() != folder && !pattern.folder().starts_with(folder + "/")) return {};
    return folder;
}

}  // namespace

std::vector<std::vector<MatchedFile>> files_of_patterns(const std::vector<FilePattern>& patterns) {
    std::vector<std::vector<MatchedFile>> out;
    std::set<std::string> paths;
    for (const FilePattern& pattern : patterns) {
        std::vector<MatchedFile>& files = out.emplace_back(pattern.find());
        std::erase_if(files, [&](const MatchedFile& file) { return !paths.insert(file.path).second; });
    }
    return out;
}

std::string baseline_folder(const Suite& suite) {
    if (const std::optional<std::string> folder = common_folder(suite.baseline)) return *folder;
    throw InputError(suite.baseline.front().location(),
        fmt::format("--accept: expected patterns of the baseline in one folder, found '{}'",
            fmt::join(suite.options.baseline, "', '")));
}

std::size_t Suite::compared() const {
    return static_cast<std::size_t>(std::count_if(views.begin(), views.end(),
        [](const SuiteView& view) { return !view.baseline.empty() && !view.candidate.empty(); }));
}

bool is_suite(const std::string& file) {
    return read_toml(read_text(file, "a compare file"), file).find("suite") != nullptr;
}

Suite read_suite(const std::string& file, const SuiteFlags& flags) {
    ParseContext context;
    context.e.file = file.empty() ? "crescent compare" : file;
    Node root;
    if (!file.empty()) root = read_toml(read_text(file, "a suite file"), file);
    normalize(root);
    const SourceLocation baseline_place = place_of(root, "baseline", context.e.file),
                         candidate_place = place_of(root, "candidate", context.e.file);
    if (!root.find("suite")) root.members.push_back({"suite", {context.e.file, 0, 0}, Node{}});
    put_flags(root, flags.keys);
    Suite suite;
    suite.file = file;
    read_tree(context, suite_schema(), root, &suite);
    read_tolerance(suite.options, place_of(root, "tolerance", context.e.file), context.diagnostics);
    for (SuiteView& view : suite.views) {
        if (view.tolerance_text.empty()) continue;
        view.tolerance = parse_tolerance(view.tolerance_text);
        if (!view.tolerance)
            context.diagnostics.push_back({place_of_tolerance(root, view.name, context.e.file),
                fmt::format(
                    "view.{}.tolerance: expected {}, found \"{}\"", view.name, tolerance_forms, view.tolerance_text)});
    }
    throw_if_any(std::move(context.diagnostics));
    const std::string folder = fs::path(file).parent_path().string();
    SuiteOptions& o = suite.options;
    for (std::vector<std::string>* patterns : {&o.baseline, &o.candidate})
        for (std::string& pattern : *patterns) pattern = pattern_in(folder, pattern);
    if (!flags.baseline.empty() || !flags.candidate.empty()) use_folders(flags, o);
    if (o.baseline.empty()) throw InputError(baseline_place, "expected suite.baseline, or --baseline DIR");
    if (o.candidate.empty() && !flags.baseline_only)
        throw InputError(candidate_place, "expected suite.candidate, or --candidate DIR");
    for (const std::string& pattern : o.baseline) suite.baseline.emplace_back(pattern, baseline_place, true);
    for (const std::string& pattern : o.candidate) suite.candidate.emplace_back(pattern, candidate_place, true);
    if (const std::optional<std::string> place = common_folder(suite.baseline)) suite.manifest = read_manifest(*place);
    find_renders(suite, candidate_place, flags.baseline_only);
    check_sides(suite, candidate_place);
    return suite;
}

Suite read_suite_flags(const std::vector<CompareFlag>& keys) {
    ParseContext context;
    context.e.file = "crescent compare";
    Node root;
    root.members.push_back({"suite", {context.e.file, 0, 0}, Node{}});
    put_flags(root, keys);
    Suite suite;
    read_tree(context, suite_schema(), root, &suite);
    read_tolerance(suite.options, place_of(root, "tolerance", context.e.file), context.diagnostics);
    check_region_names(suite, context.diagnostics);
    throw_if_any(std::move(context.diagnostics));
    return suite;
}

std::string suite_schema_text() { return manual_of(suite_schema()); }

}  // namespace crescent
