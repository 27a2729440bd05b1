// EGL without a surface: the devices of EGL_EXT_device_enumeration, a GPU's driver first, llvmpipe otherwise. Core 4.5
// is requested, then 3.3.
#include "egl_context.h"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <fmt/format.h>

#include <tuple>

#include "context.h"

namespace crescent::gl {

namespace {

/// libEGL with its messages; one per process.
struct Egl {
    Library library{"libEGL.so.1", "--instrument gl", "libegl1, libegl-mesa0 and libgl1-mesa-dri"};
    DriverLog log;
    decltype(eglGetProcAddress)* address = library.function<decltype(eglGetProcAddress)>("eglGetProcAddress");
    decltype(eglQueryString)* query = library.function<decltype(eglQueryString)>("eglQueryString");
    decltype(eglGetError)* error = library.function<decltype(eglGetError)>("eglGetError");
    decltype(eglInitialize)* initialize = library.function<decltype(eglInitialize)>("eglInitialize");
    decltype(eglBindAPI)* bind_api = library.function<decltype(eglBindAPI)>("eglBindAPI");
    decltype(eglCreateContext)* create = library.function<decltype(eglCreateContext)>("eglCreateContext");
    decltype(eglDestroyContext)* destroy = library.function<decltype(eglDestroyContext)>("eglDestroyContext");
    decltype(eglMakeCurrent)* make_current = library.function<decltype(eglMakeCurrent)>("eglMakeCurrent");
    decltype(eglGetCurrentContext)* current = library.function<decltype(eglGetCurrentContext)>("eglGetCurrentContext");
    PFNEGLGETPLATFORMDISPLAYEXTPROC display = extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    PFNEGLQUERYDEVICESEXTPROC devices = extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    PFNEGLQUERYDEVICESTRINGEXTPROC device_string = extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");

    Egl() {
        if (const auto control = extension<PFNEGLDEBUGMESSAGECONTROLKHRPROC>("eglDebugMessageControlKHR"))
            control(keep, nullptr);
    }
    template <class Function> Function extension(const char* name) const {
        return reinterpret_cast<Function>(address(name));
    }
    static Egl& get() {
        static Egl& egl = *new Egl;  // a driver's threads may use it until the process ends
        return egl;
    }
    static void EGLAPIENTRY keep(
        EGLenum error, const char* command, EGLint, EGLLabelKHR, EGLLabelKHR, const char* message) {
        get().log.add(fmt::format(
            "{}: {} (EGL error 0x{:x})", command ? command : "EGL", message ? message : "no message", error));
    }

    std::vector<EGLDeviceEXT> all_devices() const {
        EGLint count = 0;
        if (!devices || !display || !devices(0, nullptr, &count) || count <= 0) return {};
        std::vector<EGLDeviceEXT> list(static_cast<std::size_t>(count));
        devices(count, list.data(), &count);
        list.resize(static_cast<std::size_t>(count));
        return list;
    }
    bool is_software(EGLDeviceEXT device) const {
        const char* words = device_string ? device_string(device, EGL_EXTENSIONS) : nullptr;
        return words && std::string_view(words).find("EGL_MESA_device_software") != std::string_view::npos;
    }
};

bool has(const char* words, std::string_view word) {
    return words && std::string_view(words).find(word) != std::string_view::npos;
}

class EglContext : public Context {
public:
    EglContext(EGLDeviceEXT device, int number) : number_(number) {
        Egl& egl = Egl::get();
        display_ = device ? egl.display(EGL_PLATFORM_DEVICE_EXT, device, nullptr)
                          : egl.display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
        if (display_ == EGL_NO_DISPLAY || !egl.initialize(display_, nullptr, nullptr)) fail("gives no display");
        const char* extensions = egl.query(display_, EGL_EXTENSIONS);
        if (!has(extensions, "EGL_KHR_surfaceless_context") || !has(extensions, "EGL_KHR_no_config_context"))
            fail("cannot draw without a surface");
        if (!egl.bind_api(EGL_OPENGL_API)) fail("has no OpenGL");
        for (const auto& [major, minor, robust] : {std::tuple{4, 5, true}, {4, 5, false}, {3, 3, false}})
            if (context_ == EGL_NO_CONTEXT) context_ = create(major, minor, robust);
        if (context_ == EGL_NO_CONTEXT) fail("makes no core 4.5 and no core 3.3 context");
        make_current();
        take_functions([&egl](const char* name) { return reinterpret_cast<void*>(egl.address(name)); });
    }
    ~EglContext() override {
        if (is_current()) release();
        if (context_ != EGL_NO_CONTEXT) Egl::get().destroy(display_, context_);
    }

