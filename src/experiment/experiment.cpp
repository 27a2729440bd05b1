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
    if (const Shape* own = shape_of_s()) e.shapes[static_cast<std::size_t>(own - shapes.data())].material.s = other;
    for (Shape& shape : e.shapes)
        if (shape.material.inherits_s) shape.material.s = other;
    return e;
}

std::uint64_t Experiment::n_of(const ArmPlan& arm) const {
    if (std::find(arm.n.begin(), arm.n.end(), n) != arm.n.end()) return n;
    return arm.n.empty() ? n : arm.n.back();
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
