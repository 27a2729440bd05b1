// The corners of the cube of random numbers and a few lines through every two of its sides, where samplers divide by 0.
#include "verdicts/corners.h"

#include <algorithm>

#include "math/functions.h"
#include "trials/trial_context.h"
#include "verdicts/valid.h"

namespace crescent::inline verdicts {

namespace {

constexpr double ends[] = {0, 0x1p-24, 0.25, 0.5, 0.75, 1 - 0x1p-24};
constexpr double elsewhere = 95.0 / 256;

/// Of two numbers: all of the square. Of more: such a square for every two of them, the others in the middle, and every
/// corner.
std::vector<Numbers> corners(int count) {
    std::vector<Numbers> out;
    const int n = std::max(count, 2);
    Numbers middle;
    for (int k = 0; k < n; ++k) middle[k] = elsewhere;
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n; ++j)
            for (double x : ends)
                for (double y : ends) {
                    out.push_back(middle);
                    out.back()[i] = x, out.back()[j] = y;
                }
    for (int bits = 0; n > 2 && bits < 1 << n; ++bits) {
        out.push_back(middle);
        for (int k = 0; k < n; ++k) out.back()[k] = bits >> k & 1 ? 1 - 0x1p-24 : 0;
    }
    return out;
}

}  // namespace

CornerFaults corner_faults(const TrialContext& work, int technique) {
    CornerFaults out;
    if (!work.subject.draws_at_will()) return out;
    SampleBatch all;
    all.u = corners(work.traits.numbers);
    all.draws.resize(all.u.size());
    work.subject.sample(technique, work.trial.wo, all.u, all.draws);
    all.pdf = work.pdf_of_drawn(technique, all.draws);
    const int n = std::max(work.traits.numbers, 2);
    std::array<std::array<std::pair<std::size_t, std::size_t>, std::size(ends)>, Numbers::most>
        lines{};  // tried, broken
    for (std::size_t i = 0; i < all.u.size(); ++i) {
        SampleBatch one;
        one.u = {all.u[i]};
        one.draws = {all.draws[i]};
        one.pdf = {all.pdf[i]};
        const std::string fault = first_fault(work, technique, one);
        if (!fault.empty() && out.count++ == 0) out.first = fault;
        for (int k = 0; k < n; ++k)
            for (std::size_t e = 0; e < std::size(ends); ++e)
                if (all.u[i][k] == ends[e]) {
                    auto& [tried, broken] = lines[static_cast<std::size_t>(k)][e];
                    ++tried;
                    broken += !fault.empty();
                }
    }
    out.tried = all.u.size();
    for (const auto& number : lines)  // a whole side of the cube, or where two numbers meet
        for (const auto& [tried, broken] : number) out.chance += tried > 0 && broken == tried ? 0x1p-24 : 0;
    if (out.chance == 0) out.chance = static_cast<double>(out.count) * 0x1p-48;
    return out;
}

}  // namespace crescent::inline verdicts
