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
#include "experiment/tree.h"

namespace crescent {

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

/// Walks the table over the tree: unknown and missing keys, types, ranges; fills context.e.
void read_tree(ParseContext& context, const Node& root);
/// The same for another table: values go into `object`, places and diagnostics into the context.
void read_tree(ParseContext& context, const Section& table, const Node& root, void* object);

/// Throws one InputError with all diagnostics in file order; returns if there is none.
void throw_if_any(std::vector<Diagnostic> diagnostics);

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

}  // namespace crescent
