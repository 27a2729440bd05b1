// A result as test cases and annotations, for build servers and code hosts.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crescent {

struct TestCase {
    enum class State { passed, failed, error, skipped };

    std::string group, name;
    State state = State::passed;
    std::string message, text;      // of all except passed cases; text: in full, "" if the message is all
    std::optional<double> seconds;  // if it varies from run to run and is still requested
};

/// What is not right, at a line of a file.
struct Annotation {
    std::string rule, level;  // level: error, warning or note
    std::string message;
    std::string file;      // with a line; "": of no file
    unsigned line = 0;     // 0: unknown
    std::string identity;  // equal in two calls if both find the same
};

/// A run, a check or a comparison.
struct TestReport {
    std::string name;
    std::vector<std::pair<std::string, std::string>> properties{};
    std::vector<TestCase> cases{};
    std::vector<std::string> rules{};  // every rule that an annotation may have
    std::vector<Annotation> annotations{};
    std::string version{};  // of crescent
};

}  // namespace crescent
