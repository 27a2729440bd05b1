// A combination and its parts are each made once, also if several combinations share a part.
#include "experiment/combinations.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <set>

#include "base/errors.h"
#include "base/vec.h"
#include "experiment/experiment.h"
#include "experiment/parser.h"
#include "experiment/value.h"
#include "math/simd/random.h"
#include "render/combination.h"
#include "render/kernel.h"
#include "samplers/info.h"
#include "samplers/weight_formula.h"

namespace crescent {

namespace {

/// The combinations of an experiment and the parts that they share, each made once.
class Combinations {
public:
    Combinations(const Experiment& experiment, ExternalSamplers& samplers)
        : experiment_(experiment), samplers_(samplers) {}

    void add_all() {
        for (const ArmPlan& arm : experiment_.arms)
            if (arm.is_combination()) samplers_[arm.name] = of(arm);
    }

private:
    std::shared_ptr<const Combination> of(const ArmPlan& arm) {
        std::shared_ptr<const Combination>& combination = combinations_[arm.name];
        if (combination) return combination;
        const std::string path = "arms." + arm.name;
        Techniques parts;
        for (const std::string& name : arm.combination.of) parts.push_back(part(arm, name, "of"));
        const std::optional<std::string>& target = arm.combination.target;
        const bool has_target = target && *target != target_product && *target != target_brdf;
        combination = std::make_shared<Combination>(arm.name, arm.combination, std::move(parts),
            has_target ? part(arm, *target, "target") : nullptr, experiment_.place_of(path + ".weights"),
            experiment_.place_of(path + ".probabilities"), weight_function(arm, path));
        return combination;
    }

    std::shared_ptr<const SamplerAdapter> weight_function(const ArmPlan& arm, const std::string& path) const {
        if (!arm.combination.weights_python) return nullptr;
        if (const auto entry = samplers_.find(arm.name);
            entry != samplers_.end() && entry->second->declaration().weighs)
            return entry->second;
        throw InputError(experiment_.place_of(path + ".weights_python"),
            fmt::format("{}.weights_python: expected a run in Python (crescent.run): the program cannot call '{}'",
                path, *arm.combination.weights_python));
    }

    std::shared_ptr<const Technique> part(const ArmPlan& owner, const std::string& name, const char* key) {
        const ArmPlan* arm = experiment_.find_arm(name);
        if (arm && arm->is_combination()) {
            std::shared_ptr<const Technique> technique = of(*arm)->technique();
            ensure(technique != nullptr, "the parser lets only combinations with a density through");
            return technique;
        }
        if (arm && arm->is_external()) {
            std::shared_ptr<const Technique> technique = external_technique(samplers_.at(name));
            if (technique->has_density()) return technique;
            const std::string path = fmt::format("arms.{}.{}", owner.name, key);
            throw InputError(experiment_.place_of(path),
                fmt::format("{}: '{}' has no pdf of a direction, which a combination needs: expected a function pdf",
                    path, samplers_.at(name)->name()));
        }
        return built_in_technique(arm ? arm->sampler : name);
    }

