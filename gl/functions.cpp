// The lists' macros make a look-up of "gl" + name for each entry point, then a test of each name of core 3.3.
#include "functions.h"

#include "crescent.h"

namespace crescent::gl {

Functions functions_from(const std::function<void*(const char*)>& address_of) {
    Functions f;
#define CRESCENT_GL_LOOK_UP(TYPE, name) f.name = reinterpret_cast<PFNGL##TYPE##PROC>(address_of("gl" #name));
    CRESCENT_GL_CORE(CRESCENT_GL_LOOK_UP)
    CRESCENT_GL_LATER(CRESCENT_GL_LOOK_UP)
#undef CRESCENT_GL_LOOK_UP
#define CRESCENT_GL_REQUIRE(TYPE, name) \
    if (!f.name) throw OutputError("the GL driver has no gl" #name ", which core 3.3 asks for");
    CRESCENT_GL_CORE(CRESCENT_GL_REQUIRE)
#undef CRESCENT_GL_REQUIRE
    return f;
}

}  // namespace crescent::gl
