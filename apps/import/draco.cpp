// By Google's library, which checks the bytes; the number of components of an attribute is checked by who takes it.
#include "draco.h"

#include <fmt/format.h>

#include "model.h"

#if CRESCENT_DRACO
#include <draco/compression/decode.h>
#endif

namespace crescent::importer {

#if CRESCENT_DRACO

bool can_read_draco() { return true; }

DracoMesh read_draco(std::string_view bytes, const std::map<std::string, std::size_t>& ids) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded_mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded_mesh.ok()) throw ModelError(fmt::format("Draco: {}", decoded_mesh.status().error_msg_string()));
    const draco::Mesh& mesh = *decoded_mesh.value();
    DracoMesh out;
    out.count = mesh.num_points();
    for (const auto& [name, id] : ids) {
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        if (!attribute) throw ModelError(fmt::format("Draco: expected an attribute {}, which is {}", id, name));
        const std::int8_t components = attribute->num_components();
        std::vector<double>& to = out.values[name];
        std::vector<double> row(static_cast<std::size_t>(components));
        for (std::uint32_t k = 0; k < mesh.num_points(); ++k) {
            const draco::AttributeValueIndex index = attribute->mapped_index(draco::PointIndex(k));
            if (!attribute->ConvertValue<double>(index, components, row.data()))
                throw ModelError(fmt::format("Draco: expected numbers for {}", name));
            to.insert(to.end(), row.begin(), row.end());
        }
    }
    for (std::uint32_t k = 0; k < mesh.num_faces(); ++k)
        for (const draco::PointIndex corner : mesh.face(draco::FaceIndex(k))) {
            if (corner.value() >= out.count) throw ModelError(fmt::format("Draco: face {}: beyond the vertices", k));
            out.corners.push_back(corner.value());
        }
    return out;
}

#else

bool can_read_draco() { return false; }

DracoMesh read_draco(std::string_view, const std::map<std::string, std::size_t>&) {
    throw ModelError("Draco: this build has no decoder");
}

#endif

}  // namespace crescent::importer