    const Experiment& experiment_;
    ExternalSamplers& samplers_;
    std::map<std::string, std::shared_ptr<const Combination>> combinations_;
};

}  // namespace

void add_combinations(const Experiment& experiment, ExternalSamplers& samplers) {
    Combinations(experiment, samplers).add_all();
}

// ---- The arm that samples as a renderer does: the balance heuristic of the material and each kind of light. Veach &
// Guibas 1995; Pharr, Jakob & Humphreys 2023, "Physically Based Rendering", 13.4.

std::vector<std::string> sampler_words() {
    std::vector<std::string> words = sampler_names();
    words.emplace_back(renderer_word);
    return words;
}

void expand_renderers(ParseContext& context) {
    Experiment& e = context.e;
    const auto shines = [](const auto& light) { return std::ranges::max(light.radiance) > 0; };
    std::vector<std::string> parts = {"material"};
    if (std::ranges::any_of(e.disks, shines) || std::ranges::any_of(e.lights, shines))
        parts.push_back("light-solid-angle");
    if (e.sky) parts.push_back("sky");
    if (std::ranges::any_of(e.meshes, &MeshObject::emits)) parts.push_back("light-triangle");
    for (ArmPlan& arm : e.arms) {
        if (arm.sampler != renderer_word || arm.is_combination()) continue;
        for (const std::string& part : parts)
            if (const ArmPlan* other = e.find_arm(part); other && other->sampler != part && parts.size() > 1)
                context.report("arms." + other->name,
                    fmt::format("arms.{0}: expected the sampler '{0}', which the arm '{1}' combines, or another name",
                        other->name, arm.name));
        if (parts.size() == 1) {
            arm.sampler = parts[0];
            continue;
        }
        arm.sampler.clear();
        arm.combination.kind = CombinationKind::mis;
        arm.combination.of = parts;
    }
}

// ---- Checks of arms that combine samplers: names that exist, no arm within itself, weights whose sum is one, parts
// that can be combined.

namespace {

constexpr std::size_t most_samplers = 64;  // of an arm with those of its parts: each sample evaluates all of them
constexpr std::uint32_t probes = 64;       // points at which the sum of formulas is tested, for each shape

class Checks {
public:
    explicit Checks(ParseContext& context) : context_(context) {}

    void all() {
        for (const ArmPlan& arm : context_.e.arms) {
            const std::string path = "arms." + arm.name;
            if (!context_.is_valid(path + ".kind")) continue;
            if (!arm.is_combination()) {
                keys_without_kind(arm, path);
                continue;
            }
            names(arm, path);
            form(arm, path);
            const bool is_evaluable = lists(arm, path);
            if (is_evaluable) sums(arm, path);
        }
    }

private:
    void report(const std::string& path, const std::string& message) {
        context_.report(path, fmt::format("{}: {}", path, message));
    }

    void keys_without_kind(const ArmPlan& arm, const std::string& path) {
        const CombinationPlan& c = arm.combination;
        const std::array keys = {std::pair("of", !c.of.empty()), std::pair("heuristic", c.heuristic.has_value()),
            std::pair("draw", c.draw.has_value()), std::pair("weights", !c.weights.empty()),
            std::pair("weights_python", c.weights_python.has_value()),
            std::pair("probabilities", !c.probabilities.empty()), std::pair("samples", !c.samples.empty()),
            std::pair("candidates", c.candidates.has_value()), std::pair("target", c.target.has_value())};
        for (const auto& [key, is_given] : keys)
            if (is_given)
                return report(fmt::format("{}.{}", path, key),
                    fmt::format("expected a kind beside it in [{}]: one of mis, mixture, ris", path));
    }

    /// Arms, and built-in samplers.
    std::vector<std::string> valid_names(const ArmPlan& arm) const {
        std::vector<std::string> out;
        for (const ArmPlan& other : context_.e.arms)
            if (other.name != arm.name) out.push_back(other.name);
        for (const std::string& name : sampler_names())
            if (name != arm.name && std::ranges::find(out, name) == out.end()) out.push_back(name);
        return out;
    }

    /// Returns why this name cannot be a part; "" if it can.
    std::string why_no_part(const ArmPlan& arm, const std::string& name) const {
        if (name == arm.name) return "expected other samplers, found the arm itself";
        const ArmPlan* other = context_.e.find_arm(name);
        if (other && other->is_combination()) {
            if (contains(*other, arm.name)) return fmt::format("the arm '{}' combines '{}' itself", name, arm.name);
            if (!has_density(*other))
                return fmt::format("the arm '{}' has no density of a direction: expected a sampler or a mixture", name);
            return "";
        }
        if (other && other->is_external()) return "";
        const SamplerInfo* info = find_arm_info(other ? other->sampler : name);
        if (!info) {
            if (other) return "";  // reported at that arm
            const std::vector<std::string> valid = valid_names(arm);
            return fmt::format("no arm or sampler '{}': expected one of {}{}", name.substr(0, 64), listed(valid, ", "),
                hint(name, valid));
        }
        if (info->needs_s && !(context_.e.s() > 0))
            return fmt::format("'{}' needs an exponent: expected a key 's' in one of the shapes", name);
        if (info->techniques > 1)
            return fmt::format("'{}' is two samplers with weights: expected its parts, mixture and light-area", name);
        return "";
    }

