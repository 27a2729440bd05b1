// What the child process writes is checked before memory is taken for it.
#include "images/stored_image.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <string_view>

#include "base/host_program.h"
#include "base/process.h"
#include "base/text.h"

namespace crescent {

// ---- The child process.

namespace {

/// What a child process writes, up to its end.
class HostOutput {
public:
    explicit HostOutput(const OpenFile& file)
        : file_(file),
          process_({.argv = {image_host_name},
              .file = host_program(),
              .stdin_file = "/dev/null",
              .label = "the reader of images",
              .shared = file.descriptor()}) {}

    void read(void* to, std::size_t bytes) {
        for (std::size_t count = 0; count < bytes;) {
            constexpr int patience = 200;  // milliseconds between two looks at the process
            process_.wait_ready(false, true, patience);
            const ssize_t n = process_.read(static_cast<char*>(to) + count, bytes - count);
            if (n > 0) count += static_cast<std::size_t>(n);
            else if (n == 0) refuse();
        }
    }

private:
    [[noreturn]] void refuse() {
        constexpr int closing = 2000;  // milliseconds, for a program that closed its output
        const std::optional<ProcessEnd> end = process_.ended(closing);
        file_.fail(
            fmt::format("expected a picture that can be read: the process that reads it ended with {} (limits: "
                        "{} MiB of memory, {} s)",
                end ? end->text() : "no answer", image_host_memory >> 20, image_host_seconds));
    }
    const OpenFile& file_;
    Process process_;
};

}  // namespace

StoredImage decoded(const OpenFile& file) {
    HostOutput host(file);
    StoredImage out;
    ImageHead& head = out.head;
    host.read(&head, sizeof head);
    if (head.bytes == 0) {
        constexpr std::size_t longest = 200;
        std::string message(std::min<std::size_t>(head.width, longest), '\0');
        host.read(message.data(), message.size());
        file.fail("expected a picture that can be read: " + printable(message));
    }
    const bool has_valid_head = head.width >= 1 && head.width <= most_pixels_a_side && head.height >= 1 &&
        head.height <= most_pixels_a_side && head.channels >= 1 && head.channels <= 4 &&
        (head.bytes == 1 || head.bytes == 2 || head.bytes == 4);
    const std::uint64_t bytes = std::uint64_t{head.width} * head.height * head.channels * head.bytes;
    if (!has_valid_head || bytes > image_host_memory)
        file.fail(fmt::format("expected a picture of 1 to {} pixels a side", most_pixels_a_side));
    out.samples.resize(bytes);
    host.read(out.samples.data(), out.samples.size());
    return out;
}

// ---- The header of Radiance HDR.

namespace {

/// Returns exactly n numbers from the text after "KEY=".
template <std::size_t n>
std::array<double, n> numbers_of(const TextHeader& in, std::string_view text, const char* what) {
    std::array<double, n> out{};
    const std::vector<std::string_view> words = split_words(text);
    bool is_good = words.size() == n;
    for (std::size_t i = 0; is_good && i < n; ++i) is_good = parse_number(words[i], out[i]) && std::isfinite(out[i]);
    if (!is_good) in.fail(fmt::format("expected {}", what));
    return out;
}

void read_variable(TextHeader& in, std::string_view line, const ArePrimaries& are_primaries, HdrHeader& out) {
    const std::size_t equals = line.find('=');
    const std::string_view key = line.substr(0, equals);
    const std::string_view value = equals == std::string_view::npos ? "" : line.substr(equals + 1);
    if (key == "FORMAT") {
        const std::vector<std::string_view> words = split_words(value);
        const std::string_view format = words.size() == 1 ? words[0] : "";
        if (format == "32-bit_rle_xyze") in.fail("expected FORMAT=32-bit_rle_rgbe, found XYZE, which is not read");
        if (format != "32-bit_rle_rgbe") in.fail("expected FORMAT=32-bit_rle_rgbe");
    } else if (key == "EXPOSURE") {
        const double exposure = numbers_of<1>(in, value, "EXPOSURE= and a number above 0")[0];
        if (!(exposure > 0)) in.fail("expected EXPOSURE= and a number above 0");
        for (double& unit : out.unit) unit /= exposure;
    } else if (key == "COLORCORR") {
        const auto factors = numbers_of<3>(in, value, "COLORCORR= and three numbers above 0");
        for (std::size_t c = 0; c < 3; ++c) {
            if (!(factors[c] > 0)) in.fail("expected COLORCORR= and three numbers above 0");
            out.unit[c] /= factors[c];
        }
    } else if (key == "PRIMARIES") {
        const auto p = numbers_of<8>(in, value, "PRIMARIES= and eight numbers");
        out.primaries = p;
        if (!are_primaries(p)) in.fail("expected PRIMARIES= of three colours and a white point");
    }
}

}  // namespace

HdrHeader hdr_header(const OpenFile& file, const ArePrimaries& are_primaries) {
    TextHeader in(file);
    HdrHeader out;
    for (std::string_view line = in.line(); !split_words(line).empty(); line = in.line())
        read_variable(in, line, are_primaries, out);
    const std::vector<std::string_view> size = split_words(in.line());
    const bool is_understood = size.size() == 4 && size[0] == "-Y" && size[2] == "+X" &&
        parse_number(size[1], out.height) && parse_number(size[3], out.width);
    if (!is_understood) in.fail("expected a resolution with rows from the top, such as '-Y 540 +X 960'");
    in.check_size(out.width, out.height);
    for (const double unit : out.unit)
        if (!(unit > 0 && std::isfinite(unit))) in.fail("expected an EXPOSURE and a COLORCORR that a float can hold");
    file.expect_bytes(in.end(), std::uint64_t{4} * static_cast<std::uint64_t>(out.height),
        fmt::format("the header promises {} scanlines", out.height));
    return out;
}

}  // namespace crescent
