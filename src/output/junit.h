// junit.xml for build servers: one suite, of a run, a result or a comparison.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crescent::inline output {

struct JunitCase {
    enum class State { passed, failed, error, skipped };

    std::string group, name;
    State state = State::passed;
    std::string message, text;      // of all except passed cases; text: in full, "" if the message is all
    std::optional<double> seconds;  // if it varies from run to run and is still requested
};

struct JunitSuite {
    std::string name;
    std::vector<std::pair<std::string, std::string>> properties;
    std::vector<JunitCase> cases;
};

/// Returns the file. Any text is allowed in it: it is escaped here. Equal suites give equal bytes.
std::string junit_text(const JunitSuite& suite);

}  // namespace crescent::inline output
