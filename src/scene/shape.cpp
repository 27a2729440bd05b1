// Each kind of shape answers for itself. A shape that is not one body, such as a panel, adds the bodies it consists of.
#include "scene/shape.h"

namespace crescent::inline scene {

Intersection intersect(const Shape& shape, Vec3d x, Vec3d d) {
    return std::visit([&](const auto& form) { return form.intersect(x, d); }, shape.form);
}

void add_occluders(const Shape& shape, int index, std::vector<Occluder>& out) {
    std::visit(
        [&](const auto& form) {
            if constexpr (Body<std::remove_cvref_t<decltype(form)>>) out.push_back({form, index});
            else
                for (const auto& body : form.bodies()) out.push_back({body, index});
        },
        shape.form);
}

std::optional<Rgb> albedo_of_reveal(const Shape& shape) {
    return std::visit(
        [](const auto& form) -> std::optional<Rgb> {
            if constexpr (requires { form.reveal_rho_d; }) return form.reveal_rho_d;
            else return {};
        },
        shape.form);
}

}  // namespace crescent::inline scene
