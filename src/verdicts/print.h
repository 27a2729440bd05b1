// Verdicts for the reader: a table for the terminal, JSON, JUnit for build servers, one HTML file with its pictures.
#pragma once

#include <string>

#include "verdicts/verdict.h"

namespace crescent {

/// An arm a line, then every verdict that is not right; `all`: every verdict.
std::string verdict_table(const Judgement& judgement, bool all = false);
/// {"state", "as_expected", "alpha", "tests", "verdicts": [{"arm", "case", "name", "state", "say", "expected", "evidence"}]}
std::string verdict_json(const Judgement& judgement);
std::string verdict_junit(const Judgement& judgement);
/// Maps of observed, expected and standardised difference, weight histograms with their tail, and roses of p over f L cos.
std::string verdict_html(const Judgement& judgement);
/// Throws OutputError where write_whole would.
void can_write(const std::string& path);
/// Writes beside the place and renames; throws OutputError.
void write_whole(const std::string& path, const std::string& text);

}  // namespace crescent
