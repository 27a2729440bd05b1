// A recursive descent parser into postfix steps, evaluated on a stack of fixed size.
#include "samplers/weight_formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/text.h"
#include "math/functions.h"

namespace crescent {

namespace {

constexpr std::size_t deepest = 64;     // values on the stack, and nested brackets
constexpr double sum_tolerance = 1e-9;  // of weights written as decimals: 0.3333333333 three times
constexpr std::string_view remainder_word = "rest";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

class WeightFormula::Reader {
public:
    Reader(std::string_view text, std::size_t samplers, bool of_direction)
        : text_(text), samplers_(samplers), of_direction_(of_direction) {}

    std::vector<Step> steps;
    FormulaMistake mistake;

    void read() {
        sum();
        skip();
        if (mistake.message.empty() && position_ < text_.size()) fail("expected an operator or the end");
    }

private:
    void fail(const std::string& message) {
        if (mistake.message.empty()) mistake = {position_, message};
        position_ = text_.size();
    }
    void skip() {
        while (position_ < text_.size() && text_[position_] == ' ') ++position_;
    }
    bool take(char c) {
        skip();
        if (position_ >= text_.size() || text_[position_] != c) return false;
        ++position_;
        return true;
    }
    void add(Code code, int change) {
        height_ += change;
        if (height_ > static_cast<int>(deepest)) return fail("expected a formula with fewer nested terms");
        steps.push_back({code});
    }

    void sum() {
        if (++depth_ > deepest) return fail("expected fewer nested brackets");
        product();
        for (bool continues = true; continues && mistake.message.empty();) {
            if (take('+')) {
                product();
                add(Code::add, -1);
            } else if (take('-')) {
                product();
                add(Code::subtract, -1);
            } else continues = false;
        }
        --depth_;
    }
    void product() {
        power();
        for (bool continues = true; continues && mistake.message.empty();) {
            if (take('*')) {
                power();
                add(Code::multiply, -1);
            } else if (take('/')) {
                power();
                add(Code::divide, -1);
            } else continues = false;
        }
    }
    void power() {
        if (take('-')) {
            if (++depth_ > deepest) return fail("expected fewer signs");
            power();
            --depth_;
            return add(Code::negate, 0);
        }
        value();
        if (mistake.message.empty() && take('^')) {
            if (++depth_ > deepest) return fail("expected fewer exponents");
            power();
            --depth_;
            add(Code::power, -1);
        }
    }
    void value() {
        skip();
        if (position_ >= text_.size()) return fail("expected a number, a name or '('");
        if (take('(')) {
            sum();
            if (mistake.message.empty() && !take(')')) fail("expected ')'");
            return;
        }
        if (is_digit(text_[position_]) || text_[position_] == '.') return number();
        if (is_letter(text_[position_])) return name();
        fail(fmt::format("expected a number, a name or '(', found '{}'", printable(text_.substr(position_, 1))));
    }
    void number() {
        double v = 0;
        const auto [end, error] = std::from_chars(text_.data() + position_, text_.data() + text_.size(), v);
        if (error != std::errc{}) return fail("expected a number");
        position_ = static_cast<std::size_t>(end - text_.data());
        add(Code::number, 1);
        if (!steps.empty()) steps.back().number = v;
    }
    void name() {
        const std::size_t first = position_;
        while (position_ < text_.size() && (is_letter(text_[position_]) || is_digit(text_[position_]))) ++position_;
        const std::string word(text_.substr(first, position_ - first));
        static constexpr std::array<std::pair<std::string_view, Code>, 5> of_point = {{{"s", Code::s},
            {"alpha", Code::alpha}, {"rho_d", Code::rho_d}, {"rho_s", Code::rho_s}, {"cos_o", Code::cos_o}}};
        static constexpr std::array<std::pair<std::string_view, Code>, 5> functions = {
            {{"min", Code::min}, {"max", Code::max}, {"sqrt", Code::sqrt}, {"exp", Code::exp}, {"log", Code::log}}};
        for (const auto& [entry, code] : of_point)
            if (entry == word) return add(code, 1);
        for (const auto& [entry, code] : functions)
            if (entry == word) return call(code);
        std::vector<std::string> valid;
        for (const auto& [entry, code] : of_point) valid.emplace_back(entry);
        if (of_direction_) {
            if (word == "cos_i") return add(Code::cos_i, 1);
            valid.emplace_back("cos_i");
            for (std::size_t k = 1; k <= samplers_; ++k) {
                if (word == fmt::format("p{}", k)) {
                    add(Code::p, 1);
                    if (!steps.empty()) steps.back().number = static_cast<double>(k - 1);
                    return;
                }
                valid.push_back(fmt::format("p{}", k));
            }
        }
        for (const auto& [entry, code] : functions) valid.emplace_back(entry);
        position_ = first;
        fail(fmt::format("unknown name '{}': expected one of {}{}", word.substr(0, 64), fmt::join(valid, ", "),
            did_you_mean(word, valid)));
    }
    void call(Code code) {
        if (!take('(')) return fail("expected '(' after the function");
        sum();
        const bool two = code == Code::min || code == Code::max;
        if (two) {
            if (mistake.message.empty() && !take(',')) return fail("expected ',' and a second value");
            sum();
        }
        if (mistake.message.empty() && !take(')')) return fail("expected ')'");
        add(code, two ? -1 : 0);
    }

