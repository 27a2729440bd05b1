// Draws of points of a domain from a file, with their density from a second one.
#pragma once

#include <memory>
#include <string>

#include "check/sources/check_case.h"

namespace crescent {

/// samples: columns [u1,u2,]x1,...,xd,pdf[,f], with the coordinates of docs/domains.md. table: the density at a full
/// grid of the coordinates, columns x1,...,xd,pdf, with cos_theta,phi in the place of a direction's three coordinates.
/// Throws InputError with file, line and column of every mistake, at most ten.
std::shared_ptr<const SamplerAdapter> read_point_file(
    const Domain& domain, const std::string& samples, const std::string& table);

}  // namespace crescent
