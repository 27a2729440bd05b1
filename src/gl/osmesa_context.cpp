// OSMesa: Mesa's renderer on the CPU, without EGL or a driver. Core 3.3 is requested; Mesa returns the highest version
// that is compatible with it.
#include "osmesa_context.h"

// Mesa removed it in 25.1.
#if __has_include(<GL/osmesa.h>)

// osmesa.h includes the old gl.h; glcorearb.h has declared all that it uses.
#define __gl_h_
#define GLAPIENTRY APIENTRY
#include <GL/osmesa.h>

namespace crescent::gl {

namespace {

class OsMesa : public Context {
public:
    OsMesa() : library_("libOSMesa.so.8", "--gl-context osmesa", "libosmesa6 and libgl1-mesa-dri") {
        make_current_ = library_.function<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent");
        current_ = library_.function<decltype(OSMesaGetCurrentContext)>("OSMesaGetCurrentContext");
        destroy_ = library_.function<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext");
        const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_CORE_PROFILE,
            OSMESA_CONTEXT_MAJOR_VERSION, 3, OSMESA_CONTEXT_MINOR_VERSION, 3, 0};
        context_ =
            library_.function<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs")(attributes, nullptr);
        if (!context_) throw OutputError("OSMesa makes no core 3.3 context");
        make_current();
        const auto address = library_.function<decltype(OSMesaGetProcAddress)>("OSMesaGetProcAddress");
        take_functions([address](const char* name) { return reinterpret_cast<void*>(address(name)); });
    }
    ~OsMesa() override {
        if (context_) destroy_(context_);
    }

    std::string kind() const override { return "OSMesa"; }
    void make_current() override {
        if (make_current_(context_, window_, GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE)
            throw OutputError("the OSMesa context cannot be made current" + log_.text());
    }
    void release() override { make_current_(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
    bool is_current() const override { return context_ && current_() == context_; }

private:
    Library library_;
    decltype(OSMesaMakeCurrent)* make_current_ = nullptr;
    decltype(OSMesaGetCurrentContext)* current_ = nullptr;
    decltype(OSMesaDestroyContext)* destroy_ = nullptr;
    OSMesaContext context_ = nullptr;
    unsigned char window_[4] = {};  // never drawn to: films have framebuffers of their own
};

}  // namespace

std::unique_ptr<Context> open_osmesa() { return std::make_unique<OsMesa>(); }

}  // namespace crescent::gl

#else

namespace crescent::gl {

std::unique_ptr<Context> open_osmesa() {
    throw OutputError("--gl-context osmesa: this build was made without the header GL/osmesa.h (libosmesa6-dev)");
}

}  // namespace crescent::gl

#endif
