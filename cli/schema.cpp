// crescent schema and crescent version: what the program says of its input and of itself.
#include "commands.h"
#include "crescent.h"

namespace crescent::cli {

int schema(const SchemaFlags& flags) {
    print(flags.json ? schema_json() : schema_text());
    return held;
}

int version(const VersionFlags&) {
    print("crescent " + crescent::version() + " (" + commit() + ", " + compiler() + ")\n");
    return held;
}

}  // namespace crescent::cli
