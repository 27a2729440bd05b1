// One run with a result for each annotation (SARIF 2.1.0, 3.14 and 3.27); paths as URIs.
#include "output/sarif.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "output/format.h"

namespace crescent {

namespace {

/// A path as a URI (RFC 3986, 3.3); relative ones stay relative.
std::string uri_of(const std::string& path) {
    std::string out = path.starts_with('/') ? "file://" : "";
    for (const char c : path) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
            std::string_view("-._~/").find(c) != std::string_view::npos;
        out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
    return out;
}

}  // namespace

std::string sarif_text(const TestReport& report) {
    Json rule_list = Json::array(), result_list = Json::array();
    for (const std::string& rule : report.rules) rule_list.push_back({{"id", rule}});
    for (const Annotation& result : report.annotations) {
        const std::string uri = result.file.empty() ? "." : uri_of(result.file);
        const Json place = {{"physicalLocation",
            {{"artifactLocation", {{"uri", uri}}}, {"region", {{"startLine", std::max(1u, result.line)}}}}}};
        result_list.push_back(
            {{"ruleId", result.rule}, {"level", result.level}, {"message", {{"text", result.message}}},
                {"locations", Json::array({place})}, {"partialFingerprints", {{"crescent", result.identity}}}});
    }
    const Json driver = {{"name", "crescent"}, {"version", report.version}, {"rules", rule_list}};
    const Json run = {{"tool", {{"driver", driver}}}, {"results", result_list}};
    return text({{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"}, {"version", "2.1.0"},
        {"runs", Json::array({run})}});
}

}  // namespace crescent
