// The entry points of OpenGL that this folder calls, as pointers: the driver's library is opened on demand, so that the
// program runs on machines without one. Core 3.3 except for the last lines, which are null if a driver lacks them.
#pragma once

#include <GL/glcorearb.h>
#include <functional>
#include <string>

namespace crescent::gl {

// ---- A shared library that is opened when it is needed and stays open until the process ends, because drivers leave
// threads and handlers behind that need their code.

class Library {
public:
    /// Throws OutputError with the loader's own words; `needed_for` says what goes without it, `packages` what has it.
    Library(const std::string& file, const std::string& needed_for, const std::string& packages);
    /// Null where the library has no such name.
    void* address_of(const char* name) const;
    /// The same as a function; throws OutputError if it is missing.
    template <class Function> Function* function(const char* name) const {
        return reinterpret_cast<Function*>(required(name));
    }

private:
    void* required(const char* name) const;
    std::string file_;
    void* handle_ = nullptr;
};

// clang-format off
#define CRESCENT_GL_CORE(X) \
    X(ACTIVETEXTURE, ActiveTexture) X(ATTACHSHADER, AttachShader) X(BINDFRAMEBUFFER, BindFramebuffer) \
    X(BINDTEXTURE, BindTexture) X(BINDVERTEXARRAY, BindVertexArray) \
    X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(COMPILESHADER, CompileShader) \
    X(CREATEPROGRAM, CreateProgram) X(CREATESHADER, CreateShader) X(DELETEFRAMEBUFFERS, DeleteFramebuffers) \
    X(DELETEPROGRAM, DeleteProgram) X(DELETESHADER, DeleteShader) X(DELETETEXTURES, DeleteTextures) \
    X(DELETEVERTEXARRAYS, DeleteVertexArrays) X(DISABLE, Disable) X(DRAWARRAYS, DrawArrays) \
    X(DRAWBUFFERS, DrawBuffers) X(ENABLE, Enable) X(FINISH, Finish) X(FRAMEBUFFERTEXTURE, FramebufferTexture) \
    X(GENFRAMEBUFFERS, GenFramebuffers) X(GENTEXTURES, GenTextures) X(GENVERTEXARRAYS, GenVertexArrays) \
    X(GETERROR, GetError) X(GETFRAMEBUFFERATTACHMENTPARAMETERIV, GetFramebufferAttachmentParameteriv) \
    X(GETINTEGERV, GetIntegerv) X(GETPROGRAMINFOLOG, GetProgramInfoLog) X(GETPROGRAMIV, GetProgramiv) \
    X(GETSHADERINFOLOG, GetShaderInfoLog) X(GETSHADERIV, GetShaderiv) X(GETSTRING, GetString) \
    X(GETUNIFORMLOCATION, GetUniformLocation) X(ISENABLED, IsEnabled) X(LINKPROGRAM, LinkProgram) \
    X(PIXELSTOREI, PixelStorei) X(READBUFFER, ReadBuffer) X(READPIXELS, ReadPixels) X(SCISSOR, Scissor) \
    X(SHADERSOURCE, ShaderSource) X(TEXIMAGE2D, TexImage2D) X(TEXIMAGE3D, TexImage3D) \
    X(TEXPARAMETERI, TexParameteri) X(TEXSUBIMAGE3D, TexSubImage3D) X(UNIFORM1I, Uniform1i) \
    X(UNIFORM1UI, Uniform1ui) X(UNIFORM2I, Uniform2i) X(UNIFORM3FV, Uniform3fv) X(UNIFORM4FV, Uniform4fv) \
    X(USEPROGRAM, UseProgram) X(VIEWPORT, Viewport)
#define CRESCENT_GL_LATER(X) \
    X(DEBUGMESSAGECALLBACK, DebugMessageCallback) X(GETGRAPHICSRESETSTATUS, GetGraphicsResetStatus)
// clang-format on

struct Functions {
#define CRESCENT_GL_MEMBER(TYPE, name) PFNGL##TYPE##PROC name = nullptr;
    CRESCENT_GL_CORE(CRESCENT_GL_MEMBER)
    CRESCENT_GL_LATER(CRESCENT_GL_MEMBER)
#undef CRESCENT_GL_MEMBER
};

/// Looks up every name; throws OutputError with the first missing one of core 3.3.
Functions functions_from(const std::function<void*(const char*)>& address_of);

}  // namespace crescent::gl
