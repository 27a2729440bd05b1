// What is measured: an engine that takes cases and says whether their sampler is right. One file an engine, and a word
// in the list in engines.cpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "check/sources/sampler_adapter.h"
#include "check/verdict.h"

namespace crescent::calibration {

struct Request {
    bool full = false;
    std::uint32_t seed = 1;
    std::uint64_t draws = 0, evaluations = 0;  // a w_o at most; 0: the mode's own budget
};

struct Result {
    State state = State::right;
    std::vector<std::string> wrong, open;  // names of the verdicts that are wrong, and inconclusive
    std::vector<std::string> causes;       // texts or identifiers of what explains them
    std::string message;                   // the first sentence of the first verdict that is not right
    /// What a right verdict says could be hidden: constant, leak, hole, rotation, mismatch; none where it says nothing.
    std::map<std::string, double> stated;
    std::map<std::string, double> p;  // by verdict or family of questions, the least over the w_o
    double cpu_seconds = 0;           // of this process, and of programs behind pipes
    std::uint64_t evaluations = 0;    // draws and values of pdf and f
    int wo = 0;
};

class Engine {
public:
    virtual ~Engine() = default;
    virtual std::string_view name() const = 0;
    /// Fills all but cpu_seconds, evaluations and wo, which are measured by measured().
    virtual Result run(std::span<const CheckCase> check_cases, const Request& request) const = 0;
};

/// The engines, in the order of the list.
const std::vector<std::unique_ptr<Engine>>& engines();
/// Throws InputError for an unknown name.
const Engine& engine_named(std::string_view name);

/// Runs it on what `cases` makes, with CPU time and evaluations counted; programs behind pipes end before that.
Result measured(
    const Engine& engine, const std::function<std::vector<CheckCase>()>& check_cases, const Request& request);

}  // namespace crescent::calibration
