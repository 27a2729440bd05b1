// The functions of simd/math.h on sse4; the flags stand in laws/CMakeLists.txt.
#define CRESCENT_ISA sse4
#include "simd/pack.h"
// clang-format off
#include "simd/math_table_test.h"

namespace crescent::test {

MathTable sse4_math() { return math_table<sse4::Pack>(); }

}  // namespace crescent::test
