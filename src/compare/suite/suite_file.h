// Reads a suite file, or the flags that replace it, and finds the renders of each view.
#pragma once

#include <string>
#include <vector>

#include "compare/file_pattern.h"
#include "compare/plan.h"
#include "compare/suite/suite.h"

namespace crescent {

/// Flags that replace or complete the keys of a suite file.
struct SuiteFlags {
    std::vector<CompareFlag> keys;    // of [suite]
    std::string baseline, candidate;  // folders with VIEW/*.exr, VIEW-SEED.exr or VIEW.exr; "": the file's patterns
    bool baseline_only = false;       // no renders of the candidate are needed
};

/// Returns whether the file is a suite: it has a table [suite].
bool is_suite(const std::string& file);
/// Reads a suite file ("": none, the folders of the flags) and finds the renders of each view. Throws InputError.
Suite read_suite(const std::string& file, const SuiteFlags& flags);
/// Returns the files of each pattern; a file that several match belongs to the first of them.
std::vector<std::vector<MatchedFile>> files_of_patterns(const std::vector<FilePattern>& patterns);
/// Returns the tables [suite] and [view.NAME] that flags alone make, without renders. Throws InputError.
Suite read_suite_flags(const std::vector<CompareFlag>& keys);
/// Returns the manual of a suite file.
std::string suite_schema_text();

/// Returns the folder of the baseline: the part before the first wildcard of its first pattern. Throws InputError if
/// another pattern is not in it.
std::string baseline_folder(const Suite& suite);

}  // namespace crescent
