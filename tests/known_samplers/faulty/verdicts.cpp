// The verdict expected for each planted fault: the first failure that a reader of the report sees. Faults that are
// found in several ways have none.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tests/known_samplers/faulty/planted.h"

namespace crescent {

std::string verdict_of(const std::string& fault) {
    static const std::map<std::string, std::vector<std::string>> faults = {
        {"valid", {"NaN at u = 0", "directions a little too long", "NaN where the chooser is 0"}},
        {"support", {"one technique for two kinds of light"}},
        {"normalised",
            {"s+2 for s+1 in the pdf", "pdf renormalised over the horizon", "cosine folded in twice",
                "cosine left out of the pdf", "missing 4(w.h)", "n.h for w.h in the Jacobian",
                "bound forgotten in the density", "missing G1 in the density of visible normals",
                "area measure for solid angle", "light's cosine left out", "pdf off by 1 %",
                "pdf off by 0.2 % on a tenth of the sphere", "second light forgotten in the pdf",
                "light behind another forgotten in the pdf", "second cap forgotten where two overlap",
                "transmission pdf without its Jacobian", "eta^2 left out of the transmission Jacobian",
                "reflection Jacobian for transmission", "Fresnel left out of the pdf",
                "n.m left out of the pdf of glass", "n.m left out of the pdf of glass whose index is not told",
                "delta mass counted in the pdf", "delta mass taken off the pdf twice"}},
        {"density",
            {"exponent s+1 for s in the pdf", "1/(s+2) for 1/(s+1) in the warp", "horizon samples dropped from N",
                "alpha for alpha^2 in the draw", "axis about n but pdf about R",
                "lights chosen by power, weighed alike", "phi over half a turn", "u's correlated", "one u used twice",
                "sqrt forgotten", "sqrt forgotten on the disk", "never reaches grazing",
                "pole artefact in the basis at n = -z", "frame mirrored for half of the azimuths",
                "lobe chosen by a half, weighed by Fresnel", "lobe chosen by the root of Fresnel",
                "chooser reused without stretching", "chooser correlated with the azimuth",
                "eta not inverted for w_o below", "lobe chosen by one weight, weighed by another",
                "environment pdf without sin theta", "4 pi for 2 pi^2 sin theta", "pdf of the next texel",
                "alias forgotten", "alias table's number reused without stretching",
                "chooser's Fresnel at w_i in the pdf", "w_o.m for w_i.m in the Jacobian of refraction"}},
        {"identity",
            {"16-bit u", "swapped w_o and w_i in pdf(w)", "clamped weights", "cosine left out of the weight",
                "channels of the weight swapped", "one channel's tail cut off",
                "luminance for every channel of the weight", "draws numbers of its own and does not say so",
                "Fresnel twice in the weight", "Fresnel at n for the half vector in the weight"}},
        {"mean",
            {"wrong MIS partner pdf", "one technique left unweighted", "BRDF scaled by 1.01",
                "s+1 for s+2 in the BRDF"}},
        {"physics",
            {"eta^2 left out of f", "eta^2 for 1/eta^2 in f", "cosine of w_i left in f across the surface",
                "delta weight divided by q twice", "one channel creates energy", "one channel not reciprocal"}},
    };
    for (const auto& [verdict, names] : faults)
        if (std::ranges::find(names, fault) != names.end()) return verdict;
    return "";
}

}  // namespace crescent
