// Any text as the file of a suite or of a comparison: it is read, or rejected with an InputError that has a message.
// Its patterns find no files.
#include <cstdint>
#include <string>

#include "compare/plan.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_file.h"
#include "memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace crescent;
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (text.find('/') != std::string::npos) return -1;  // a pattern of a folder of this machine
    const MemoryFile file(text);
    read_or_refuse([&] {
        if (is_suite(file.path())) {
            const Suite suite = read_suite(file.path(), {});
            ensure(suite.options.alpha > 0 && suite.options.alpha < 1, "a level is a probability");
        }
    });
    read_or_refuse([&] { (void)plan_of({}, file.path()); });
    return 0;
}
