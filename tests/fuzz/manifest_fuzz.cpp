// Any bytes as a baseline.json: it is read, or rejected with an InputError that has a message. What is read is written
// and read again with the same files.
#include <cstdint>
#include <string>

#include "base/errors.h"
#include "compare/suite/manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace crescent;
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const Manifest read = parse_manifest(text, "fuzz/baseline.json");
        const Manifest again = parse_manifest(manifest_text(read), "fuzz/baseline.json");
        ensure(again.views.size() == read.views.size(), "a manifest that is written has the same views");
        for (const auto& [name, view] : read.views) {
            ensure(!view.files.empty(), "a view has files");
            for (const ManifestFile& file : view.files)
                ensure(!file.name.empty() && file.name[0] != '/', "a file is in the folder of the manifest");
        }
    } catch (const InputError& error) {
        ensure(!error.diagnostics().empty() && !error.diagnostics().front().message.empty(), "a refusal says why");
    }
    return 0;
}
