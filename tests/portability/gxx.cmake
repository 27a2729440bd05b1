# A second compiler, whose films must equal those of clang.
set(CMAKE_CXX_COMPILER g++)