    std::string kind() const override {
        return number_ < 0 ? "EGL surfaceless" : fmt::format("EGL surfaceless, device {}", number_);
    }
    void make_current() override {
        if (!Egl::get().make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            fail("does not make its context current");
    }
    void release() override { Egl::get().make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    bool is_current() const override { return context_ != EGL_NO_CONTEXT && Egl::get().current() == context_; }

private:
    /// Robust: a context that the driver had to reset reports it.
    EGLContext create(EGLint major, EGLint minor, bool robust) const {
        std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION, minor,
            EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
        if (robust)
            attributes.insert(
                attributes.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
        attributes.push_back(EGL_NONE);
        return Egl::get().create(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    }
    [[noreturn]] void fail(const char* what) const {
        const Egl& egl = Egl::get();
        throw OutputError(
            fmt::format("no GL context: {} {} (EGL error 0x{:x}){}", kind(), what, egl.error(), egl.log.text()));
    }

    int number_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

std::unique_ptr<Context> open_device(const std::vector<EGLDeviceEXT>& devices, int number) {
    return std::make_unique<EglContext>(devices[static_cast<std::size_t>(number)], number);
}

/// Opens the first GPU whose driver works, else the first software device, else the default of the surfaceless
/// platform.
std::unique_ptr<Context> open_best(const std::vector<EGLDeviceEXT>& devices) {
    std::string why;
    for (const bool software : {false, true}) {
        for (std::size_t k = 0; k < devices.size(); ++k) {
            if (Egl::get().is_software(devices[k]) != software) continue;
            try {
                return open_device(devices, static_cast<int>(k));
            } catch (const OutputError& e) { why += std::string(why.empty() ? "" : "\n") + e.what(); }
        }
    }
    if (!why.empty()) throw OutputError(why);
    if (!has(Egl::get().query(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless") || !Egl::get().display)
        throw OutputError(
            "no GL context: libEGL.so.1 knows no device and no surfaceless platform; is a driver (libegl-mesa0) "
            "installed?" +
            Egl::get().log.text());
    return std::make_unique<EglContext>(nullptr, -1);
}

}  // namespace

std::unique_ptr<Context> open_egl(int device) {
    const std::vector<EGLDeviceEXT> devices = Egl::get().all_devices();
    if (device < 0) return open_best(devices);
    if (devices.empty()) throw OutputError("no GL context: libEGL.so.1 lists no device" + Egl::get().log.text());
    if (static_cast<std::size_t>(device) >= devices.size())
        throw InputError({"--gl-device", 0, 0},
            fmt::format(
                "expected a number from 0 to {} (`crescent list devices`), not {}", devices.size() - 1, device));
    return open_device(devices, device);
}

std::vector<BackendDevice> egl_devices() {
    std::vector<BackendDevice> out;
    try {
        const std::vector<EGLDeviceEXT> devices = Egl::get().all_devices();
        for (std::size_t k = 0; k < devices.size(); ++k) {
            const int number = static_cast<int>(k);
            try {
                const std::unique_ptr<Context> context = open_device(devices, number);
                out.push_back({number, context->renderer() + ", GL " + context->version()});
            } catch (const OutputError& e) {
                const std::string why = e.what();
                out.push_back({number, "not usable: " + why.substr(0, why.find('\n'))});
            }
        }
    } catch (const OutputError&) {  // no EGL, so no devices
    }
    return out;
}

}  // namespace crescent::gl