    static bool has_density(const ArmPlan& arm) {
        const CombinationPlan& c = arm.combination;
        return c.kind == CombinationKind::mixture ||
            (c.kind == CombinationKind::mis && c.draw == MisDraw::one && c.weights.empty() && !c.weights_python &&
                c.heuristic.value_or(MisHeuristic::balance) == MisHeuristic::balance);
    }

    bool contains(const ArmPlan& arm, const std::string& name) const {
        std::set<std::string> visited_names;
        std::vector<const ArmPlan*> pending = {&arm};
        while (!pending.empty()) {
            const ArmPlan* pending_arm = pending.back();
            pending.pop_back();
            if (!visited_names.insert(pending_arm->name).second) continue;
            for (const std::string& part : pending_arm->combination.of) {
                if (part == name) return true;
                if (const ArmPlan* other = context_.e.find_arm(part); other && other->is_combination())
                    pending.push_back(other);
            }
        }
        return false;
    }

    /// Returns the number of samplers that a sample of an arm evaluates, at most one more than may be. A part that
    /// occurs several times counts each time; an arm within itself, which is reported elsewhere, counts once.
    std::size_t sampler_count(const ArmPlan& arm) {
        const auto [entry, is_new] = sampler_counts_.try_emplace(arm.name, 1);
        if (!is_new) return entry->second;
        std::size_t sum = 0;
        std::vector<std::string> parts = arm.combination.of;
        if (arm.combination.target) parts.push_back(*arm.combination.target);
        for (const std::string& part : parts) {
            const ArmPlan* other = context_.e.find_arm(part);
            sum += other && other->is_combination() ? sampler_count(*other) : 1;
        }
        return sampler_counts_[arm.name] = std::min(sum, most_samplers + 1);
    }

    void names(const ArmPlan& arm, const std::string& path) {
        const CombinationPlan& c = arm.combination;
        if (!context_.is_valid(path + ".of")) return;
        if (sampler_count(arm) > most_samplers)
            report(path + ".of",
                fmt::format("expected at most {} samplers, found more: a part that occurs several times counts each "
                            "time",
                    most_samplers));
        const std::size_t least_parts = c.kind == CombinationKind::ris ? 1 : 2;
        if (!c.of.empty() && (c.of.size() < least_parts || c.of.size() > most_parts))
            report(path + ".of",
                fmt::format("expected {} to {} samplers, found {}", least_parts, most_parts, c.of.size()));
        for (std::size_t i = 0; i < c.of.size(); ++i)
            if (const std::string reason = why_no_part(arm, c.of[i]); !reason.empty()) {
                const std::string place_of_part = fmt::format("{}.of.{}", path, i);
                context_.report(context_.e.places.contains(place_of_part) ? place_of_part : path + ".of",
                    fmt::format("{}: {}", place_of_part, reason));
            }
        if (!c.target || *c.target == target_product || *c.target == target_brdf) return;
        if (std::string reason = why_no_part(arm, *c.target); !reason.empty()) {
            if (reason.starts_with("no arm")) {
                std::vector<std::string> valid = valid_names(arm);
                valid.insert(valid.begin(), {target_product, target_brdf});
                reason = fmt::format("no target '{}': expected one of {}{}", c.target->substr(0, 64),
                    listed(valid, ", "), hint(*c.target, valid));
            }
            report(path + ".target", reason);
        }
    }

