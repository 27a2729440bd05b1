// A number, or a formula of the surface point, of a direction and of the densities there, for the weights of a
// combination: "0.5", "min(rho_s / (rho_s + rho_d), 0.9)", "p1^3 / (p1^3 + p2^3)". The last weight may be "rest", one
// minus the sum of the others.
//
//   s, alpha       exponent and roughness of the lobe
//   rho_d, rho_s   luminance of the diffuse albedo, albedo of the lobe
//   cos_o, cos_i   cosines of w_o and of the direction
//   p1, p2, ...    densities of the samplers at the direction, 1/sr
//   + - * / ^ ( )  min(a, b), max(a, b), sqrt(a), exp(a), log(a)
//
// Values have the same bits on every machine.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace crescent {

/// The values that a formula may use.
struct FormulaInputs {
    double s = 0, alpha = 0, rho_d = 0, rho_s = 0, cos_o = 0, cos_i = 0;
    std::span<const double> p{};
};

/// What a formula may not say: its offset in the text and what is wrong there.
struct FormulaMistake {
    std::size_t offset = 0;
    std::string message;
};

class WeightFormula {
public:
    /// Reads a formula for `samplers` samplers. `of_direction`: it may use cos_i and p1, p2, ... Returns the mistake in
    /// `mistake`, whose message is empty if there is none.
    static WeightFormula read(std::string_view text, std::size_t samplers, bool of_direction, FormulaMistake& mistake);

    double operator()(const FormulaInputs& in) const;
    /// Whether it is a number.
    bool is_constant() const { return steps_.size() == 1 && steps_[0].code == Code::number; }

private:
    enum class Code {
        number,
        s,
        alpha,
        rho_d,
        rho_s,
        cos_o,
        cos_i,
        p,
        add,
        subtract,
        multiply,
        divide,
        power,
        negate,
        min,
        max,
        sqrt,
        exp,
        log
    };
    struct Step {
        Code code;
        double number = 0;  // of Code::p: the index
    };
    class Reader;
    std::vector<Step> steps_;  // in postfix order
};

/// The weights of the samplers of a combination; each value is at least 0, and their sum is one.
class WeightList {
public:
    WeightList() = default;
    /// Reads `texts`, one for each of `samplers`; throws InputError at `place`.
    WeightList(const std::vector<std::string>& texts, std::size_t samplers, bool of_direction, SourceLocation place);
    /// Equal weights.
    explicit WeightList(std::size_t samplers) : count_(samplers) {}

    std::size_t size() const { return count_; }
    /// Writes the weights. Throws InputError if one is negative or not a number, or if their sum is not one to 1e-9.
    void evaluate(const FormulaInputs& in, std::span<double> out) const;

private:
    std::size_t count_ = 0;
    std::vector<WeightFormula> formulas_{};  // empty: equal weights
    bool has_remainder_ = false;             // the last weight is one minus the sum of the others
    SourceLocation place_{};
};

}  // namespace crescent
