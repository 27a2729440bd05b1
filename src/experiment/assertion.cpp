// Formats and evaluates assertions: five ways to compare two doubles.
#include "experiment/assertion.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "experiment/parser.h"
#include "experiment/value.h"
#include "render/film_metrics.h"

namespace crescent {

std::string to_string(const ParsedQuantity& q) {
    if (q.number) return fmt::format("{}", *q.number);
    std::string text = q.word;
    if (!q.region.empty()) text += "." + q.region;
    if (q.adapter.empty()) return text;
    text += "(" + q.adapter;
    if (q.n > 0) text += fmt::format(", n={}", q.n);
    if (q.s > 0) text += fmt::format(", s={}", q.s);
    return text + ")";
}

std::string to_string(const Comparison& c) {
    return fmt::format("{} {} {}", to_string(c.left), c.op, to_string(c.right));
}

bool holds(double value, std::string_view op, double right) {
    if (std::isnan(value) || std::isnan(right)) return false;
    if (op == "<") return value < right;
    if (op == "<=") return value <= right;
    if (op == ">") return value > right;
    if (op == ">=") return value >= right;
    return op == "==" && value == right;
}

// ---- Parses text to a ParsedQuantity, by recursive descent over one line.

namespace {

std::vector<std::string> all_words(const std::vector<QuantityWord>& quantities) {
    std::vector<std::string> words;
    for (const QuantityWord& w : quantities) words.emplace_back(w.word);
    return words;
}

class Parser {
public:
    Parser(std::string_view text, std::string& message, const std::vector<QuantityWord>& words)
        : remainder_(text), message_(message), words_(words) {}

    std::optional<Comparison> comparison() {
        Comparison c;
        if (!side(c.left)) return {};
        blanks();
        for (const std::string_view op : {"<=", ">=", "==", "<", ">"})
            if (c.op.empty() && remainder_.starts_with(op)) c.op = op;
        if (c.op.empty()) return fail("<, <=, >, >= or =="), std::nullopt;
        remainder_.remove_prefix(c.op.size());
        if (!side(c.right) || !end()) return {};
        return c;
    }

    std::optional<ParsedQuantity> quantity() {
        ParsedQuantity q;
        if (!side(q) || !end()) return {};
        return q;
    }

private:
    static bool is_word(char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-';
    }
    void blanks() {
        while (!remainder_.empty() && remainder_.front() == ' ') remainder_.remove_prefix(1);
    }
    bool take(char c) {
        blanks();
        if (remainder_.empty() || remainder_.front() != c) return false;
        remainder_.remove_prefix(1);
        return true;
    }
    bool fail(std::string_view expected) {
        blanks();
        message_ = remainder_.empty() ? fmt::format("expected {} at the end", expected)
                                      : fmt::format("expected {}, found '{}'", expected, remainder_.substr(0, 40));
        return false;
    }
    bool end() {
        blanks();
        return remainder_.empty() || fail("nothing more");
    }
    std::string word() {
        blanks();
        const auto length = static_cast<std::size_t>(
            std::find_if_not(remainder_.begin(), remainder_.end(), is_word) - remainder_.begin());
        const std::string word(remainder_.substr(0, length));
        remainder_.remove_prefix(length);
        return word;
    }
    bool number(double& to) {
        blanks();
        std::string_view text = remainder_.starts_with('+') ? remainder_.substr(1) : remainder_;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), to);
        if (error != std::errc{} || !std::isfinite(to)) return fail("a finite number");
        remainder_ = std::string_view(stop, static_cast<std::size_t>(text.data() + text.size() - stop));
        return true;
    }

