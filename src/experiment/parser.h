// An experiment while it is being read: values so far and every mistake so far.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "experiment/experiment.h"
#include "experiment/schema.h"

namespace crescent {

// ---- An experiment file as a tree of plain nodes in file order, each with its place. The only interface to the TOML
// parser.

struct Member;

/// One TOML value. Tables and arrays keep their members in file order; an array's members have no key.
struct Node {
    enum class Kind { table, array, text, integer, number, flag, date };
    Kind kind = Kind::table;
    SourceLocation location;
    std::vector<Member> members;  // table, array
    std::string text;
    std::int64_t integer = 0;
    double number = 0;  // number; integers too
    bool flag = false;

    bool is_table() const { return kind == Kind::table; }
    bool is_array() const { return kind == Kind::array; }
    const Member* find(std::string_view key) const;
    Member* find(std::string_view key);
};

struct Member {
    std::string key;
    SourceLocation location;  // of the key
    Node value;
};

/// Returns "the text 'red'", "3.5", "a table": what was found, for messages.
std::string describe(const Node& node);

/// Reads TOML; throws InputError if the syntax is wrong or a name is given twice. `file` is in every place.
Node read_toml(std::string_view text, const std::string& file);

/// A value that refers to another name in the file.
struct Reference {
    Type type;
    std::string path, name;
};

struct ParseContext {
    Experiment e;
    std::vector<Diagnostic> diagnostics;
    std::set<std::string> invalid_paths;  // paths whose values cannot be used
    std::vector<Reference> references;

    void report(const std::string& path, const std::string& message, Diagnostic::Kind kind = Diagnostic::Kind::other);
    void report(const std::string& path, const SourceLocation& place, const std::string& message,
        Diagnostic::Kind kind = Diagnostic::Kind::other);
    bool is_valid(const std::string& path) const { return !invalid_paths.contains(path); }
};

/// Returns "; did you mean 'phong'?", or nothing if no valid word is near.
std::string hint(std::string_view word, const std::vector<std::string>& valid);

/// Checks one value against its key; reports an error and returns false if it does not fit.
bool read_value(ParseContext& context, const Key& key, const Node& node, const std::string& path, Value& value);

/// Walks the table over the tree: unknown and missing keys, types, ranges; fills context.e.
void read_tree(ParseContext& context, const Node& root);
/// The same for another table: values go into `object`, places and diagnostics into the context.
void read_tree(ParseContext& context, const Section& table, const Node& root, void* object);

/// Throws one InputError with all diagnostics in file order; returns if there is none.
void throw_if_any(std::vector<Diagnostic> diagnostics);

/// Puts "path=value" overrides into the tree.
void apply_overrides(ParseContext& context, Node& root, const std::vector<std::string>& overrides);
/// Checks keys against each other: names that must exist, regions on the image, the camera, degenerate shapes.
void check_geometry(ParseContext& context);
void check_names(ParseContext& context);

/// Fills in what depends on other keys (s, n, the sample counts of ladder plates) and checks runs against arms and
/// exponents.
void resolve_runs(ParseContext& context);
/// Gives regions without a box the whole image, and those of an object its surface.
void resolve_regions(ParseContext& context);

/// Returns why the experiment makes no run of this arm at this s (0: its own); "" if it does. Does not check the sample
/// count.
std::string why_not_run(const Experiment& e, const std::string& arm, std::uint64_t n, double s);

/// Parses every assertion and checks that all it names will be measured.
void resolve_assertions(ParseContext& context);

// ---- Arms that combine samplers.

/// The word for a sampler that is no sampler of its own but the combination a renderer uses in the scene.
inline constexpr const char* renderer_word = "renderer";
/// Returns the words of the key 'sampler'.
std::vector<std::string> sampler_words();
/// Makes each arm with that word the combination of `material` with a sampler for each kind of light of the scene;
/// under a fill alone, `material`. After shapes, meshes and lights were read.
void expand_renderers(ParseContext& context);

/// Reports every mistake in an arm with a kind: after names and shapes were read.
void check_combinations(ParseContext& context);

}  // namespace crescent
