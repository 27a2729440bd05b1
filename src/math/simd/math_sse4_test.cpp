// The functions of simd/math.h on sse4; tests/CMakeLists.txt has the flags.
#define CRESCENT_ISA sse4
#include "math/simd/pack.h"
// clang-format off
#include "tests/support/math_table.h"

namespace crescent::test {

MathTable sse4_math() { return math_table<sse4::Pack>(); }

}  // namespace crescent::test