    bool side(ParsedQuantity& q) {
        blanks();
        if (remainder_.empty()) return fail("a quantity or a number");
        if (std::string_view("0123456789+-.").find(remainder_.front()) != std::string_view::npos)
            return number(q.number.emplace());
        const std::string name = word();
        const std::size_t dot = name.find('.');
        q.word = name.substr(0, dot);
        if (dot != std::string::npos) q.region = name.substr(dot + 1);
        const auto quantity =
            std::find_if(words_.begin(), words_.end(), [&](const QuantityWord& w) { return w.word == q.word; });
        if (quantity == words_.end()) {
            const std::vector<std::string> valid = all_words(words_);
            message_ = fmt::format("no quantity '{}': expected one of {}{}", q.word.substr(0, 64), listed(valid, ", "),
                hint(q.word, valid));
            return false;
        }
        if (quantity->of_region != !q.region.empty()) {
            const bool covers_image = quantity->of_region && quantity->adapter == QuantityOf::compared;
            message_ = fmt::format("expected {}{}, found '{}'", form_of(*quantity),
                covers_image ? ", where REGION is a region, a mask or 'frame', the whole image" : "",
                name.substr(0, 64));
            return false;
        }
        return quantity->adapter == QuantityOf::none || brackets(q, *quantity);
    }

    bool brackets(ParsedQuantity& q, const QuantityWord& quantity) {
        if (!take('(')) return fail(fmt::format("'(' as in {}", form_of(quantity)));
        q.adapter = word();
        if (q.adapter.empty()) return fail(fmt::format("a name as in {}", form_of(quantity)));
        while (quantity.adapter == QuantityOf::run && take(','))
            if (!argument(q)) return false;
        return take(')') ||
            fail(quantity.adapter == QuantityOf::compared ? "')', for films have neither n nor s" : "')'");
    }

    bool argument(ParsedQuantity& q) {
        const std::string name = word();
        if ((name != "n" && name != "s") || !take('=')) return fail("n= or s=");
        double value = 0;
        if (!number(value)) return false;
        if (!(value > 0) || (name == "n" && (value > 16777216 || value != std::floor(value)))) {
            message_ = fmt::format("expected {}, found {}", name == "n" ? "n from 1 to 16777216" : "s above 0", value);
            return false;
        }
        if (name == "n" ? q.n > 0 : q.s > 0) {
            message_ = fmt::format("expected one {}=, found two", name);
            return false;
        }
        if (name == "n") q.n = static_cast<std::uint64_t>(value);
        else q.s = value;
        return true;
    }

    std::string_view remainder_;
    std::string& message_;
    const std::vector<QuantityWord>& words_;
};

template <class T> std::string missing(const std::vector<T>& candidates, const char* what, const std::string& name) {
    std::vector<std::string> names;
    for (const T& candidate : candidates) names.push_back(candidate.name);
    if (std::count(names.begin(), names.end(), name)) return "";
    return fmt::format("no {} '{}': expected one of {}{}", what, name.substr(0, 64),
        names.empty() ? "(none)" : listed(names, ", "), hint(name, names));
}

/// Returns null if there is no such word.
const QuantityWord* word_of(const ParsedQuantity& q) {
    const auto& words = quantity_words();
    const auto match = std::ranges::find(words, q.word, &QuantityWord::word);
    return match == words.end() ? nullptr : &*match;
}

std::string resolve_run(ParsedQuantity& q, const Experiment& e) {
    if (std::string message = missing(e.arms, "arm", q.adapter); !message.empty()) return message;
    const ArmPlan& arm = *e.find_arm(q.adapter);
    if (arm.n.empty()) return "";
    if (q.n == 0) q.n = word_of(q)->of_single_samples ? arm.n.back() : e.n_of(arm);
    if (!std::count(arm.n.begin(), arm.n.end(), q.n))
        return fmt::format(
            "the arm '{}' has no sample count n = {}: expected one of {}", arm.name, q.n, listed(arm.n, ", "));
    return why_not_run(e, q.adapter, q.n, q.s);
}

}  // namespace

