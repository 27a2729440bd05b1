// Looks the word up among the kinds of instrument that registered themselves and opens the one it finds with the two
// --gl flags, which the CPU refuses.
#include "instruments.h"

namespace crescent::cli {

namespace {

void only_with_gl(const char* flag, bool given) {
    if (given) throw InputError({flag, 0, 0}, "expected together with --instrument gl");
}

}  // namespace

std::shared_ptr<Instrument> instrument(const RunFlags& flags) {
    if (flags.instrument == "cpu") {
        only_with_gl("--gl-context", !flags.gl_context.empty());
        only_with_gl("--gl-device", flags.gl_device >= 0);
        return nullptr;
    }
    const std::shared_ptr<const InstrumentKind> kind = find_instrument(flags.instrument);
    if (!kind)
        throw OutputError("this build has no instrument '" + flags.instrument +
            "': it was made without it, or without the headers of EGL");
    return kind->open({flags.gl_context, flags.gl_device});
}

}  // namespace crescent::cli
