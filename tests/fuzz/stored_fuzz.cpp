// Any text as what `crescent report` reads, the JSON of a check, a comparison or a run: it becomes a page, or is
// rejected with an InputError that has a message.
#include <cstdint>
#include <string>

#include "check/report/html.h"
#include "check/report/result_json.h"
#include "compare/page.h"
#include "memory_file.h"
#include "output/stored_json.h"
#include "run/stored_run.h"
#include "run/write.h"

namespace {

using namespace crescent;

void make_page(const std::string& text) {
    const Json json = parse_json(text, "fuzz.json", "a stored result");
    const std::string format = StoredJson(json).at("format").get<std::string>();
    if (format.starts_with("crescent check ")) {
        const StoredResult stored = result_from_json(json, "fuzz.json");
        (void)verdict_html(stored.result, stored.source);
    } else if (format.starts_with("crescent comparison ")) {
        (void)compare_html(json, {});
    } else {
        (void)report_html(report_inputs(open_run(json, "fuzz/fuzz.json").measured));
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        read_or_refuse([&] { make_page(text); });
    } catch (const StoredJsonError&) {  // the program adds the name of the file
    } catch (const Json::exception&) {}
    return 0;
}
