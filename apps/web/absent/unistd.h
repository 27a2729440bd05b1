// wasi-libc has no pipes; the linked code does not use them.
#pragma once
#include_next <unistd.h>

extern "C" int pipe(int ends[2]);
