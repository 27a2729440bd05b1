// Charts and sentences for the tests of three explanations of the article; the numbers come from
// metrics/article_checks.h.
#pragma once

#include <string>

#include "report/page.h"

namespace crescent::inline report {

/// Draws quantiles of the combined Phong furnace against N, one panel per arithmetic and resolution of u.
std::string furnace_charts(const Page& page);
/// Medians by N, one column per panel.
std::string furnace_table(const Evidence& evidence);
/// Returns whether double precision is too low in the same way as single precision, near the N of the furnace that was
/// run.
std::string furnace_sentence(const Page& page);

/// Draws the diffuse part that the Phong sampler cannot reach, against the tilt: <svg>.
std::string lost_chart(const Evidence& evidence);
std::string lost_sentence(const Evidence& evidence);

/// Draws how often a t-test rejects a correct estimate, against N: <svg>.
std::string rejection_chart(const Evidence& evidence);
std::string rejection_table(const Evidence& evidence);
std::string rejection_sentence(const Evidence& evidence);

}  // namespace crescent::inline report
