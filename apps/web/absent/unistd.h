// wasi-libc has no pipes; nothing that is linked asks for one.
#pragma once
#include_next <unistd.h>

extern "C" int pipe(int ends[2]);
