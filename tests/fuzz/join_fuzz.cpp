// Any text as the metrics.json of a run: it is joined, with itself too, or rejected with an InputError that has a
// message. The hash of the experiment in it is made right first, since no mutation would guess it.
#include <cstdint>
#include <fmt/format.h>
#include <string>

#include "base/errors.h"
#include "experiment/experiment.h"
#include "experiment/identity.h"
#include "output/format.h"
#include "run/collect.h"
#include "run/join.h"

namespace {

using namespace crescent;

std::string with_its_hash(const std::string& text) {
    try {
        Json json = Json::parse(text, [](int depth, Json::parse_event_t, const Json&) {
            if (depth > 100) throw Json::other_error::create(501, "deep", static_cast<const Json*>(nullptr));
            return true;
        });
        Json& about = json.at("provenance").at("experiment");
        const Experiment e = parse(about.at("text").get<std::string>(), "metrics.json");
        about["hash"] = fmt::format("{:016x}", hash(e));
        return json.dump();
    } catch (const std::exception&) { return text; }
}

void join_or_refuse(const std::vector<std::string>& texts) {
    try {
        const Measured joined = join_texts(texts, "fuzz");
        ensure(!joined.provenance.seeds.empty(), "a joined run has seeds");
    } catch (const InputError& error) {
        ensure(!error.diagnostics().empty() && !error.diagnostics().front().message.empty(), "a refusal says why");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size), right = with_its_hash(text);
    join_or_refuse({text});
    join_or_refuse({right});
    join_or_refuse({right, right});
    return 0;
}
