// A kind of light is widened by its lengths (m), multiplied; a rectangle by its edges, its corner moved so that the
// centre stays. Directions stay as they are.
#include "experiment/light_tables.h"

#include <fmt/format.h>

#include <variant>

namespace crescent::inline experiment {

std::vector<LightTable> all_lights(const SceneData& scene) {
    std::vector<LightTable> out;
    for (const DiskLight& disk : scene.disks) out.push_back({"disks." + disk.name, disk.light()});
    for (const Light& light : scene.lights) out.push_back({"lights." + light.name, light});
    return out;
}

std::vector<std::string> widened(const LightTable& table, double factor) {
    std::vector<std::string> out;
    const auto set = [&](std::string_view key, const std::string& value) {
        out.push_back(fmt::format("{}.{}={}", table.path, key, value));
    };
    const auto point = [](Vec3d v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); };
    std::visit(
        [&]<class Kind>(const Kind& kind) {
            for (const Parameter<Kind>& parameter : Kind::parameters())
                if (const auto* length = std::get_if<double Kind::*>(&parameter.member))
                    set(parameter.name, fmt::format("{}", factor * kind.**length));
            if constexpr (requires { kind.corner, kind.edge_u, kind.edge_v; }) {
                set("corner", point(kind.corner - 0.5 * (factor - 1) * (kind.edge_u + kind.edge_v)));
                set("edge_u", point(factor * kind.edge_u));
                set("edge_v", point(factor * kind.edge_v));
            }
        },
        table.light.form);
    return out;
}

}  // namespace crescent::inline experiment
