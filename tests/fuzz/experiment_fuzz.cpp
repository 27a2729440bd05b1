// Any bytes as an experiment file: it is read, or rejected with an InputError that has a message. Lines that start with
// "--set " are overrides. An experiment that is read satisfies the guarantees of experiment.h.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/assertion.h"
#include "experiment/experiment.h"
#include "experiment/identity.h"
#include "experiment/published.h"

namespace {

using namespace crescent;

/// Takes the override lines out of the text.
std::vector<std::string> split_overrides(std::string& text) {
    std::vector<std::string> overrides;
    for (std::size_t at; (at = text.rfind("\n--set ")) != std::string::npos; text.resize(at)) {
        const std::string line = text.substr(at + 7);
        overrides.insert(overrides.begin(), line.substr(0, line.find('\n')));
    }
    return overrides;
}

void keeps_its_promises(const Experiment& e) {
    ensure(e.surface_count() > 0 && !e.arms.empty(), "surfaces and arms are required");
    for (const Region& r : e.regions)
        ensure(r.box.x0 >= 0 && r.box.y0 >= 0 && r.box.width() > 0 && r.box.height() > 0 && r.box.x1 < e.image.width &&
                r.box.y1 < e.image.height,
            "a region lies on the image");
    for (const ArmPlan& arm : e.arms) ensure(!arm.n.empty() && arm.n.back() <= 16777216, "an arm has sample counts");
    for (const PlatePlan& plate : e.plates)
        for (const PlateRun& run : plate.runs)
            ensure(e.find_arm(run.arm) && run.n > 0, "a plate's run names an arm and a sample count");
    for (const AssertionPlan& a : e.assertions) {
        std::string why;
        const auto again = parse_comparison(to_string(a.check), why);
        ensure(again && to_string(*again) == to_string(a.check), "a check is written as it is read");
    }
    const Experiment other = e.with_s(7);
    ensure(e.s() == 0 || other.s() == 7, "with_s changes s");
}

template <class F> void refuses_or_reads(F&& read) {
    try {
        read();
    } catch (const InputError& error) {
        ensure(!error.diagnostics().empty() && !error.diagnostics().front().message.empty(), "a refusal says why");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string text(reinterpret_cast<const char*>(data), size);
    refuses_or_reads([&] { (void)parse_published(text, "fuzz.json"); });
    std::string why;
    (void)parse_comparison(text, why);
    const std::vector<std::string> overrides = split_overrides(text);
    refuses_or_reads([&] {
        const Experiment e = parse(text, "fuzz.toml", overrides);
        keeps_its_promises(e);
        ensure(hash(parse(text, "other.toml", overrides)) == hash(e), "the hash is of the values");
        ensure(hash(parse(canonical_text(e), "fuzz.toml")) == hash(e), "an experiment is read back as itself");
    });
    return 0;
}
