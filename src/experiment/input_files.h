// The files that an experiment names: of its scene, and of its samplers.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "experiment/experiment.h"
#include "scene/mesh/mesh.h"
#include "scene/sky.h"

namespace crescent {

/// The textures of a mesh by the keys that name them.
struct TextureKey {
    const char* name;
    TextureOf of;
    Texture MeshObject::* texture;
};
inline constexpr TextureKey texture_keys[] = {{"rho_d_texture", TextureOf::rho_d, &MeshObject::rho_d_texture},
    {"alpha_texture", TextureOf::alpha, &MeshObject::alpha_texture}};

/// Reads the image of a sky and sets its content hash. Throws InputError with the file and the texel: no image, a
/// texel that is negative, not finite or too bright, no light, or another image than the experiment expects.
void load_sky(SkyLight& sky);

/// Returns how many numbers of a sky's file count as 0; "" if none.
std::string note_on_sky(const SkyLight& sky);

/// Reads a texture that has no image yet, next to `experiment_file`. Throws InputError with the file and
/// the texel.
void load_texture(Texture& texture, TextureOf property, const std::string& experiment_file);

/// Reads the file of every mesh that has none yet; throws InputError with the place of its key.
void read_meshes(Experiment& experiment);

/// Returns the hash of a mesh and its textures, whose files must have been read: 16 hexadecimal digits. Without
/// textures it is that of the .mesh file.
std::string content_of(const MeshObject& mesh);

// ---- Where files are found by their paths: on the disk (disk_files.cpp), or, in a program without one, among those
// that it was given (apps/web/files.cpp). Throw InputError with the path.

/// Returns the content of the file; of a sky, that of a layer, or of the first part ("").
std::shared_ptr<const MeshPack> mesh_in_file(const std::string& path);
std::shared_ptr<const RgbImage> sky_in_file(const std::string& path, const std::string& layer);
std::shared_ptr<const RgbImage> texture_in_file(const std::string& path);

/// Whether a path below `folder` leads out of it by a link.
bool leads_out(const std::string& folder, const std::string& path);

/// Whether the path is that of a pipe, a device or a folder.
bool is_no_regular_file(const std::string& path);

// ---- The files of the samplers that an experiment names: shared libraries and Python files.

/// FILE.py of "FILE.py" and "FILE.py:NAME"; "" for "module:NAME".
std::string_view python_file(std::string_view sampler);

/// The file of an arm's sampler; "" if it has none: a built-in sampler, a program or an installed module.
std::string sampler_file(const ArmPlan& arm);

/// XXH3 of the content of each sampler's file, " ARM=HASH" in the experiment's order; 0 for a file that cannot
/// be read. Another content is another experiment under any name of the file.
std::string sampler_file_hashes(const Experiment& experiment);

/// Throws InputError with the place of each plugin, program and Python sampler that the experiment names.
void refuse_code(const Experiment& experiment);

}  // namespace crescent
