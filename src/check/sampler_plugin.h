/* The C interface of a sampler in a shared library, for an experiment's `plugin` key and for `crescent check --plugin`.
 * All directions are unit vectors in the local frame: n = +z, wo given, wi drawn, both leave the surface. pdf in 1/sr.
 * Arrays hold rows of doubles, one row a sample. Functions are called by several threads at once unless
 * crescent_sampler_serial says otherwise. `_abi` and `_sample` must be there; the others may be. */
#ifndef CRESCENT_SAMPLER_PLUGIN_H
#define CRESCENT_SAMPLER_PLUGIN_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CRESCENT_SAMPLER_ABI 1

/* CRESCENT_SAMPLER_ABI as it was when the library was compiled. */
unsigned crescent_sampler_abi(void);
/* What the sampler calls itself; default: the file's name. */
const char* crescent_sampler_name(void);
/* Random numbers that a sample takes, 1 to 8; default 2. */
unsigned crescent_sampler_numbers(void);
/* Not 0: one call at a time; default 0. */
int crescent_sampler_serial(void);

/* Draws `count` directions. Rows: wo 3; u crescent_sampler_numbers() numbers in [0, 1); surface 4: Phong exponent s,
 * GGX roughness alpha, luminance of the diffuse albedo, specular albedo. Writes rows of wi (3) and of pdf (1); pdf 0:
 * nothing was drawn. Returns 0, or a number that is told and ends the run. */
int crescent_sampler_sample(
    size_t count, const double* wo, const double* u, const double* surface, double* wi, double* pdf);
/* The density of each wi, 0 where it is never drawn. `crescent check` needs it, a run does not. */
int crescent_sampler_pdf(size_t count, const double* wo, const double* wi, const double* surface, double* pdf);
/* The BRDF without the cosine, 1/sr, luminance. */
int crescent_sampler_f(size_t count, const double* wo, const double* wi, const double* surface, double* f);

#ifdef __cplusplus
}
#endif
#endif
