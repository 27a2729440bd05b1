// stb_image (github.com/nothings/stb) over pread(). Calls no other code of crescent, so that it is also part of a small
// program.
#include "images/image_host.h"

#include <sys/resource.h>
#include <unistd.h>

#include <math.h>

#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "base/sanitized.h"

namespace {

/// In the place of pow(), whose last bit depends on the machine: for conversions between bytes and floats, which
/// nothing here calls.
[[maybe_unused]] double no_conversion(double, double) { std::abort(); }

}  // namespace
#define pow no_conversion
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_PNG
#define STBI_NO_GIF
#define STBI_NO_PSD
#define STBI_NO_PIC
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>
#undef pow

namespace crescent {

const char* const image_host_name = "crescent-image-host";

namespace {

constexpr int image_descriptor = 3;

void write_all(const void* from, std::size_t bytes) {
    const char* next = static_cast<const char*>(from);
    while (bytes > 0) {
        const ssize_t n = ::write(STDOUT_FILENO, next, bytes);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) ::_exit(1);  // no one reads
        next += n;
        bytes -= static_cast<std::size_t>(n);
    }
}

[[noreturn]] void refuse(const char* message) {
    const ImageHead head{
        .width = static_cast<std::uint32_t>(std::strlen(message)), .height = 0, .channels = 0, .bytes = 0};
    write_all(&head, sizeof head);
    write_all(message, head.width);
    ::_exit(0);
}

/// The file as stb_image reads it. stb_image takes 0 for bytes behind the end, of which a header may promise billions:
/// a file of which it needs such bytes is refused here. It refills a buffer of its own, which is the target of its
/// first read, with as much as there is; every other read is of bytes that it needs.
struct ImageStream {
    bool is_whole = false;  // the pixels are read, not only the kind of the file
    off_t next = 0;
    char* buffer = nullptr;

    static int read(void* user, char* to, int size) {
        ImageStream& in = *static_cast<ImageStream*>(user);
        if (!in.buffer) in.buffer = to;
        int count = 0;
        while (count < size) {
            const ssize_t n =
                ::pread(image_descriptor, to + count, static_cast<std::size_t>(size - count), in.next + count);
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) break;
            count += static_cast<int>(n);
        }
        in.next += count;
        if (in.is_whole && (count == 0 || (count < size && to != in.buffer))) refuse("the file is cut off");
        return count;
    }
    static void skip(void* user, int count) { static_cast<ImageStream*>(user)->next += count; }
    static int at_end(void* user) {
        const auto* in = static_cast<const ImageStream*>(user);
        char byte = 0;
        return ::pread(image_descriptor, &byte, 1, in->next) == 1 ? 0 : 1;
    }
};

constexpr stbi_io_callbacks image_callbacks{ImageStream::read, ImageStream::skip, ImageStream::at_end};

[[noreturn]] void decode_image() {
#if !CRESCENT_SANITIZED  // whose memory is mostly addresses
    const rlimit memory{image_host_memory, image_host_memory};
    ::setrlimit(RLIMIT_AS, &memory);
#endif
    const rlimit seconds{image_host_seconds, image_host_seconds}, none{0, 0};
    ::setrlimit(RLIMIT_CPU, &seconds);
    ::setrlimit(RLIMIT_CORE, &none);
    char first = 0;
    if (::pread(image_descriptor, &first, 1, 0) != 1) refuse("the file is empty");
    ImageStream in;
    const bool is_float = stbi_is_hdr_from_callbacks(&image_callbacks, &in) != 0;
    in = {};
    const bool is_wide = stbi_is_16_bit_from_callbacks(&image_callbacks, &in) != 0;
    in = {.is_whole = true};
    int width = 0, height = 0, channels = 0;
    void* samples = is_float
        ? static_cast<void*>(stbi_loadf_from_callbacks(&image_callbacks, &in, &width, &height, &channels, 0))
        : is_wide
        ? static_cast<void*>(stbi_load_16_from_callbacks(&image_callbacks, &in, &width, &height, &channels, 0))
        : static_cast<void*>(stbi_load_from_callbacks(&image_callbacks, &in, &width, &height, &channels, 0));
    if (!samples) refuse(stbi_failure_reason());
    const ImageHead head{.width = static_cast<std::uint32_t>(width),
        .height = static_cast<std::uint32_t>(height),
        .channels = static_cast<std::uint32_t>(channels),
        .bytes = is_float ? 4u
            : is_wide     ? 2u
                          : 1u};
    const std::size_t count = std::size_t{head.width} * head.height * head.channels;
    if (is_wide && first == 'P' && std::endian::native == std::endian::little) {  // PNM is big-endian, stb_image copies
        auto* words = static_cast<std::uint16_t*>(samples);
        for (std::size_t i = 0; i < count; ++i) words[i] = static_cast<std::uint16_t>(words[i] << 8 | words[i] >> 8);
    }
    write_all(&head, sizeof head);
    write_all(samples, count * head.bytes);
    ::_exit(0);
}

/// Runs before main() and the constructors of the program that contains this code. glibc and macOS pass the arguments.
[[gnu::constructor(101)]] void decode_if_host(int count, char** words) {
    if (count == 1 && std::strcmp(words[0], image_host_name) == 0) decode_image();
}

}  // namespace

}  // namespace crescent
