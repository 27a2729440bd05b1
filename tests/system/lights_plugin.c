/* Version 2 of the plugin interface: uniform on the area of the first light of an experiment, a disk. */
#include <math.h>

#include "check/sampler_plugin.h"

static const double pi = 3.14159265358979323846;

unsigned crescent_sampler_abi(void) { return CRESCENT_SAMPLER_ABI; }
const char* crescent_sampler_uses(void) { return "rho_d,lights"; }

/* The light of row i, whose columns are rho_d (3), the number of lights, and the lights. */
static const crescent_light* light_of(const double* surface, size_t i) {
    const size_t columns = 4 + (size_t)surface[3] * (sizeof(crescent_light) / sizeof(double));
    return (const crescent_light*)(surface + i * columns + 4);
}

static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

int crescent_sampler_sample(
    size_t count, const double* wo, const double* u, const double* surface, double* wi, double* pdf) {
    (void)wo;
    for (size_t i = 0; i < count; ++i) {
        const crescent_light* light = light_of(surface, i);
        if (light->kind != 0) return 8;
        /* A frame about the normal: Duff et al. 2017, "Building an Orthonormal Basis, Revisited". */
        const double *n = light->normal, sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
        const double t[3] = {1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]};
        const double e[3] = {b, sign + n[1] * n[1] * a, -n[1]};
        const double r = light->radius * sqrt(u[2 * i]), phi = 2 * pi * u[2 * i + 1];
        double y[3];
        for (int k = 0; k < 3; ++k) y[k] = light->position[k] + r * (cos(phi) * t[k] + sin(phi) * e[k]);
        const double d2 = dot(y, y), d = sqrt(d2);
        for (int k = 0; k < 3; ++k) wi[3 * i + k] = y[k] / d;
        const double cos_light = fabs(dot(y, n)) / d;
        pdf[i] = light->shines > 0 && cos_light > 0 ? d2 / (pi * light->radius * light->radius * cos_light) : 0;
    }
    return 0;
}

int crescent_sampler_pdf(size_t count, const double* wo, const double* wi, const double* surface, double* pdf) {
    (void)wo;
    for (size_t i = 0; i < count; ++i) {
        const crescent_light* light = light_of(surface, i);
        const double *w = wi + 3 * i, cos_light = dot(w, light->normal);
        const double distance = cos_light != 0 ? dot(light->position, light->normal) / cos_light : 0;
        double off[3];
        for (int k = 0; k < 3; ++k) off[k] = distance * w[k] - light->position[k];
        const int met = distance > 0 && dot(off, off) <= light->radius * light->radius && light->shines > 0;
        pdf[i] = met ? distance * distance / (pi * light->radius * light->radius * fabs(cos_light)) : 0;
    }
    return 0;
}
