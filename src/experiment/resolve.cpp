// What depends on other keys is filled in: every Lambert surface's s, every arm's ladder, the n of runs that name none.
// Then each run that a plate or the exponent control asks for is checked to be one that the experiment makes.
#include <fmt/format.h>

#include <algorithm>

#include "arms/info.h"
#include "experiment/parse_context.h"
#include "experiment/names.h"

namespace crescent::inline experiment {

namespace {

void resolve_s(ParseContext& context) {
    Experiment& e = context.e;
    if (e.exponent && context.is_valid("exponent.shape")) {
        const Shape* shape = e.find_shape(e.exponent->shape);
        if (shape && !shape->material.s && context.is_valid("shapes." + shape->name + ".s"))
            context.report("exponent.shape",
                fmt::format(
                    "exponent.shape: expected a shape with an s of its own, found '{}' without one", shape->name));
    }
    if (e.exponent) e.s_of = e.exponent->shape;
    const double s = e.s();
    for (Shape& shape : e.shapes)
        if (!shape.material.s && s > 0) shape.material.s = s, shape.material.inherits_s = true;
    if (s > 0 || std::any_of(e.shapes.begin(), e.shapes.end(), [&](const Shape& x) {
            return !context.is_valid("shapes." + x.name + ".s");
        }))
        return;
    for (const ArmPlan& arm : e.arms)
        if (const ArmInfo* info = find_arm_info(arm.sampler); info && info->needs_s)
            context.report("arms." + arm.name,
                fmt::format("the arm '{}' needs an exponent: expected a key 's' in one of the shapes", arm.name));
}

void resolve_ladders(ParseContext& context) {
    for (ArmPlan& arm : context.e.arms) {
        const std::string path = "arms." + arm.name;
        if (!arm.n.empty() || !context.is_valid(path + ".n") || !context.is_valid("n")) continue;
        if (context.e.n > 0) arm.n = {context.e.n};
        else
            context.report(path + ".n",
                fmt::format("missing key 'n' in [{}]: expected ascending integers from 1 to "
                            "16777216 (samples/pixel), or an n for the whole experiment",
                    path));
    }
}

/// The n of a run, its arm's where it names none; complains where the arm has no such rung.
std::uint64_t rung(ParseContext& context, const std::string& path, const std::string& arm_name, std::uint64_t n) {
    const ArmPlan* arm = context.e.find_arm(arm_name);
    if (!arm || arm->n.empty()) return n;
    if (n == 0) return context.e.n_of(*arm);
    if (!std::count(arm->n.begin(), arm->n.end(), n))
        context.report(path,
            fmt::format(
                "{}: the arm '{}' has no rung n = {}: expected one of {}", path, arm_name, n, listed(arm->n, ", ")));
    return n;
}

void check_s(ParseContext& context, const std::string& path, const PlateRun& run) {
    std::string why = why_not_run(context.e, run.arm, run.n, run.s);
    if (!why.empty()) context.report(path, fmt::format("{}: {}", path, why));
}

void resolve_plate(ParseContext& context, PlatePlan& plate) {
    const std::string path = "plates." + plate.name;
    if (!context.is_valid(path + ".kind") || !context.is_valid(path + ".runs")) return;
    const PlateInfo& kind = plate_info(plate.kind);
    if (plate.runs.size() < kind.least || plate.runs.size() > kind.most) {
        const std::string many =
            kind.least == kind.most ? fmt::format("{}", kind.least) : fmt::format("{} to {}", kind.least, kind.most);
        context.report(path + ".runs",
            fmt::format(
                "{}.runs: expected {} for a plate of kind {}, found {}", path, many, kind.name, plate.runs.size()));
    }
    std::vector<PlateRun> runs;
    for (std::size_t i = 0; i < plate.runs.size(); ++i) {
        PlateRun run = plate.runs[i];
        const std::string own = fmt::format("{}.runs.{}", path, i);
        const ArmPlan* arm = context.e.find_arm(run.arm);
        const bool open = run.n == 0 && context.is_valid(own + ".n") && arm && !arm->n.empty();
        if (open && plate.kind == PlateKind::ladder) {
            for (const std::uint64_t n : arm->n) runs.push_back({run.arm, n, run.s});
            continue;
        }
        const auto& control = context.e.exponent;
        if (plate.kind == PlateKind::exponent && run.n == 0 && run.s == 0 && context.is_valid(own + ".s") && control &&
            control->arm == run.arm) {
            for (const double s : control->s) runs.push_back({run.arm, control->n, s});
            continue;
        }
        run.n = open && plate.kind == PlateKind::hero ? arm->n.back() : rung(context, own + ".n", run.arm, run.n);
        if (context.is_valid(own + ".n") && context.is_valid(own + ".s")) check_s(context, own + ".s", run);
        runs.push_back(run);
    }
    plate.runs = std::move(runs);
}

}  // namespace

std::string why_not_run(const Experiment& e, const std::string& arm, std::uint64_t n, double s) {
    if (s == 0 || s == e.s() || n == 0 || !e.find_arm(arm)) return "";
    if (!e.exponent)
        return fmt::format(
            "no run at s = {}: expected the experiment's own s = {}; there is no [exponent] control", s, e.s());
    const ExponentControl& control = *e.exponent;
    if (control.arm == arm && control.n == n && std::count(control.s.begin(), control.s.end(), s)) return "";
    return fmt::format(
        "no run {} n={} s={}: expected the experiment's own s = {}, or a run of the exponent control: {} n={} s = {}",
        arm, n, s, e.s(), control.arm, control.n, listed(control.s, ", "));
}

void resolve_runs(ParseContext& context) {
    resolve_s(context);
    resolve_ladders(context);
    if (context.e.exponent) {
        ExponentControl& control = *context.e.exponent;
        if (context.is_valid("exponent.n")) control.n = rung(context, "exponent.n", control.arm, control.n);
    }
    for (PlatePlan& plate : context.e.plates) resolve_plate(context, plate);
}

}  // namespace crescent::inline experiment
