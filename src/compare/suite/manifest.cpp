// A manifest may come from a merge by hand or from a stranger: everything is checked before it is used.
#include "compare/suite/manifest.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>
#include <xxhash.h>

#include "base/files.h"
#include "images/open_file.h"
#include "output/stored_json.h"

namespace crescent {

namespace {

namespace fs = std::filesystem;

constexpr const char* manifest_format = "crescent baseline 1";
constexpr std::size_t largest_manifest = std::size_t{64} << 20;  // bytes: about 100 000 files
constexpr int deepest = 16;                                      // a manifest has six levels
constexpr std::size_t renders_most = 1'000'000;

class Reader {
public:
    Reader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    Manifest read() {
        if (text_.starts_with(lfs_pointer)) fail("expected a manifest, found a pointer of Git LFS: run git lfs pull");
        for (const char* marker : {"<<<<<<<", "=======", ">>>>>>>"})
            if (const std::size_t position = text_.find(marker);
                position != std::string::npos && (position == 0 || text_[position - 1] == '\n'))
                throw InputError({file_, line_of(position), 1},
                    fmt::format("expected a manifest, found a conflict of a merge: '{}'", marker));
        const Json root = parsed();
        if (!root.is_object() || !root.contains("format") || root["format"] != manifest_format)
            fail(fmt::format("expected a manifest of '{}'; remove the file to begin a new one", manifest_format));
        const Json views = root.value("views", Json());
        if (!views.is_object()) fail("views: expected a table");
        Manifest out;
        out.folder = fs::path(file_).parent_path().string();
        std::set<std::string> names;
        for (const auto& [name, entry] : views.items()) out.views.emplace(name, view(name, entry, names));
        if (root.contains("removed")) out.removed = root["removed"];
        if (!out.removed.is_object()) fail("removed: expected a table");
        return out;
    }

private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError({file_, 0, 0}, message); }

    unsigned line_of(std::size_t byte) const {
        const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text_.size()));
        return 1 + static_cast<unsigned>(std::count(text_.begin(), end, '\n'));
    }

    /// Parses the text; a key that a table has twice, as after a merge, is an error.
    Json parsed() const {
        std::vector<std::set<std::string>> keys;
        const auto check = [&](int depth, Json::parse_event_t event, const Json& value) {
            if (depth > deepest) fail(fmt::format("expected at most {} levels", deepest));
            if (event == Json::parse_event_t::object_start) keys.emplace_back();
            if (event == Json::parse_event_t::object_end) keys.pop_back();
            if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
                fail(fmt::format("expected the key '{}' once, found it twice", value.get<std::string>()));
            return true;
        };
        try {
            return Json::parse(text_, check);
        } catch (const Json::parse_error& e) {
            throw InputError({file_, line_of(e.byte), 0}, "expected JSON: the manifest was cut off or changed by hand");
        } catch (const Json::exception& e) { fail("expected JSON that can be read: " + unreadable_json(e)); }
    }

    std::string word(const std::string& view, const Json& entry, const char* key) const {
        const auto member = entry.is_object() ? entry.find(key) : entry.end();
        if (!entry.is_object() || member == entry.end() || !member->is_string())
            fail(fmt::format("view '{}': expected a text '{}'", view, key));
        return member->get<std::string>();
    }

    ManifestView view(const std::string& name, const Json& entry, std::set<std::string>& names) const {
        ManifestView out;
        if (name.empty() || !entry.is_object()) fail(fmt::format("view '{}': expected a name and a table", name));
        const Json files = entry.value("files", Json()), renders = entry.value("renders", Json());
        if (!renders.is_number_unsigned() || renders.get<std::uint64_t>() > renders_most)
            fail(fmt::format("view '{}': expected 'renders', a number of at most {}", name, renders_most));
        out.renders = renders.get<std::size_t>();
        if (!files.is_array() || files.empty()) fail(fmt::format("view '{}': expected a list 'files'", name));
        for (const Json& item : files) {
            const ManifestFile file{word(name, item, "file"), word(name, item, "xxh3_128")};
            constexpr std::size_t digits = 32;
            if (file.hash.size() != digits || file.hash.find_first_not_of("0123456789abcdef") != std::string::npos)
                fail(fmt::format("view '{}': expected a hash of {} hexadecimal digits", name, digits));
            const fs::path path(file.name);
            const bool leaves_folder = std::find(path.begin(), path.end(), "..") != path.end();
            if (file.name.empty() || path.is_absolute() || leaves_folder || file.name.find('\0') != std::string::npos)
                fail(fmt::format(
                    "view '{}': expected a file in the folder of the manifest, found '{}'", name, file.name));
            if (!names.insert(file.name).second)
                fail(fmt::format("view '{}': expected each file once, found {} twice", name, file.name));
            out.files.push_back(file);
        }
        out.entry = entry;
        return out;
    }

    const std::string& text_;
    const std::string& file_;
};

