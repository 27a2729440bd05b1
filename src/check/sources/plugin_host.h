// The process that a plugin runs in, and what it and crescent say to each other over two pipes.
//
// The host begins with one line: "crescent-plugin 1", then "error TEXT", or KEY=VALUE words and at last name=NAME:
//   numbers=N     random numbers of a sample
//   pdf=0|1 f=0|1 whether the plugin has these functions
//   serial=0|1    whether it is to be called by one host at a time
//   columns=A,B   the quantities of a surface point that it needs, in this order, each one or more doubles
// Then it answers requests. Rows come in runs that share the columns; the rows themselves are in shared memory, which
// the host has as descriptor 3:
//   request  PluginRequest, and of each run how many rows it has (as a double) and its columns
//   answer   PluginAnswer; 0 rows: an error, whose text follows
// A version of the interface that needs other quantities names them in its columns.
#pragma once

#include <cstddef>
#include <cstdint>

namespace crescent::inline sources {

inline constexpr const char* plugin_handshake = "crescent-plugin 1 ";
inline constexpr const char* plugin_columns = "wo,s,alpha,rho_d,rho_s";

struct PluginRequest {
    char operation;  // 's'ample, 'p'df, 'f'
    std::uint32_t runs, rows;
};
struct PluginAnswer {
    std::uint32_t rows, bytes;  // bytes of the text, where there is no row
};

/// The most rows of a request.
inline constexpr std::uint32_t plugin_rows = 65536;

/// The rows of a request and its answer in shared memory, one array after another.
struct PluginRows {
    static constexpr std::size_t bytes = plugin_rows * sizeof(double) * (8 + 3 + 1);
    double *given, *wi, *values;  // `width` random numbers or a direction a row; of a sample wi and pdf, else a value
    PluginRows(void* memory, std::size_t rows, std::size_t width)
        : given(static_cast<double*>(memory)), wi(given + rows * width), values(wi + 3 * rows) {}
};

/// argv[0] of a process that is a host: a program which this code is a part of, executed under this name with the
/// plugin's file as argument, serves the plugin before main() and ends. Not inline: who names it links the host.
extern const char* const plugin_host_name;

/// The same as a function: serves the library over stdin and stdout until the input ends.
[[noreturn]] void serve_plugin(const char* library);

}  // namespace crescent::inline sources
