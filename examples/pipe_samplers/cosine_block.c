/* A sampler for `crescent check --exec ./cosine_block` and for `exec = "./cosine_block"` in an experiment, as
 * examples/pipe_samplers/cosine.c, but in binary blocks (docs/samplers.md): many rows for each read and write.
 * cc -O2 -o cosine_block cosine_block.c -lm        (a little-endian machine) */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { most = 65536 }; /* rows of a block */
static const double pi = 3.14159265358979323846;

int main(void) {
    double *in = malloc(6 * most * sizeof *in), *out = malloc(4 * most * sizeof *out);
    char line[64], what[4];
    uint32_t count;
    if (!in || !out || !fgets(line, sizeof line, stdin)) return 1;
    printf("hello 2 cosine_block.c block=f64\n");
    fflush(stdout);
    while (fread(what, 4, 1, stdin) == 1 && fread(&count, 4, 1, stdin) == 1 && count <= most) {
        const int draw = memcmp(what, "smpl", 4) == 0, pdf = memcmp(what, "pdf_", 4) == 0;
        const size_t columns = draw ? 5 : 6, answers = draw ? 4 : 1;
        if (fread(in, columns * sizeof *in, count, stdin) != count) return 1;
        for (uint32_t k = 0; k < count; ++k) {
            const double *row = in + columns * k; /* w_o, then u or w_i */
            if (draw) {
                const double r = sqrt(row[3]), up = sqrt(1 - row[3]), phi = 2 * pi * row[4];
                const double drawn[4] = {r * cos(phi), r * sin(phi), up, up / pi};
                memcpy(out + 4 * k, drawn, sizeof drawn);
            } else {
                out[k] = row[5] <= 0 ? 0 : pdf ? row[5] / pi : 0.5 / pi;
            }
        }
        fwrite(&count, 4, 1, stdout);
        fwrite(out, answers * sizeof *out, count, stdout);
        fflush(stdout);
    }
    return 0;
}
