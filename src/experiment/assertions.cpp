// Every check of the file, parsed; its quantities are written out in full.
#include <fmt/format.h>

#include "experiment/parse_context.h"
#include "experiment/quantity_text.h"

namespace crescent::inline experiment {

namespace {

bool is_number(const Comparison& c) { return c.left.number && c.right.number; }

void resolve(ParseContext& context, AssertionPlan& plan, const std::string& path) {
    std::string why;
    std::optional<Comparison> check = parse_comparison(plan.text, why);
    if (check && is_number(*check)) check.reset(), why = "expected a quantity on one side at least, found two numbers";
    if (check)
        if (why = resolve_quantity(check->left, context.e); why.empty())
            why = resolve_quantity(check->right, context.e);
    if (why.empty() && plan.median && (check->left.word == "tail" || check->right.word == "tail"))
        why = "expected over = \"seed\": tails are measured at the experiment's seed alone";
    if (!why.empty()) return context.report(path, fmt::format("{}: {}", path, why));
    plan.check = *std::move(check);
}

}  // namespace

void resolve_assertions(ParseContext& context) {
    for (AssertionPlan& plan : context.e.assertions) {
        const std::string path = fmt::format("assertions.{}.check", plan.name);
        if (context.is_valid(path)) resolve(context, plan, path);
    }
}

}  // namespace crescent::inline experiment
