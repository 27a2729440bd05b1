// The planted faults whose cause can be named, with a word of it.
#include <map>

#include "tests/known_samplers/faulty/planted.h"

namespace crescent {

std::string cause_of(const std::string& fault) {
    static const std::map<std::string, std::string> causes = {
        {"s+2 for s+1 in the pdf", "a constant"}, {"exponent s+1 for s in the pdf", "w_i.R"},
        {"1/(s+2) for 1/(s+1) in the warp", "w_i.R"}, {"pdf renormalised over the horizon", "a constant"},
        {"cosine folded in twice", "cos theta_i"}, {"cosine left out of the pdf", "cos theta_i"},
        {"missing 4(w.h)", "w_o.m"}, {"n.h for w.h in the Jacobian", "(n.m) / (w_o.m)"},
        {"missing G1 in the density of visible normals", "a constant"}, {"area measure for solid angle", "distance^2"},
        {"light's cosine left out", "cosine at the light"}, {"pdf off by 1 %", "a constant"},
        {"lights chosen by power, weighed alike", "chooser"}, {"sqrt forgotten", "square root"},
        {"lobe chosen by one weight, weighed by another", "the chooser's probability"},
        {"frame mirrored for half of the azimuths", "mirrored"}, {"swapped w_o and w_i in pdf(w)", "cos theta_i"},
        {"cosine left out of the weight", "cos theta_i"}, {"BRDF scaled by 1.01", "a constant"},
        {"bound forgotten in the density", "a constant"},
        {"eta not inverted for w_o below", "above and below exchanged"},
        {"delta mass counted in the pdf", "a constant"}, {"delta mass taken off the pdf twice", "a constant"},
        {"delta part drawn less often than it says", "the chooser's probability"},
        {"environment pdf without sin theta", "sin theta_i"}, {"4 pi for 2 pi^2 sin theta", "sin theta_i"},
        {"eta^2 left out of f", "eta^2"}, {"eta^2 for 1/eta^2 in f", "eta^2"},
        {"cosine of w_i left in f across the surface", "cos theta_i"},
        {"transmission pdf without its Jacobian", "the Jacobian of refraction"},
        {"eta^2 left out of the transmission Jacobian", "eta^2"},
        {"reflection Jacobian for transmission", "the Jacobian of refraction for that of reflection"},
        {"Fresnel left out of the pdf", "Fresnel"}, {"lobe chosen by a half, weighed by Fresnel", "Fresnel"},
        {"channels of the weight swapped", "channels 1 and 3 exchanged"},
        {"luminance for every channel of the weight", "luminance in every channel"},
        {"Fresnel twice in the weight", "Fresnel"}, {"Fresnel left out of f", "Fresnel"},
        {"Fresnel at n for the half vector in the weight", "Fresnel at n over Fresnel at m"},
        {"height-correlated shadowing in f alone", "G2 over G1 G1"},
        {"chooser's Fresnel at w_i in the pdf", "the chooser's 1 - Fresnel at w_i over that at w_o"},
        {"passes through the coat left out of f", "both passes through a coat"},
        {"one pass through the coat left out of f", "the pass of w_i through a coat"},
        {"w_o.m for w_i.m in the Jacobian of refraction", "(w_i.m) / (w_o.m)"},
        {"n.m left out of the pdf of glass", "n.m"},
        {"n.m left out of the pdf of glass whose index is not told", "n.m"}, {"s+1 for s+2 in the BRDF", "a constant"},
        {"non-reciprocal f", "a constant"},  // at one w_o
    };
    const auto at = causes.find(fault);
    return at == causes.end() ? "" : at->second;
}

std::vector<PlantedFault> planted_faults(bool full) {
    std::vector<PlantedFault> out = arm_faults(full);
    for (PlantedFault& fault : out) fault.cause = cause_of(fault.name);
    for (PlantedFault& f : renderer_faults()) out.push_back(std::move(f));
    for (PlantedFault& f : boundary_faults()) out.push_back(std::move(f));
    for (PlantedFault& fault : out) fault.verdict = verdict_of(fault.name);
    return out;
}

}  // namespace crescent
