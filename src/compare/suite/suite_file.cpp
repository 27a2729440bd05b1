// Reads a suite file: the table of its keys, and the files of each view.
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <glob.h>
#include <map>
#include <regex>

#include "compare/suite/suite.h"
#include "experiment/parser.h"
#include "experiment/schema.h"

namespace crescent::inline comparison {

namespace {

constexpr std::string_view view_field = "{view}";
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
            {"exposure", Type::number, {0, 1e6, true}, "", defaulted, "1", "Of the pictures in the report.",
                to<&SuiteOptions::exposure>},
            {"brightest", Type::number, positive, "", optional, "not known",
                "The largest possible Y of a pixel of one render, such as a clamp.", to<&SuiteOptions::brightest>},
            {"store", Type::word, none, "", defaulted, "\"renders\"",
                "What --accept stores: the renders, or the mean and the variance of each pixel.",
                to<&SuiteOptions::store>, {"renders", "moments"}}},
        {}};
}

Section view_table() {
    return {"view", Multiplicity::titled, optional, "What differs for one view.", in<&Suite::views>,
        {{"smallest", Type::number, share, "", optional, "that of [suite]",
            "Relative difference of mean Y that must be found in this view.", to<&SuiteView::smallest>}},
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
    Member* found = table ? table->find("smallest") : nullptr;
    if (!found || found->value.kind != Node::Kind::text) return;
    static const std::regex form(R"(\s*([0-9]+\.?[0-9]*(?:[eE][-+]?[0-9]+)?)\s*%\s*)");
    std::smatch match;
    if (!std::regex_match(found->value.text, match, form)) return;
    found->value.kind = Node::Kind::number;
    found->value.number = std::stod(match[1]) / 100;
}

/// regions.NAME = [...] -> regions.NAME.box = [...].
void expand_regions(Node& view) {
    Member* regions = view.find("regions");
    if (!regions || !regions->value.is_table()) return;
    for (Member& region : regions->value.members) {
        if (!region.value.is_array()) continue;
        Node table;
        table.at = region.at;
        table.members.push_back({"box", region.at, std::move(region.value)});
        region.value = std::move(table);
    }
}

void normalize(Node& root) {
    Member* suite = root.find("suite");
    read_percent(suite ? &suite->value : nullptr);
    Member* views = root.find("view");
    if (!views) return;
    for (Member& view : views->value.members) read_percent(&view.value), expand_regions(view.value);
}

SourceLocation place_of(const Node& root, const char* key, const std::string& file) {
    const Member* suite = root.find("suite");
    const Member* found = suite ? suite->value.find(key) : nullptr;
    return found ? found->value.at : SourceLocation{file, 0, 0};
}

/// Returns the files of one side by view, from its patterns.
std::map<std::string, std::vector<std::string>> files_by_view(
    const std::vector<std::string>& patterns, const SourceLocation& at) {
    std::map<std::string, std::vector<std::string>> out;
    for (const std::string& pattern : patterns) {
        if (pattern.find(view_field) == std::string::npos)
            throw InputError(at, fmt::format("expected {{view}} in the pattern '{}'", pattern));
        for (const MatchedFile& file : match_views(pattern)) out[file.view].push_back(file.path);
    }
    for (auto& [view, paths] : out) {
        std::sort(paths.begin(), paths.end());
        paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
    }
    return out;
}

void find_renders(
    Suite& suite, const SourceLocation& baseline_at, const SourceLocation& candidate_at, bool baseline_only) {
    auto baseline = files_by_view(suite.options.baseline, baseline_at);
    auto candidate = files_by_view(suite.options.candidate, candidate_at);
    if (candidate.empty() && !baseline_only)
        throw InputError(candidate_at,
            fmt::format("expected renders of the candidate, found no file that matches '{}'",
                fmt::join(suite.options.candidate, "', '")));
    std::vector<std::string> names;
    for (const auto* side : {&baseline, &candidate})
        for (const auto& [name, files] : *side) names.push_back(name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::vector<Diagnostic> unknown;
    for (const SuiteView& view : suite.views)
        for (const Region& region : view.regions)
            if (region.name == whole_frame)
                unknown.push_back({region.at, "the name 'frame' stands for all pixels: expected another"});
    for (const SuiteView& view : suite.views)
        if (!std::binary_search(names.begin(), names.end(), view.name))
            unknown.push_back({view.at,
                fmt::format("no render of a view '{}': expected one of {}{}", view.name, listed(names, ", "),
                    hint(view.name, names))});
    throw_if_any(std::move(unknown));
    std::vector<SuiteView> views;
    for (const std::string& name : names) {
        const auto stated = std::find_if(
            suite.views.begin(), suite.views.end(), [&](const SuiteView& view) { return view.name == name; });
        SuiteView& view = views.emplace_back(stated == suite.views.end() ? SuiteView{} : *stated);
        view.name = name, view.baseline = baseline[name], view.candidate = candidate[name];
    }
    suite.views = std::move(views);
}

/// Returns the patterns of a folder with VIEW/*.exr or VIEW-SEED.exr.
std::vector<std::string> patterns_in(const std::string& folder, const char* flag) {
    if (!std::filesystem::is_directory(folder))
        throw InputError({fmt::format("{} {}", flag, folder), 0, 0}, "expected a folder");
    return {folder + "/{view}/*.exr", folder + "/{view}-*.exr"};
}

}  // namespace

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
    const SourceLocation baseline_at = place_of(root, "baseline", context.e.file),
                         candidate_at = place_of(root, "candidate", context.e.file);
    if (!root.find("suite")) root.members.push_back({"suite", {context.e.file, 0, 0}, Node{}});
    put_flags(root, flags.keys);
    Suite suite;
    suite.file = file;
    read_tree(context, suite_schema(), root, &suite);
    throw_if_any(std::move(context.diagnostics));
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    SuiteOptions& o = suite.options;
    for (std::vector<std::string>* patterns : {&o.baseline, &o.candidate})
        for (std::string& pattern : *patterns)
            if (!folder.empty()) pattern = (folder / pattern).string();
    if (!flags.baseline.empty()) o.baseline = patterns_in(flags.baseline, "--baseline");
    if (!flags.candidate.empty()) o.candidate = patterns_in(flags.candidate, "--candidate");
    if (o.baseline.empty()) throw InputError(baseline_at, "expected suite.baseline, or --baseline DIR");
    if (o.candidate.empty() && !flags.baseline_only)
        throw InputError(candidate_at, "expected suite.candidate, or --candidate DIR");
    find_renders(suite, baseline_at, candidate_at, flags.baseline_only);
    return suite;
}

