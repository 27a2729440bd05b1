// What each of a few lobes of a sampler draws at a direction, by the warp alone: one number chooses among them, from
// 0 to q_1, from q_1 to q_1 + q_2 and so on, whatever the other numbers are.
#pragma once

#include <optional>
#include <vector>

#include "warps/jacobian.h"

namespace crescent::inline diagnosis {

struct LobeDraws {
    /// What leads to one lobe, of the number that chooses.
    struct Lobe {
        double from = 0, to = 1;
        double nothing = 0;  // share of its draws that draw nothing
        double share() const { return to - from; }
    };
    /// A direction that lobe `own` drew, what pdf(w) says of it, and what each lobe draws there, 1/sr.
    struct At {
        WarpPoint point;
        std::size_t own = 0;
        double pdf = 0, error = 0;  // error: of what is drawn, relative
        std::vector<double> drawn;
        double together() const {
            double sum = 0;
            for (double d : drawn) sum += d;
            return sum;
        }
    };
    int chooser = 0;
    std::vector<Lobe> lobes;
    std::vector<At> at;
};

/// The lobes that one number chooses among, two to six; none where no number does, or their ends move with the others.
std::optional<LobeDraws> lobes_of(const TrialContext& work, int technique);
/// The lobe that these numbers choose, by its place.
std::size_t lobe_at(const LobeDraws& of, const Numbers& u);
/// The same with what is drawn at directions of each; directions where that is not known are left out. None where few
/// are left, or questions are short.
std::optional<LobeDraws> lobe_draws_of(const TrialContext& work, int technique);

}  // namespace crescent::inline diagnosis
