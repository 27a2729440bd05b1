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
constexpr std::string_view rest = "rest";

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
        if (mistake.message.empty() && at_ < text_.size()) fail("expected an operator or the end");
    }

private:
    void fail(const std::string& message) {
        if (mistake.message.empty()) mistake = {at_, message};
        at_ = text_.size();
    }
    void skip() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    }
    bool take(char c) {
        skip();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
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
        for (bool more = true; more && mistake.message.empty();) {
            if (take('+')) {
                product();
                add(Code::add, -1);
            } else if (take('-')) {
                product();
                add(Code::subtract, -1);
            } else more = false;
        }
        --depth_;
    }
    void product() {
        power();
        for (bool more = true; more && mistake.message.empty();) {
            if (take('*')) {
                power();
                add(Code::multiply, -1);
            } else if (take('/')) {
                power();
                add(Code::divide, -1);
            } else more = false;
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
        if (at_ >= text_.size()) return fail("expected a number, a name or '('");
        if (take('(')) {
            sum();
            if (mistake.message.empty() && !take(')')) fail("expected ')'");
            return;
        }
        if (is_digit(text_[at_]) || text_[at_] == '.') return number();
        if (is_letter(text_[at_])) return name();
        fail(fmt::format("expected a number, a name or '(', found '{}'", printable(text_.substr(at_, 1))));
    }
    void number() {
        double v = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), v);
        if (error != std::errc{}) return fail("expected a number");
        at_ = static_cast<std::size_t>(end - text_.data());
        add(Code::number, 1);
        if (!steps.empty()) steps.back().number = v;
    }
    void name() {
        const std::size_t first = at_;
        while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
        const std::string word(text_.substr(first, at_ - first));
        static constexpr std::array<std::pair<std::string_view, Code>, 5> of_point = {{{"s", Code::s},
            {"alpha", Code::alpha}, {"rho_d", Code::rho_d}, {"rho_s", Code::rho_s}, {"cos_o", Code::cos_o}}};
        static constexpr std::array<std::pair<std::string_view, Code>, 5> functions = {
            {{"min", Code::min}, {"max", Code::max}, {"sqrt", Code::sqrt}, {"exp", Code::exp}, {"log", Code::log}}};
        for (const auto& [known, code] : of_point)
            if (known == word) return add(code, 1);
        for (const auto& [known, code] : functions)
            if (known == word) return call(code);
        std::vector<std::string> valid;
        for (const auto& [known, code] : of_point) valid.emplace_back(known);
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
        for (const auto& [known, code] : functions) valid.emplace_back(known);
        at_ = first;
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
    std::size_t samplers_, at_ = 0, depth_ = 0;
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
        const auto put = [&](double v) { stack[top++] = v; };
        const auto two = [&](auto&& operation) {
            const double b = stack[--top], a = stack[--top];
            put(operation(a, b));
        };
        const auto one = [&](auto&& operation) { stack[top - 1] = operation(stack[top - 1]); };
        switch (step.code) {
            case Code::number: put(step.number); break;
            case Code::s: put(in.s); break;
            case Code::alpha: put(in.alpha); break;
            case Code::rho_d: put(in.rho_d); break;
            case Code::rho_s: put(in.rho_s); break;
            case Code::cos_o: put(in.cos_o); break;
            case Code::cos_i: put(in.cos_i); break;
            case Code::p: put(in.p[static_cast<std::size_t>(step.number)]); break;
            case Code::add: two([](double a, double b) { return a + b; }); break;
            case Code::subtract: two([](double a, double b) { return a - b; }); break;
            case Code::multiply: two([](double a, double b) { return a * b; }); break;
            case Code::divide: two([](double a, double b) { return a / b; }); break;
            case Code::power: two([](double a, double b) { return b == 2 ? a * a : math::pow(a, b); }); break;
            case Code::min: two([](double a, double b) { return a < b ? a : b; }); break;
            case Code::max: two([](double a, double b) { return a > b ? a : b; }); break;
            case Code::negate: one([](double a) { return -a; }); break;
            case Code::sqrt: one([](double a) { return std::sqrt(a); }); break;
            case Code::exp: one([](double a) { return math::exp(a); }); break;
            case Code::log: one([](double a) { return math::log(a); }); break;
        }
    }
    return stack[0];
}

WeightList::WeightList(
    const std::vector<std::string>& texts, std::size_t samplers, bool of_direction, SourceLocation place)
    : count_(samplers), at_(std::move(place)) {
    if (texts.empty()) return;
    const auto wrong = [&](const std::string& message) { throw InputError(at_, message); };
    if (texts.size() != samplers)
        wrong(fmt::format("expected {} weights, one for each of 'of', found {}", samplers, texts.size()));
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (texts[i] == rest) {
            if (i + 1 != texts.size()) wrong("expected 'rest' as the last weight only");
            rest_ = true;
            break;
        }
        FormulaMistake mistake;
        formulas_.push_back(WeightFormula::read(texts[i], samplers, of_direction, mistake));
        if (!mistake.message.empty())
            wrong(fmt::format("weight {}, '{}', at character {}: {}", i + 1, printable(texts[i], 80),
                mistake.offset + 1, mistake.message));
    }
}

void WeightList::evaluate(const FormulaInputs& in, std::span<double> out) const {
    if (formulas_.empty() && !rest_) {
        std::fill(out.begin(), out.end(), 1 / static_cast<double>(count_));
        return;
    }
    double sum = 0;
    for (std::size_t i = 0; i < formulas_.size(); ++i) sum += out[i] = formulas_[i](in);
    if (rest_) {
        out[count_ - 1] = 1 - sum;
        sum = 1;
    }
    const bool good = std::ranges::all_of(out, [](double w) { return w >= -sum_tolerance && w <= 1 + sum_tolerance; });
    if (good && std::fabs(sum - 1) <= sum_tolerance) {
        for (double& w : out) w = std::clamp(w, 0.0, 1.0);
        return;
    }
    throw InputError(at_,
        fmt::format(
            "expected weights from 0 to 1 whose sum is one, found {} with sum {} at s = {:.6g}, alpha = {:.6g}, "
            "rho_d = {:.6g}, rho_s = {:.6g}, cos_o = {:.6g}",
            fmt::join(out, ", "), sum, in.s, in.alpha, in.rho_d, in.rho_s, in.cos_o));
}

}  // namespace crescent
