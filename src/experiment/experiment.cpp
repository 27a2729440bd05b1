// Questions that an experiment answers about itself.
#include "experiment/experiment.h"

#include <algorithm>

namespace crescent {

namespace {

bool has_own_s(const Shape& shape) { return shape.material.s && !shape.material.inherits_s; }

/// The shape whose s is the experiment's, as an index; -1: none has one.
std::ptrdiff_t s_shape(const Experiment& e) {
    const auto first = [&](auto holds) {
        const auto it = std::find_if(
            e.shapes.begin(), e.shapes.end(), [&](const Shape& shape) { return has_own_s(shape) && holds(shape); });
        return it == e.shapes.end() ? -1 : it - e.shapes.begin();
    };
    if (e.exponent)
        if (const auto control = first([&](const Shape& shape) { return shape.name == e.exponent->shape; });
            control >= 0)
            return control;
    if (const auto lobe = first([](const Shape& shape) { return shape.material.rho_s > 0; }); lobe >= 0) return lobe;
    return first([](const Shape&) { return true; });
}

template <class T> const T* find_named(const std::vector<T>& all, std::string_view name) {
    const auto it = std::find_if(all.begin(), all.end(), [&](const T& one) { return one.name == name; });
    return it == all.end() ? nullptr : &*it;
}

}  // namespace

const Shape* Experiment::shape_of_s() const {
    const auto shape = s_shape(*this);
    return shape < 0 ? nullptr : &shapes[static_cast<std::size_t>(shape)];
}

double Experiment::s() const {
    const Shape* shape = shape_of_s();
    return shape ? *shape->material.s : 0;
}

Experiment Experiment::with_s(double other) const {
    Experiment e = *this;
    if (const auto shape = s_shape(e); shape >= 0) e.shapes[static_cast<std::size_t>(shape)].material.s = other;
    for (Shape& shape : e.shapes)
        if (shape.material.inherits_s) shape.material.s = other;
    return e;
}

std::uint64_t Experiment::n_of(const ArmPlan& arm) const {
    if (std::find(arm.n.begin(), arm.n.end(), n) != arm.n.end()) return n;
    return arm.n.empty() ? n : arm.n.back();
}

const Shape* Experiment::find_shape(std::string_view name) const { return find_named(shapes, name); }
const ArmPlan* Experiment::find_arm(std::string_view name) const { return find_named(arms, name); }
const Region* Experiment::find_region(std::string_view name) const { return find_named(regions, name); }

Place Experiment::place_of(const std::string& path) const {
    for (std::string at = path;; at.resize(at.rfind('.'))) {
        if (const auto it = places.find(at); it != places.end()) return it->second;
        if (at.find('.') == std::string::npos) return {file, 0, 0};
    }
}

}  // namespace crescent
