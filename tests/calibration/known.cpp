// Planted faults with known verdicts: all of tests/known_samplers/faulty, including the held-out ones.
#include "tests/calibration/cases.h"
#include "tests/known_samplers/faulty/planted.h"

namespace crescent::calibration {

namespace {

const std::vector<PlantedFault>& all_known() {
    static const std::vector<PlantedFault> all = [] {
        std::vector<PlantedFault> out = planted_faults(false);
        for (auto& some : {held_out_faults(), held_out_lobe_faults()}) out.insert(out.end(), some.begin(), some.end());
        return out;
    }();
    return all;
}

}  // namespace

std::uint64_t count_known() { return all_known().size(); }

Case make_known(const CaseKey& key) {
    const PlantedFault& fault = all_known().at(key.index);
    Case c;
    c.family = fault.breaks;
    c.kind = fault.name;
    c.cause = fault.cause;
    c.expected = State::wrong;
    c.check_cases = fault.check_cases;
    if (key.wo > 0 && c.check_cases.size() > static_cast<std::size_t>(key.wo))
        c.check_cases.resize(static_cast<std::size_t>(key.wo));
    return c;
}

}  // namespace crescent::calibration
