// Slices point into the film's planes, with a negative stride from the last row to the first, so nothing is copied.
// Nothing is compressed. OpenEXR's number of threads is global to the process and is set under a lock while a file is
// written.
#include "render/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include "base/errors.h"
#include "base/parallel.h"

namespace crescent::inline render {

namespace {

struct Channel {
    const char* name;
    Imf::PixelType type;
    const void* plane;
};

std::vector<Channel> channels_of(const Film& f) {
    return {{"R", Imf::FLOAT, f.r.data()}, {"G", Imf::FLOAT, f.g.data()}, {"B", Imf::FLOAT, f.b.data()},
        {"luminance.Y", Imf::FLOAT, f.y.data()}, {"second_moment.Y", Imf::FLOAT, f.second_moment.data()},
        {"variance.Y", Imf::FLOAT, f.var.data()}, {"largest.Y", Imf::FLOAT, f.largest.data()},
        {"horizon.Y", Imf::UINT, f.horizon.data()}, {"hits.Y", Imf::UINT, f.light_hits.data()}};
}

std::vector<Channel> channels_of(const ReferenceFilm& f) {
    return {{"R", Imf::FLOAT, f.r.data()}, {"G", Imf::FLOAT, f.g.data()}, {"B", Imf::FLOAT, f.b.data()},
        {"luminance.Y", Imf::FLOAT, f.y.data()}, {"error.Y", Imf::FLOAT, f.error.data()}};
}

template <class AnyFilm>
Imf::Header header_of(const std::string& name, const AnyFilm& film, const Attributes& attributes) {
    Imf::Header header(film.width, film.height);
    header.compression() = Imf::NO_COMPRESSION;  // noise is hardly compressible
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const Channel& c : channels_of(film)) header.channels().insert(c.name, Imf::Channel(c.type));
    for (const auto& [key, text] : attributes) header.insert(key, Imf::StringAttribute(text));
    return header;
}

/// Films are stored bottom-up and the file top-down, so the last row comes first and strides are negative.
template <class AnyFilm> Imf::FrameBuffer frame_buffer(const AnyFilm& film) {
    Imf::FrameBuffer buffer;
    const auto row = static_cast<std::ptrdiff_t>(film.width) * 4;
    for (const Channel& c : channels_of(film)) {
        char* top = static_cast<char*>(const_cast<void*>(c.plane)) + row * (film.height - 1);
        buffer.insert(c.name, Imf::Slice(c.type, top, 4, static_cast<std::size_t>(-row)));
    }
    return buffer;
}

/// OpenEXR reads and writes on its own threads, one set per process. Sets their number to that of on_threads() while
/// one file is written, then restores it.
class ExrThreads {
public:
    ExrThreads() : guard_(lock()), before_(Imf::globalThreadCount()) {
        Imf::setGlobalThreadCount(threads_here() > 1 ? threads_here() : 0);  // 0: this thread alone
    }
    ~ExrThreads() { Imf::setGlobalThreadCount(before_); }
    ExrThreads(const ExrThreads&) = delete;
    ExrThreads& operator=(const ExrThreads&) = delete;

private:
    static Mutex& lock() {
        static Mutex all;
        return all;
    }
    Guard guard_;
    int before_;
};

template <class AnyFilm> void write_parts(const std::string& path,
    const std::vector<std::pair<std::string, const AnyFilm*>>& parts, const Attributes& attributes) {
    const ExrThreads threads;
    std::vector<Imf::Header> headers;
    for (const auto& [name, film] : parts) headers.push_back(header_of(name, *film, attributes));
    try {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
        for (std::size_t k = 0; k < parts.size(); ++k) {
            Imf::OutputPart part(file, static_cast<int>(k));
            part.setFrameBuffer(frame_buffer(*parts[k].second));
            part.writePixels(parts[k].second->height);
        }
    } catch (const std::exception& error) { throw OutputError("cannot write " + path + ": " + error.what()); }
}

}  // namespace

void write_exr(const std::string& path, const std::vector<std::pair<std::string, const Film*>>& parts,
    const Attributes& attributes) {
    write_parts(path, parts, attributes);
}

void write_exr(const std::string& path, const std::vector<std::pair<std::string, const ReferenceFilm*>>& parts,
    const Attributes& attributes) {
    write_parts(path, parts, attributes);
}

}  // namespace crescent::inline render
