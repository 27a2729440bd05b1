# Without optimisation, on plain floats and the first vector instruction set.
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_BUILD_TYPE Debug)
set(CRESCENT_SCALAR ON)
