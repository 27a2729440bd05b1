// Candidate causes over domains other than directions.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "check/explain/constants.h"
#include "check/explain/factors.h"
#include "check/explain/hypothesis.h"
#include "samplers/domains/domain_chart.h"

namespace crescent::check {

/// Functions of the point, such as the radius in a disk.
std::vector<Factor> domain_factors(const std::shared_ptr<const DomainChart>& chart);
/// Coordinates exchanged or mirrored, entries off by one.
std::vector<Hypothesis> domain_frames(std::span<const Place> places);
/// Draws are those of p with the coordinate of an infinite line multiplied by a number.
struct FittedMove {
    Hypothesis hypothesis;
    std::string factor, coordinate;
    double value = 0, error = 0, neutral_value = 0;
    bool is_clear() const { return std::fabs(value - neutral_value) > clear_move * error; }
};
std::vector<FittedMove> domain_moves(std::span<const Place> places);
/// Draws are those of p with other shares of the entries of a set, in a product with other parts.
struct EntryShares {
    struct Share {
        double drawn_share = 0, claimed_share = 0, error = 0;  // of the draws and of p, and of `drawn_share`
    };
    Hypothesis hypothesis;
    std::vector<Share> shares;  // by entry
};
std::optional<EntryShares> entry_shares(std::span<const Place> places);

}  // namespace crescent::check
