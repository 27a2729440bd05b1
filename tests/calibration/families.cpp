// The list of families. A case identifies its family by the index in this list: append, do not reorder.
#include <stdexcept>

#include "tests/calibration/sampler.h"

namespace crescent::calibration {

const std::vector<Family>& families() {
    static const std::vector<Family> all = [] {
        std::vector<Family> out;
        for (const auto& some : {lobe_families(), phase_families(), light_families(), microfacet_families(),
                 table_families(), held_out_families()})
            out.insert(out.end(), some.begin(), some.end());
        return out;
    }();
    return all;
}

const Family& family_named(std::string_view name) {
    for (const Family& f : families())
        if (f.name == name) return f;
    throw std::invalid_argument("no calibration family '" + std::string(name) + "'");
}

Sampler sampler_of(const Family& family, const Member& member, Real real, double stretch, Broken broken) {
    Sampler s{family.name, member.text, family.numbers, family.wo, family.domain, member.eta, family.reciprocal, {}};
    if (real == Real::f64) s.functions = member.in_double(stretch, broken);
    else s.functions = member.in_float(stretch, broken);
    return s;
}

}  // namespace crescent::calibration
