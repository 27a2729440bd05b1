/* The cosine sampler, and what a plugin may do to its process: `-D ON_LOAD=...` when it is loaded, `-D ON_CALL=...` in
 * every call of crescent_sampler_sample, `-D PDF=...` in place of cos / pi, `-D LENGTH=...` of the direction, `-D NAME_BYTES=...` of its name. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <fcntl.h>
#include <fenv.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __SSE__
#include <immintrin.h>
#endif

#include "check/sampler_plugin.h"

#ifndef ON_LOAD
#define ON_LOAD
#endif
#ifndef ON_CALL
#define ON_CALL
#endif
#ifndef PDF
#define PDF cos_theta / pi
#endif
#ifndef LENGTH
#define LENGTH 1
#endif

static const double pi = 3.14159265358979323846;

/* What the hooks use. */
static void* sleep_for_ever(void* nothing) {
    for (;;) usleep(1000);
    return nothing;
}
static inline void start_thread(void) {
    static pthread_t thread;
    if (!thread) pthread_create(&thread, NULL, sleep_for_ever, NULL);
}
static inline void leave_a_child(void) {
    static pid_t child;
    if (!child && (child = fork()) == 0) {
        setsid();
        sleep(6);
        _exit(0);
    }
}
static inline void fork_and_go_on(void) {
    static pid_t child;
    if (!child) child = fork();
}
static inline void flush_to_zero(void) {
    fesetround(FE_UPWARD);
#ifdef __SSE__
    _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}
static inline void write_junk(const char* text) {
    printf("%s\n", text);
    fflush(stdout);
}

__attribute__((constructor)) static void on_load(void) { ON_LOAD; }

unsigned crescent_sampler_abi(void) { return CRESCENT_SAMPLER_ABI; }

#ifdef NAME_BYTES
const char* crescent_sampler_name(void) {
    static char name[NAME_BYTES + 1];
    memset(name, 'a', NAME_BYTES);
    return name;
}
#endif

int crescent_sampler_sample(
    size_t count, const double* wo, const double* u, const double* surface, double* wi, double* pdf) {
    (void)wo, (void)surface;
    ON_CALL;
    for (size_t i = 0; i < count; ++i) {
        const double cos_theta = sqrt(u[2 * i]), sin_theta = sqrt(1 - u[2 * i]), phi = 2 * pi * u[2 * i + 1];
        wi[3 * i] = (LENGTH)*sin_theta * cos(phi), wi[3 * i + 1] = (LENGTH)*sin_theta * sin(phi);
        wi[3 * i + 2] = (LENGTH)*cos_theta;
        pdf[i] = PDF;
    }
    return 0;
}

int crescent_sampler_pdf(size_t count, const double* wo, const double* wi, const double* surface, double* pdf) {
    (void)wo, (void)surface;
    for (size_t i = 0; i < count; ++i) pdf[i] = wi[3 * i + 2] > 0 ? wi[3 * i + 2] / pi : 0;
    return 0;
}