std::string suite_schema_text() { return manual_of(suite_schema()); }

// ---- Patterns with {view}.

namespace {

/// One piece of a pattern: text as it is, the view, or a wildcard.
struct PatternPiece {
    enum class Kind { text, view, wildcard } kind = Kind::text;
    std::string text;   // of text: itself; of a wildcard: its glob
    std::string regex;  // of a wildcard
};

std::vector<PatternPiece> pieces_of(const std::string& pattern) {
    std::vector<PatternPiece> out;
    std::string text;
    const auto add = [&](PatternPiece piece) {
        if (!text.empty()) out.push_back({PatternPiece::Kind::text, std::exchange(text, {}), {}});
        out.push_back(std::move(piece));
    };
    static const std::regex digits("%[0-9]*d"), set(R"(\[!?[^\]/]+\])");
    for (std::size_t i = 0; i < pattern.size();) {
        const auto from = pattern.cbegin() + static_cast<std::ptrdiff_t>(i);
        std::smatch match;
        const auto at = std::regex_constants::match_continuous;
        if (pattern.compare(i, view_field.size(), view_field) == 0)
            add({PatternPiece::Kind::view, {}, {}}), i += view_field.size();
        else if (pattern[i] == '*') add({PatternPiece::Kind::wildcard, "*", "[^/]*?"}), ++i;
        else if (pattern[i] == '?') add({PatternPiece::Kind::wildcard, "?", "[^/]"}), ++i;
        else if (std::regex_search(from, pattern.cend(), match, digits, at))
            add({PatternPiece::Kind::wildcard, "*", "[0-9]+"}), i += static_cast<std::size_t>(match.length());
        else if (std::regex_search(from, pattern.cend(), match, set, at)) {
            std::string regex = match.str();
            if (regex[1] == '!') regex[1] = '^';
            add({PatternPiece::Kind::wildcard, match.str(), regex}), i += static_cast<std::size_t>(match.length());
        } else text += pattern[i++];
    }
    if (!text.empty()) out.push_back({PatternPiece::Kind::text, text, {}});
    return out;
}

std::string regex_text(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (std::string_view(R"(\^$.|?*+()[]{})").find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
    return out;
}

}  // namespace

std::vector<MatchedFile> match_views(const std::string& pattern) {
    std::string glob, regex;
    std::vector<std::size_t> wildcards;
    std::size_t view = 0, group = 0;
    for (const PatternPiece& piece : pieces_of(pattern)) {
        if (piece.kind == PatternPiece::Kind::text) {
            for (const char c : piece.text) glob += c == '\\' ? std::string("\\\\") : std::string(1, c);
            regex += regex_text(piece.text);
        } else if (piece.kind == PatternPiece::Kind::wildcard) {
            glob += piece.text, regex += "(" + piece.regex + ")";
            wildcards.push_back(++group);
        } else {
            glob += "*";
            if (view == 0) regex += "([^/]+)", view = ++group;
            else regex += fmt::format("\\{}", view);
        }
    }
    glob_t found{};
    const bool failed = ::glob(glob.c_str(), GLOB_ERR, nullptr, &found) != 0;
    const std::regex form(regex);
    std::vector<MatchedFile> out;
    for (std::size_t i = 0; !failed && i < found.gl_pathc; ++i) {
        const std::string path = found.gl_pathv[i];
        std::smatch match;
        if (!std::regex_match(path, match, form) || std::filesystem::is_directory(path)) continue;
        MatchedFile file{path, match[view], {}};
        for (const std::size_t k : wildcards) file.wildcards.push_back(match[k]);
        out.push_back(std::move(file));
    }
    ::globfree(&found);
    return out;
}

std::optional<std::string> path_from(
    const std::string& pattern, const std::string& view, const std::vector<std::string>& wildcards) {
    std::string out;
    std::size_t next = 0;
    for (const PatternPiece& piece : pieces_of(pattern)) {
        if (piece.kind == PatternPiece::Kind::text) out += piece.text;
        else if (piece.kind == PatternPiece::Kind::view) out += view;
        else if (next < wildcards.size()) out += wildcards[next++];
        else return {};
    }
    if (next != wildcards.size()) return {};
    return out;
}

}  // namespace crescent::inline comparison
