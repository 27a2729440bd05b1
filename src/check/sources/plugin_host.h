// The process that runs a plugin, and its protocol with crescent over two pipes.
//
// The host begins with one line: "crescent-plugin 2", then "error TEXT", or KEY=VALUE words and at last name=NAME:
//   numbers=N     random numbers of a sample
//   pdf=0|1 f=0|1 whether the plugin has these functions
//   serial=0|1    whether it is to be called by one host at a time
//   uses=A,B      the result of crescent_sampler_uses(); absent: s, alpha, the luminance of rho_d, rho_s
// Then it answers requests. Rows are in runs that share the columns; the rows themselves are in shared memory, which is
// descriptor 3 of the host:
//   request  PluginRequest, and for each run its number of rows (as a double), w_o and the columns of the surface
//   answer   PluginAnswer; 0 rows: an error, followed by its text
#pragma once

#include <cstddef>
#include <cstdint>

namespace crescent {

inline constexpr const char* plugin_handshake = "crescent-plugin 2 ";

struct PluginRequest {
    char operation;                     // 's'ample, 'p'df, 'f'
    std::uint32_t runs, rows, columns;  // columns: doubles of the surface of a run
};
struct PluginAnswer {
    std::uint32_t rows, bytes;  // bytes of the text, if there are no rows
};

/// The largest number of rows of a request.
inline constexpr std::uint32_t plugin_rows = 65536;

/// The rows of a request and its answer in shared memory, one array after another.
struct PluginRows {
    static constexpr std::size_t bytes = plugin_rows * sizeof(double) * (8 + 3 + 1);
    double *input, *wi,
        *values;  // `width` random numbers or a direction for each row; for a sample wi and pdf, otherwise a value
    PluginRows(void* memory, std::size_t rows, std::size_t width)
        : input(static_cast<double*>(memory)), wi(input + rows * width), values(wi + 3 * rows) {}
};

/// argv[0] of a host process: a program that contains this code, executed under this name with the plugin's file as
/// argument, serves the plugin before main() and exits. Not inline: a use of this name links the host.
extern const char* const plugin_host_name;

/// The same as a function: serves the library over stdin and stdout until the input ends.
[[noreturn]] void serve_plugin(const char* library);

}  // namespace crescent