const std::vector<QuantityWord>& quantity_words() {
#define CRESCENT_OF_REGION(name, Type) {#name, true, QuantityOf::run, Type::info.means, Type::info.of_single_samples},
#define CRESCENT_OF_FRAME(name, Type) {#name, false, QuantityOf::run, Type::info.means, Type::info.of_single_samples},
    static const std::vector<QuantityWord> words = {
        CRESCENT_REGION_METRICS(CRESCENT_OF_REGION){.word = "tail",
            .of_region = true,
            .adapter = QuantityOf::run,
            .means = "Pareto index k of a region's samples, at the experiment's seed"},
        {"flip", true, QuantityOf::run, "mean HDR-FLIP of a region, at the experiment's seed"},
        CRESCENT_FRAME_METRICS(CRESCENT_OF_FRAME){.word = "furnace",
            .of_region = false,
            .adapter = QuantityOf::furnace,
            .means = "Y that a white furnace reads"},
        {"furnace_error", false, QuantityOf::furnace, "how far it is from what is expected, without sign"},
        {"shape_pixels", false, QuantityOf::shape, "pixels in which the camera sees a shape"},
        {"region_pixels", false, QuantityOf::region, "pixels of a region"},
        {"geometry_pixels", false, QuantityOf::none, "pixels in which the camera sees any shape"},
        {"plate_bytes", false, QuantityOf::plate, "size of a plate's PNG file"},
    };
#undef CRESCENT_OF_REGION
#undef CRESCENT_OF_FRAME
    return words;
}

std::string form_of(const QuantityWord& word) {
    static constexpr std::string_view brackets[] = {
        "", "(ARM, n=N, s=S)", "(FURNACE)", "(SHAPE)", "(REGION)", "(PLATE)", "(ARM)"};
    static_assert(
        std::size(brackets) == std::size_t(QuantityOf::compared) + 1, "a form for each subject of a quantity");
    return fmt::format(
        "{}{}{}", word.word, word.of_region ? ".REGION" : "", brackets[static_cast<std::size_t>(word.adapter)]);
}

std::optional<Comparison> parse_comparison(
    std::string_view text, std::string& message, const std::vector<QuantityWord>& words) {
    return Parser(text, message, words).comparison();
}

std::string resolve_quantity(ParsedQuantity& q, const Experiment& e) {
    if (q.number) return "";
    if (!q.region.empty())
        if (std::string message = missing(e.regions, "region", q.region); !message.empty()) return message;
    const QuantityWord* info = word_of(q);
    switch (info ? info->adapter : QuantityOf::none) {
        case QuantityOf::none:
        case QuantityOf::compared: return "";
        case QuantityOf::run: return resolve_run(q, e);
        case QuantityOf::furnace: return missing(e.furnaces, "furnace", q.adapter);
        case QuantityOf::shape: return e.find_surface(q.adapter) ? "" : missing(e.shapes, "shape", q.adapter);
        case QuantityOf::region: return missing(e.regions, "region", q.adapter);
        case QuantityOf::plate: return missing(e.plates, "plate", q.adapter);
    }
    return "";
}

// ---- Parses every assertion of the file and completes its quantities.

namespace {

bool is_number(const Comparison& c) { return c.left.number && c.right.number; }

void resolve(ParseContext& context, AssertionPlan& plan, const std::string& path) {
    std::string message;
    std::optional<Comparison> check = parse_comparison(plan.text, message);
    if (check && is_number(*check)) {
        check.reset();
        message = "expected a quantity on one side at least, found two numbers";
    }
    if (check)
        if (message = resolve_quantity(check->left, context.e); message.empty())
            message = resolve_quantity(check->right, context.e);
    for (const std::string_view word : {"tail", "flip"})
        if (message.empty() && plan.median && (check->left.word == word || check->right.word == word))
            message = fmt::format("expected over = \"seed\": {} is not measured at every seed", word);
    if (!message.empty()) return context.report(path, fmt::format("{}: {}", path, message));
    plan.check = *std::move(check);
}

}  // namespace

void resolve_assertions(ParseContext& context) {
    for (AssertionPlan& plan : context.e.assertions) {
        const std::string path = fmt::format("assertions.{}.check", plan.name);
        if (context.is_valid(path)) resolve(context, plan, path);
    }
}

}  // namespace crescent
