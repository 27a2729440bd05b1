/* The C interface of a sampler in a shared library, for an experiment's `plugin` key and for `crescent check --plugin`.
 * All directions are unit vectors in the local frame: n = +z, wo given, wi drawn, both leave the surface. pdf in 1/sr.
 * Arrays contain rows of doubles, one row for each sample. Functions are called by several threads at the same time
 * unless crescent_sampler_serial() is not 0. `_abi` and `_sample` are required; the other functions are optional. */
#ifndef CRESCENT_SAMPLER_PLUGIN_H
#define CRESCENT_SAMPLER_PLUGIN_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CRESCENT_SAMPLER_ABI 2

/* The value of CRESCENT_SAMPLER_ABI when the library was compiled. */
unsigned crescent_sampler_abi(void);
/* The name of the sampler; default: the name of the file. */
const char* crescent_sampler_name(void);
/* Number of random numbers of a sample, 1 to 8; default 2. */
unsigned crescent_sampler_numbers(void);
/* Not 0: one call at a time; default 0. */
int crescent_sampler_serial(void);

/* The columns of `surface`: names separated by commas, in any order. Default: 4 columns, Phong exponent s, GGX
 * roughness alpha, luminance of the diffuse albedo, specular albedo.
 *   s, alpha, rho_s  1 column each
 *   rho_d            3 columns, the diffuse albedo by channel
 *   side, eta        1 column each: always 1, because scenes are opaque and w_o is on the side of the normal
 *   lights           1 column, the number of lights, then a crescent_light for each; the same number in all rows */
const char* crescent_sampler_uses(void);

/* A light relative to the surface point, 18 doubles; m and W/(sr m^2), in the local frame. */
typedef struct crescent_light {
    double kind;                 /* 0 disk, 1 sphere, 2 rectangle */
    double radius;               /* for a rectangle: of the circle through its corners */
    double radiance[3];          /* linear Rec. 709 */
    double position[3];          /* of the centre */
    double normal[3];            /* unit; 0 for a sphere */
    double edge_u[3], edge_v[3]; /* for a rectangle: from the centre to the middle of an edge; otherwise 0 */
    double shines;               /* 1 if it faces the point; occlusion is ignored */
} crescent_light;

/* Draws `count` directions. Rows: wo 3; u crescent_sampler_numbers() numbers in [0, 1); surface: the columns of
 * crescent_sampler_uses(). Writes rows of wi (3) and of pdf (1); pdf 0: no sample. Returns 0, or an error number that
 * is reported and ends the run. */
int crescent_sampler_sample(
    size_t count, const double* wo, const double* u, const double* surface, double* wi, double* pdf);
/* The density of each wi, 0 if it is never drawn. `crescent check` needs it, `crescent run` does not. */
int crescent_sampler_pdf(size_t count, const double* wo, const double* wi, const double* surface, double* pdf);
/* The BRDF without the cosine, 1/sr, luminance. */
int crescent_sampler_f(size_t count, const double* wo, const double* wi, const double* surface, double* f);

#ifdef __cplusplus
}
#endif
#endif