    std::string_view text_;
    std::size_t samplers_, position_ = 0, depth_ = 0;
    bool of_direction_;
    int height_ = 0;
};

WeightFormula WeightFormula::read(
    std::string_view text, std::size_t samplers, bool of_direction, FormulaMistake& mistake) {
    Reader reader(text, samplers, of_direction);
    reader.read();
    mistake = reader.mistake;
    WeightFormula out;
    out.steps_ = std::move(reader.steps);
    return out;
}

double WeightFormula::operator()(const FormulaInputs& in) const {
    std::array<double, deepest + 1> stack{};
    std::size_t top = 0;  // entries
    for (const Step& step : steps_) {
        const auto push = [&](double v) { stack[top++] = v; };
        const auto apply_binary = [&](auto&& operation) {
            const double b = stack[--top], a = stack[--top];
            push(operation(a, b));
        };
        const auto apply_unary = [&](auto&& operation) { stack[top - 1] = operation(stack[top - 1]); };
        switch (step.code) {
            case Code::number: push(step.number); break;
            case Code::s: push(in.s); break;
            case Code::alpha: push(in.alpha); break;
            case Code::rho_d: push(in.rho_d); break;
            case Code::rho_s: push(in.rho_s); break;
            case Code::cos_o: push(in.cos_o); break;
            case Code::cos_i: push(in.cos_i); break;
            case Code::p: push(in.p[static_cast<std::size_t>(step.number)]); break;
            case Code::add: apply_binary([](double a, double b) { return a + b; }); break;
            case Code::subtract: apply_binary([](double a, double b) { return a - b; }); break;
            case Code::multiply: apply_binary([](double a, double b) { return a * b; }); break;
            case Code::divide: apply_binary([](double a, double b) { return a / b; }); break;
            case Code::power: apply_binary([](double a, double b) { return b == 2 ? a * a : math::pow(a, b); }); break;
            case Code::min: apply_binary([](double a, double b) { return a < b ? a : b; }); break;
            case Code::max: apply_binary([](double a, double b) { return a > b ? a : b; }); break;
            case Code::negate: apply_unary([](double a) { return -a; }); break;
            case Code::sqrt: apply_unary([](double a) { return std::sqrt(a); }); break;
            case Code::exp: apply_unary([](double a) { return math::exp(a); }); break;
            case Code::log: apply_unary([](double a) { return math::log(a); }); break;
        }
    }
    return stack[0];
}

WeightList::WeightList(
    const std::vector<std::string>& texts, std::size_t samplers, bool of_direction, SourceLocation place)
    : count_(samplers), place_(std::move(place)) {
    if (texts.empty()) return;
    const auto fail = [&](const std::string& message) { throw InputError(place_, message); };
    if (texts.size() != samplers)
        fail(fmt::format("expected {} weights, one for each of 'of', found {}", samplers, texts.size()));
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (texts[i] == remainder_word) {
            if (i + 1 != texts.size()) fail("expected 'rest' as the last weight only");
            has_remainder_ = true;
            break;
        }
        FormulaMistake mistake;
        formulas_.push_back(WeightFormula::read(texts[i], samplers, of_direction, mistake));
        if (!mistake.message.empty())
            fail(fmt::format("weight {}, '{}', at character {}: {}", i + 1, printable(texts[i], 80), mistake.offset + 1,
                mistake.message));
    }
}

void WeightList::evaluate(const FormulaInputs& in, std::span<double> out) const {
    if (formulas_.empty() && !has_remainder_) {
        std::fill(out.begin(), out.end(), 1 / static_cast<double>(count_));
        return;
    }
    double sum = 0;
    for (std::size_t i = 0; i < formulas_.size(); ++i) sum += out[i] = formulas_[i](in);
    if (has_remainder_) {
        out[count_ - 1] = 1 - sum;
        sum = 1;
    }
    const bool is_good =
        std::ranges::all_of(out, [](double w) { return w >= -sum_tolerance && w <= 1 + sum_tolerance; });
    if (is_good && std::fabs(sum - 1) <= sum_tolerance) {
        for (double& w : out) w = std::clamp(w, 0.0, 1.0);
        return;
    }
    throw InputError(place_,
        fmt::format(
            "expected weights from 0 to 1 whose sum is one, found {} with sum {} at s = {:.6g}, alpha = {:.6g}, "
            "rho_d = {:.6g}, rho_s = {:.6g}, cos_o = {:.6g}",
            fmt::join(out, ", "), sum, in.s, in.alpha, in.rho_d, in.rho_s, in.cos_o));
}

}  // namespace crescent
