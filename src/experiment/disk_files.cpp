// The files of a scene on the disk. A mesh is not read before its size is known to be that of a regular file.
#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "base/errors.h"
#include "base/parallel.h"
#include "experiment/input_files.h"
#include "render/exr.h"

namespace crescent {

namespace {

std::string contents_of_regular_file(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw InputError({path, 0, 0}, "expected a .mesh file, found none");
    if (!std::filesystem::is_regular_file(status)) throw InputError({path, 0, 0}, "expected a regular file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream file(path, std::ios::binary);
    std::string bytes;
    if (!error && file) {
        bytes.resize(size);
        file.read(bytes.data(), static_cast<std::streamsize>(size));
    }
    if (error || !file) throw InputError({path, 0, 0}, "expected a .mesh file that can be read");
    return bytes;
}

/// The packs of files that some experiment still has, by their contents: two tables that name one file share one, and
/// an experiment that is read again from its text builds no tree again.
class PacksInUse {
public:
    std::shared_ptr<const MeshPack> read(const std::string& bytes, const std::string& file) {
        const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
        const std::pair<std::uint64_t, std::uint64_t> key(hash.high64, hash.low64);
        {
            const Guard guard(lock_);
            if (const auto entry = packs_.find(key); entry != packs_.end())
                if (std::shared_ptr<const MeshPack> pack = entry->second.lock()) return pack;
        }
        std::shared_ptr<const MeshPack> pack = read_mesh(bytes, file);
        const Guard guard(lock_);
        std::erase_if(packs_, [](const auto& entry) { return entry.second.expired(); });
        packs_[key] = pack;
        return pack;
    }

private:
    Mutex lock_;
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::weak_ptr<const MeshPack>> packs_;
};
PacksInUse packs_in_use;

}  // namespace

bool is_no_regular_file(const std::string& path) {
    std::error_code unknown;
    const std::filesystem::file_status status = std::filesystem::status(path, unknown);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

bool leads_out(const std::string& folder, const std::string& path) {
    std::error_code error;
    const std::filesystem::path root = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, error),
                                file = std::filesystem::weakly_canonical(path, error);
    return !error && *file.lexically_relative(root).begin() == "..";
}

std::shared_ptr<const MeshPack> mesh_in_file(const std::string& path) {
    return packs_in_use.read(contents_of_regular_file(path), path);
}
std::shared_ptr<const RgbImage> sky_in_file(const std::string& path, const std::string& layer) {
    return read_sky(path, layer);
}
std::shared_ptr<const RgbImage> texture_in_file(const std::string& path) { return read_texture(path); }

}  // namespace crescent
