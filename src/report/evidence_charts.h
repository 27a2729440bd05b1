// Charts and sentences for the tests of three explanations of the article; the numbers come from
// metrics/article_checks.h.
#pragma once

#include <string>

#include "report/page.h"

namespace crescent::inline report {

/// Draws quantiles of the combined Phong furnace against N: one panel per arithmetic and resolution of u, with its
/// name.
Json furnace_charts(const Page& page);
/// Medians by N, one cell per panel.
Json furnace_medians(const Evidence& evidence);
/// Returns whether double precision is too low in the same way as single precision, near the N of the furnace that was
/// run; "" with one panel.
std::string furnace_html(const Page& page);

/// Draws the diffuse part that the Phong sampler cannot reach, against the tilt: <svg>.
std::string lost_chart(const Evidence& evidence);
std::string lost_html(const Evidence& evidence);

/// Draws how often a t-test rejects a correct estimate, against N: <svg>.
std::string rejection_chart(const Evidence& evidence);
Json rejection_rows(const Evidence& evidence);
std::string rejection_html(const Evidence& evidence);

}  // namespace crescent::inline report
