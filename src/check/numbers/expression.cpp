// Recursive descent: sums of products of powers.
#include "check/numbers/expression.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "math/functions.h"

namespace crescent {

namespace {

struct NamedFunction {
    std::string_view name;
    double (*value)(double);
};
constexpr std::array<NamedFunction, 7> named_functions = {{{"exp", [](double x) { return math::exp(x); }},
    {"log", [](double x) { return math::log(x); }}, {"sqrt", [](double x) { return std::sqrt(x); }},
    {"sin", [](double x) { return math::sin(x); }}, {"cos", [](double x) { return math::cos(x); }},
    {"tan", [](double x) { return math::tan(x); }}, {"abs", [](double x) { return std::fabs(x); }}}};

class ExpressionReader {
public:
    explicit ExpressionReader(std::string_view text) : text_(text) {}
    double read() {
        const double value = sum();
        if (!at_end()) fail("an operator or the end");
        return value;
    }

private:
    static constexpr int deepest = 64;
    std::string_view text_;
    std::size_t position_ = 0;
    int depth_ = 0;

    [[noreturn]] void fail(const char* expected) const {
        throw std::invalid_argument(fmt::format("column {}: expected {}", position_ + 1, expected));
    }
    bool at_end() {
        while (position_ < text_.size() && text_[position_] == ' ') ++position_;
        return position_ == text_.size();
    }
    bool take(char c) {
        const bool matches = !at_end() && text_[position_] == c;
        position_ += matches;
        return matches;
    }
    double sum() {
        double value = product();
        for (;;) {
            if (take('+')) value += product();
            else if (take('-')) value -= product();
            else return value;
        }
    }
    double product() {
        double value = signed_power();
        for (;;) {
            if (take('*')) value *= signed_power();
            else if (take('/')) value /= signed_power();
            else return value;
        }
    }
    double signed_power() {
        if (++depth_ > deepest) fail("fewer parentheses and signs");
        const bool is_negative = take('-');
        if (!is_negative) take('+');
        const double base = is_negative ? signed_power() : atom();
        const double value = is_negative ? -base : take('^') ? math::pow(base, signed_power()) : base;
        --depth_;
        return value;
    }
    double atom() {
        if (take('(')) {
            const double value = sum();
            if (!take(')')) fail("')'");
            return value;
        }
        if (at_end()) fail("a number");
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + position_, text_.data() + text_.size(), value);
        if (error == std::errc{}) {
            position_ = static_cast<std::size_t>(end - text_.data());
            return value;
        }
        return named();
    }
    double named() {
        constexpr double pi = 3.14159265358979323846, e = 2.71828182845904523536;
        std::size_t end = position_;
        while (end < text_.size() && text_[end] >= 'a' && text_[end] <= 'z') ++end;
        const std::string_view name = text_.substr(position_, end - position_);
        if (name == "pi") return position_ = end, pi;
        if (name == "e") return position_ = end, e;
        for (const NamedFunction& f : named_functions) {
            if (name != f.name) continue;
            position_ = end;
            if (!take('(')) fail("'('");
            const double x = sum();
            if (!take(')')) fail("')'");
            return f.value(x);
        }
        fail("a number, pi, e, or exp, log, sqrt, sin, cos, tan or abs of one");
    }
};

}  // namespace

double constant_value(std::string_view text) {
    const double value = ExpressionReader(text).read();
    if (!std::isfinite(value)) throw std::invalid_argument("expected a finite value");
    return value;
}

}  // namespace crescent
