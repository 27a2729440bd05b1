// Charts and sentences of the evidence against three explanations of the article; the numbers come from
// studies/evidence.h.
#pragma once

#include <string>

#include "report/page.h"

namespace crescent::inline report {

/// Quantiles of the combined Phong furnace against N, one panel per arithmetic and resolution of u.
std::string furnace_charts(const Page& page);
/// Medians by N, one column per panel.
std::string furnace_table(const Evidence& evidence);
/// Whether double precision falls short as single precision does, near the N of the furnace that was run.
std::string furnace_sentence(const Page& page);

/// The diffuse part that the Phong arm cannot reach, against the tilt: <svg>.
std::string lost_chart(const Evidence& evidence);
std::string lost_sentence(const Evidence& evidence);

/// How often a t-test rejects a right estimate, against N: <svg>.
std::string rejection_chart(const Evidence& evidence);
std::string rejection_table(const Evidence& evidence);
std::string rejection_sentence(const Evidence& evidence);

}  // namespace crescent::inline report
