// Whether this is compiled for a sanitizer that reserves addresses without memory, replaces functions of the system and
// takes about ten times as long: address, thread or memory. g++ has macros, clang had only __has_feature() until 20.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CRESCENT_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define CRESCENT_SANITIZED 1
#endif
#endif
#ifndef CRESCENT_SANITIZED
#define CRESCENT_SANITIZED 0
#endif