bool is_lfs_pointer(const std::string& path) {
    const OpenFile file(path);
    std::string first(lfs_pointer.size(), '\0');
    return file.read_some(0, first) == lfs_pointer.size() && first == lfs_pointer;
}

/// Returns how a file that is listed differs; "" if it does not.
std::string difference(const ManifestFile& file, const std::string& path) {
    if (is_lfs_pointer(path)) return "a pointer of Git LFS: run git lfs pull";
    if (hash_of_file(path) != file.hash) return fmt::format("its contents are not those of {}", manifest_name);
    return "";
}

}  // namespace

Manifest parse_manifest(const std::string& text, const std::string& file) { return Reader(text, file).read(); }

std::optional<Manifest> read_manifest(const std::string& folder) {
    const std::string path = folder + "/" + manifest_name;
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (!fs::exists(status)) return {};
    const OpenFile file(path);
    if (file.size() > largest_manifest)
        file.fail(fmt::format("expected a manifest of at most {} MiB", largest_manifest >> 20));
    std::string text(static_cast<std::size_t>(file.size()), '\0');
    file.read(0, text);
    Manifest out = parse_manifest(text, path);
    out.folder = folder;
    return out;
}

std::string manifest_text(const Manifest& manifest) {
    Json out = {{"format", manifest_format}, {"views", Json::object()}};
    for (const auto& [name, view] : manifest.views) out["views"][name] = view.entry;
    if (!manifest.removed.empty()) out["removed"] = manifest.removed;
    return crescent::text(out);
}

std::vector<Diagnostic> manifest_differences(
    const Manifest& manifest, const std::string& view, const std::vector<std::string>& files) {
    std::vector<Diagnostic> out;
    std::map<std::string, std::string> paths;  // by name
    for (const std::string& path : files) paths.emplace(name_in(manifest.folder, path), path);
    const auto entry = manifest.views.find(view);
    if (entry != manifest.views.end())
        for (const ManifestFile& file : entry->second.files) {
            const auto path = paths.find(file.name);
            if (path == paths.end()) {
                const std::string missing_path = manifest.folder + "/" + file.name;
                std::error_code ignored;
                out.push_back({{missing_path, 0, 0},
                    fs::exists(missing_path, ignored)
                        ? fmt::format("the patterns of the baseline do not match this file, which {} lists for view {}",
                              manifest_name, view)
                        : fmt::format("no such file of the baseline: {} lists it for view {}", manifest_name, view)});
                continue;
            }
            const std::string why = difference(file, path->second);
            if (!why.empty()) out.push_back({{path->second, 0, 0}, why});
            paths.erase(path);
        }
    for (const auto& [name, path] : paths)
        out.push_back({{path, 0, 0},
            fmt::format("{} does not list this file of the baseline for view {}: remove it, or --accept the view",
                manifest_name, view)});
    return out;
}

std::string hash_of_file(const std::string& path) {
    const OpenFile file(path);
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
    XXH3_128bits_reset(state.get());
    std::vector<char> bytes(std::size_t{1} << 20);
    for (std::uint64_t from = 0; from < file.size();) {
        const std::size_t n = file.read_some(from, bytes);
        if (n == 0) break;
        XXH3_128bits_update(state.get(), bytes.data(), n);
        from += n;
    }
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string name_in(const std::string& folder, const std::string& path) {
    return fs::path(path).lexically_normal().lexically_relative(fs::path(folder).lexically_normal()).string();
}

}  // namespace crescent
