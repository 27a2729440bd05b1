// Values derived from an experiment.
#include "experiment/experiment.h"

#include <algorithm>

namespace crescent::inline experiment {

namespace {

template <class T> const T* find_named(const std::vector<T>& all, std::string_view name) {
    const auto it = std::find_if(all.begin(), all.end(), [&](const T& one) { return one.name == name; });
    return it == all.end() ? nullptr : &*it;
}

}  // namespace

Experiment Experiment::with_s(double other) const {
    Experiment e = *this;
    if (const auto own = surface_of_s()) e.material(*own).s = other;
    for (std::size_t k = 0; k < e.surface_count(); ++k)
        if (e.material(k).inherits_s) e.material(k).s = other;
    return e;
}

std::uint64_t Experiment::n_of(const ArmPlan& arm) const {
    if (std::find(arm.n.begin(), arm.n.end(), n) != arm.n.end()) return n;
    return arm.n.empty() ? n : arm.n.back();
}

std::string Experiment::surface_path(std::size_t surface) const {
    return (surface < shapes.size() ? "shapes." : "meshes.") + surface_name(surface);
}

const ArmPlan* Experiment::find_arm(std::string_view name) const { return find_named(arms, name); }
const Region* Experiment::find_region(std::string_view name) const { return find_named(regions, name); }

SourceLocation Experiment::place_of(const std::string& path) const {
    for (std::string at = path;; at.resize(at.rfind('.'))) {
        if (const auto it = places.find(at); it != places.end()) return it->second;
        if (at.find('.') == std::string::npos) return {file, 0, 0};
    }
}

}  // namespace crescent::inline experiment
