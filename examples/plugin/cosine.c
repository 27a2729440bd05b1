/* The cosine-weighted sampler as a shared library:
 *
 *     cc -O2 -shared -fPIC -I PREFIX/include cosine.c -o libcosine.so -lm
 *
 * and in an experiment: [arms.mine] plugin = "libcosine.so". p = cos / pi; Malley's method: a point uniform on the
 * disk, lifted to the hemisphere. */
#include <math.h>

#include "crescent/plugin.h"

static const double pi = 3.14159265358979323846;

unsigned crescent_sampler_abi(void) { return CRESCENT_SAMPLER_ABI; }

const char* crescent_sampler_name(void) { return "cosine in C"; }

int crescent_sampler_sample(
    size_t count, const double* wo, const double* u, const double* surface, double* wi, double* pdf) {
    (void)wo, (void)surface;
    for (size_t i = 0; i < count; ++i) {
        const double cos_theta = sqrt(u[2 * i]), sin_theta = sqrt(1 - u[2 * i]), phi = 2 * pi * u[2 * i + 1];
        wi[3 * i] = sin_theta * cos(phi), wi[3 * i + 1] = sin_theta * sin(phi), wi[3 * i + 2] = cos_theta;
        pdf[i] = cos_theta / pi;
    }
    return 0;
}

int crescent_sampler_pdf(size_t count, const double* wo, const double* wi, const double* surface, double* pdf) {
    (void)wo, (void)surface;
    for (size_t i = 0; i < count; ++i) pdf[i] = wi[3 * i + 2] > 0 ? wi[3 * i + 2] / pi : 0;
    return 0;
}
