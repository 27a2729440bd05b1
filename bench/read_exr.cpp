// crescent_read_exr FILE...: reads R, G and B of each file with OpenEXR alone, on as many threads as there are
// processors, and prints the seconds. bench/suite_speed.py compares `crescent compare` with it.
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfThreading.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <thread>
#include <vector>

namespace {

void read_file(const char* path) {
    Imf::InputFile file(path);
    const Imath::Box2i window = file.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1),
               height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
    std::array<std::vector<float>, 3> planes;
    constexpr std::array<const char*, 3> channels{"R", "G", "B"};
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < planes.size(); ++c) {
        planes[c].resize(width * height);
        buffer.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), window));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        const auto start = std::chrono::steady_clock::now();
        for (int k = 1; k < argc; ++k) read_file(argv[k]);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        std::printf("%.3f\n", seconds.count());
    } catch (const std::exception& e) {
        std::fprintf(stderr, "crescent_read_exr: %s\n", e.what());
        return 3;
    }
    return 0;
}
