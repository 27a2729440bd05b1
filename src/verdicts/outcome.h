// What the judgement of one trial came to, and what became of a trial that could not be asked to its end.
#pragma once

#include <optional>

#include "base/progress_monitor.h"
#include "subjects/faults.h"
#include "trials/contrasts.h"
#include "verdicts/efficiency.h"
#include "verdicts/judge.h"
#include "verdicts/pooled.h"

namespace crescent::inline verdicts {

/// Why a trial ended before its last verdict.
struct Cut {
    State state = State::error;  // of the verdicts that are missing
    std::string first, rest;     // what the first of them says, and what the others say
    nlohmann::ordered_json evidence = nlohmann::ordered_json::object();  // with the first
};

struct Outcome {
    std::vector<Verdict> verdicts;
    std::vector<BinMap> maps;
    std::vector<WeightPicture> pictures;
    std::optional<Efficiency> efficiency;
    std::optional<Cut> cut;
    std::optional<Contrasted> contrasted;
};

/// All verdicts of one trial but those that hold it against other trials.
Outcome judge_one(const Trial& trial, std::size_t index, const TestSettings& settings, TestCounts& test_counts,
    ProgressMonitor& monitor);
/// What each of `count` w_o may be asked where all are asked at once, by many threads.
std::size_t even_share(const TestSettings& settings, std::size_t count);
/// Trials of a program, one after the other: first `valid` at every w_o from a few draws, then all verdicts, the middle
/// of the hemisphere and the most grazing w_o first, as far as the program's time goes.
std::vector<Outcome> judge_in_turn(
    std::span<const Trial> trials, const TestSettings& settings, TestCounts& test_counts, ProgressMonitor& monitor);
/// What a sampler that can no more be asked leaves: an error, or too little time.
Cut cut_by(const SubjectFault& fault);

}  // namespace crescent::inline verdicts
