// The elements and attributes that build servers read: testsuites, testsuite, properties, testcase and its outcome.
#include "output/junit.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/text.h"

namespace crescent {

namespace {

/// Returns the element for the outcome of a case, "" if it passed.
std::string outcome(const TestCase& c) {
    const char* tag = c.state == TestCase::State::failed ? "failure"
        : c.state == TestCase::State::error              ? "error"
        : c.state == TestCase::State::skipped            ? "skipped"
                                                         : nullptr;
    if (!tag) return "";
    const std::string head = fmt::format("      <{} message=\"{}\"", tag, escape(c.message));
    return c.text.empty() ? head + " />\n" : fmt::format("{}>{}</{}>\n", head, escape(c.text), tag);
}

std::string case_text(const TestCase& c) {
    std::string head = fmt::format("    <testcase classname=\"{}\" name=\"{}\"", escape(c.group), escape(c.name));
    if (c.seconds) head += fmt::format(" time=\"{:.3f}\"", *c.seconds);
    const std::string details = outcome(c);
    return details.empty() ? head + " />\n" : head + ">\n" + details + "    </testcase>\n";
}

std::string counts_of(const std::vector<TestCase>& cases) {
    const auto count = [&](TestCase::State state) { return std::ranges::count(cases, state, &TestCase::state); };
    std::string out = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"", cases.size(),
        count(TestCase::State::failed), count(TestCase::State::error), count(TestCase::State::skipped));
    double seconds = 0;
    for (const TestCase& c : cases) seconds += c.seconds.value_or(0);
    if (std::ranges::any_of(cases, [](const TestCase& c) { return c.seconds.has_value(); }))
        out += fmt::format(" time=\"{:.3f}\"", seconds);
    return out;
}

}  // namespace

std::string junit_text(const TestReport& report) {
    const std::string counts = counts_of(report.cases);
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    out += fmt::format("<testsuites name=\"crescent\" {}>\n", counts);
    out += fmt::format("  <testsuite name=\"{}\" {}>\n", escape(report.name), counts);
    if (!report.properties.empty()) out += "    <properties>\n";
    for (const auto& [name, value] : report.properties)
        out += fmt::format("      <property name=\"{}\" value=\"{}\" />\n", escape(name), escape(value));
    if (!report.properties.empty()) out += "    </properties>\n";
    for (const TestCase& c : report.cases) out += case_text(c);
    return out + "  </testsuite>\n</testsuites>\n";
}

}  // namespace crescent