    /// Keys that exclude each other.
    void form(const ArmPlan& arm, const std::string& path) {
        const CombinationPlan& c = arm.combination;
        if (c.heuristic && !c.weights.empty()) report(path + ".weights", "expected weights or a heuristic, found both");
        if (c.weights_python && (c.heuristic || !c.weights.empty()))
            report(path + ".weights_python", "expected it without weights and heuristic beside it");
        if (c.kind == CombinationKind::mis && c.draw != MisDraw::one && !c.probabilities.empty())
            report(path + ".probabilities", "expected draw = \"one\" beside it: otherwise every sampler is drawn from");
        if (c.draw == MisDraw::one && !c.samples.empty())
            report(path + ".samples", "expected draw = \"every\": with \"one\", a sample is one direction");
        if (c.kind == CombinationKind::ris && c.candidates && !c.of.empty() && *c.candidates < c.of.size())
            report(path + ".candidates",
                fmt::format("expected at least {}, one of each in 'of', found {}", c.of.size(), *c.candidates));
    }

    /// Returns whether the weights can be evaluated.
    bool lists(const ArmPlan& arm, const std::string& path) {
        const CombinationPlan& c = arm.combination;
        bool is_evaluable = !c.of.empty() && context_.is_valid(path + ".of");
        const auto list = [&](const std::string& key, const std::vector<std::string>& texts, bool of_direction) {
            if (texts.empty() || !context_.is_valid(path + "." + key)) return;
            try {
                (void)WeightList(texts, c.of.size(), of_direction, {});
            } catch (const InputError& error) {
                report(path + "." + key, error.diagnostics().front().message);
                is_evaluable = false;
            }
        };
        if (!is_evaluable) return false;
        list("weights", c.weights, c.kind == CombinationKind::mis);
        list("probabilities", c.probabilities, false);
        if (!c.samples.empty() && c.samples.size() != 1 && c.samples.size() != c.of.size())
            report(path + ".samples",
                fmt::format(
                    "expected one integer, or {}, one for each of 'of', found {}", c.of.size(), c.samples.size()));
        return is_evaluable;
    }

    /// Evaluates the weights on the materials of the scene, at random directions and densities.
    void sums(const ArmPlan& arm, const std::string& path) {
        const CombinationPlan& c = arm.combination;
        const auto test = [&](const std::string& key, const std::vector<std::string>& texts, bool of_direction) {
            if (texts.empty()) return;
            const WeightList weights(texts, c.of.size(), of_direction, {});
            std::vector<double> out(c.of.size()), p(c.of.size());
            const Experiment& e = context_.e;
            for (std::size_t surface = 0; surface < e.surface_count(); ++surface)
                for (std::uint32_t k = 0; k < probes; ++k) {
                    const FormulaInputs in = probe(e.material(surface), k, p);
                    try {
                        weights.evaluate(in, out);
                    } catch (const InputError& error) {
                        return report(path + "." + key,
                            fmt::format("{} (on the surface '{}')", error.diagnostics().front().message,
                                e.surface_name(surface)));
                    }
                }
        };
        test("weights", c.weights, c.kind == CombinationKind::mis);
        test("probabilities", c.probabilities, false);
    }

    static FormulaInputs probe(const Material& material, std::uint32_t k, std::vector<double>& p) {
        const Surface m = surface_of(material, material.s.value_or(1));
        const auto unit = [&](std::uint32_t i) { return static_cast<double>(crescent::draw(1, k, 0, i).x); };
        for (std::size_t i = 0; i < p.size(); ++i) p[i] = 10 * unit(static_cast<std::uint32_t>(i) + 2);
        FormulaInputs in;
        in.s = m.s;
        in.alpha = m.alpha;
        in.rho_d = luminance(m.rho_d);
        in.rho_s = m.rho_s;
        in.cos_o = unit(0);
        in.cos_i = unit(1);
        in.p = p;
        return in;
    }
    ParseContext& context_;
    std::map<std::string, std::size_t> sampler_counts_{};  // by arm
};

}  // namespace

void check_combinations(ParseContext& context) { Checks(context).all(); }

}  // namespace crescent
