# The second compiler of this machine; its films must equal those of clang.
set(CMAKE_CXX_COMPILER g++)
