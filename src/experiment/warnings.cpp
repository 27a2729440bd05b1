// For each shape, the largest channel of rho_d plus rho_s against 1; reflectances have no unit. Evidence that was asked
// for and cannot be measured.
#include "experiment/warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiment/evidence_subject.h"

namespace crescent::inline experiment {

std::vector<std::string> warnings_of(const Experiment& experiment) {
    std::vector<std::string> out;
    for (const Shape& shape : experiment.shapes) {
        const double albedo = std::ranges::max(shape.material.rho_d) + shape.material.rho_s;
        if (albedo > 1)
            out.push_back(fmt::format(
                "{}: rho_d + rho_s is {:.4g}, above 1: it reflects more than it receives", shape.name, albedo));
    }
    if (const std::string why = why_no_evidence(experiment); experiment.note_evidence && !why.empty())
        out.push_back("note_evidence measures nothing: " + why);
    return out;
}

}  // namespace crescent::inline experiment
