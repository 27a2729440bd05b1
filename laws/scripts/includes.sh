#!/bin/bash
# Who includes whom: a file in src/ its own folder and those that CMakeLists.txt lists above it; a door crescent.h and
# its own files; nobody a door.
. "$(dirname "$0")/common.sh"
cd "$CRESCENT_SOURCE" || exit 1

doors='cli gl explainer python web'
awk '
    FILENAME == "CMakeLists.txt" {
        if (sub(/^ *crescent_folder\(/, "")) { sub(/[ )].*/, ""); rank[$0] = ++count }
        next
    }
    !/^[ \t]*#[ \t]*include[ \t]*"/ { next }
    {
        split($0, quoted, "\"")
        target = quoted[2]
        parts = split(FILENAME, from, "/")
        folder = index(target, "/") ? substr(target, 1, index(target, "/") - 1) : ""
        wrong = ""
        if (folder ~ /^(cli|gl|explainer|python|web)$/) { if (from[1] != folder) wrong = "a door is included" }
        else if (from[1] == "src" && parts > 2) {
            if (folder == "") {
                if (system("test -f src/" from[2] "/" target) != 0)
                    wrong = "a file of src/ itself is included from a folder"
            }
            else if (!(folder in rank)) wrong = "not a folder of src/"
            else if (rank[folder] > rank[from[2]]) wrong = folder " stands below " from[2]
        }
        # Beside the public face: the matchers, which need GoogleTest, verdicts alone, and what `crescent check` judges
        # of the laws: planted faults, right samplers.
        else if (from[1] != "src" && from[1] != "laws" && target != "crescent.h" && target != "core.h" &&
                 target !~ /^(verdicts\/(gtest|user|print)|laws\/(planted\/planted|right\/law))\.h$/) {
            dir = FILENAME; sub(/[^\/]*$/, "", dir)
            if (system("test -f \"" dir target "\" -o -f \"" from[1] "/" target "\"") != 0)
                wrong = "a door includes more than crescent.h"
        }
        if (wrong != "") { print FILENAME ":" FNR ": " target ": " wrong; bad = 1 }
    }
    END { exit bad }
' CMakeLists.txt $(find src $doors laws bench examples \( -name '*.cpp' -o -name '*.h' \) 2>/dev/null) || exit 1
