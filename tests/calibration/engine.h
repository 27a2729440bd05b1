// The engines that are measured: each takes cases and decides whether their sampler is right. There is one file for
// each engine, and an entry in the list in engines.cpp.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "check/sources/check_case.h"
#include "check/verdict.h"

namespace crescent::calibration {

struct Request {
    bool full = false;
    std::uint32_t seed = 1;
    std::uint64_t draws = 0, evaluations = 0;  // largest number for each w_o; 0: the budget of the mode
};

struct Result {
    State state = State::right;
    std::vector<std::string> wrong, open;  // names of the wrong and of the inconclusive verdicts
    std::vector<std::string> causes;       // texts or identifiers of the causes
    std::string message;                   // first sentence of the first verdict that is not right
    /// The sizes that a right verdict states as possibly hidden: constant, leak, hole, rotation, mismatch.
    std::map<std::string, double> stated;
    std::map<std::string, double> p;  // least p over the w_o, by verdict or family of tests
    double cpu_seconds = 0;           // of this process and of programs behind pipes
    std::uint64_t evaluations = 0;    // draws and values of pdf and f
    int wo = 0;
};

class Engine {
public:
    virtual ~Engine() = default;
    virtual std::string_view name() const = 0;
    /// Fills all members except cpu_seconds, evaluations and wo, which measured() sets.
    virtual Result run(std::span<const CheckCase> check_cases, const Request& request) const = 0;
};

/// The engines, in the order of the list.
const std::vector<std::unique_ptr<Engine>>& engines();
/// Throws InputError for an unknown name.
const Engine& engine_named(std::string_view name);

/// Runs the engine on the result of `check_cases` and measures CPU time and evaluations; programs behind pipes end
/// before that.
Result measured(
    const Engine& engine, const std::function<std::vector<CheckCase>()>& check_cases, const Request& request);

}  // namespace crescent::calibration
