// What is to be said of files, once for all files of which it is to be said.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace crescent::inline comparing {

class FileWarnings {
public:
    /// "FILE: TEXT", or "FILE: N pixels TEXT". Files with the same `kind` (by default the text) share a line.
    void add(const std::string& file, const std::string& text, std::uint64_t pixels = 0, const std::string& kind = "");
    /// In the order in which each was first added: with how many files it is of, and the first.
    std::vector<std::string> lines() const;

private:
    struct Kind {
        std::string kind, file, text;  // of the first
        std::uint64_t files = 0, fewest = 0, most = 0;
    };
    std::vector<Kind> kinds_;
};

}  // namespace crescent::inline comparing
