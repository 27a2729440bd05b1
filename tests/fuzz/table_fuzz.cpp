// Any text as a CSV file of draws, or of the density of draws: it is read, or rejected with an InputError that has a
// message.
#include <cstdint>
#include <string>

#include "check/sources/sample_file.h"
#include "memory_file.h"

namespace {

using namespace crescent;

/// Enough for a check.
std::string rows_of_draws() {
    std::string out;
    for (int k = 0; k < 2000; ++k) out += k % 2 == 0 ? "0,0,1,0.3\n" : "0.6,0,0.8,0.2\n";
    return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string rows = rows_of_draws();
    static const MemoryFile draws("wix,wiy,wiz,pdf\n" + rows);
    const std::string text(reinterpret_cast<const char*>(data), size);
    const MemoryFile longer(text + "\n" + rows);
    const MemoryFile table(text);
    read_or_refuse([&] { (void)SampleFile(longer.path(), ""); });
    read_or_refuse([&] {
        const SampleFile read(draws.path(), table.path());
        (void)read.tabulation_error({0, 0, 1});
    });
    return 0;
}
