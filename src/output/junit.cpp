// One <testsuites> around one <testsuite>: counts by state, properties, then the cases in their order. Times are in
// seconds to a thousandth and are written only if a case has one; a suite's is their sum.
#include "output/junit.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"

namespace crescent::inline output {

namespace {

/// Returns the element for the outcome of a case, "" if it passed.
std::string outcome(const JunitCase& c) {
    const char* tag = c.state == JunitCase::State::failed ? "failure"
        : c.state == JunitCase::State::error              ? "error"
        : c.state == JunitCase::State::skipped            ? "skipped"
                                                          : nullptr;
    if (!tag) return "";
    const std::string head = fmt::format("      <{} message=\"{}\"", tag, escape(c.message));
    return c.text.empty() ? head + " />\n" : fmt::format("{}>{}</{}>\n", head, escape(c.text), tag);
}

std::string case_text(const JunitCase& c) {
    std::string head = fmt::format("    <testcase classname=\"{}\" name=\"{}\"", escape(c.group), escape(c.name));
    if (c.seconds) head += fmt::format(" time=\"{:.3f}\"", *c.seconds);
    const std::string how = outcome(c);
    return how.empty() ? head + " />\n" : head + ">\n" + how + "    </testcase>\n";
}

std::string counts_of(const std::vector<JunitCase>& cases) {
    const auto count = [&](JunitCase::State state) { return std::ranges::count(cases, state, &JunitCase::state); };
    std::string out = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"", cases.size(),
        count(JunitCase::State::failed), count(JunitCase::State::error), count(JunitCase::State::skipped));
    double seconds = 0;
    for (const JunitCase& c : cases) seconds += c.seconds.value_or(0);
    if (std::ranges::any_of(cases, [](const JunitCase& c) { return c.seconds.has_value(); }))
        out += fmt::format(" time=\"{:.3f}\"", seconds);
    return out;
}

}  // namespace

std::string junit_text(const JunitSuite& suite) {
    const std::string counts = counts_of(suite.cases);
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    out += fmt::format("<testsuites name=\"crescent\" {}>\n", counts);
    out += fmt::format("  <testsuite name=\"{}\" {}>\n", escape(suite.name), counts);
    if (!suite.properties.empty()) out += "    <properties>\n";
    for (const auto& [name, value] : suite.properties)
        out += fmt::format("      <property name=\"{}\" value=\"{}\" />\n", escape(name), escape(value));
    if (!suite.properties.empty()) out += "    </properties>\n";
    for (const JunitCase& c : suite.cases) out += case_text(c);
    return out + "  </testsuite>\n</testsuites>\n";
}

}  // namespace crescent::inline output
