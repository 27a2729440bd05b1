/* A sampler for `crescent check --exec ./cosine`: the cosine-weighted hemisphere and a Lambert BRDF of 0.5.
 * cc -O2 -o cosine cosine.c -lm
 * One request a line, one answer a line, in order; n = +z; hexadecimal floats lose nothing; end of input ends it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

int main(void) {
    char line[512];
    while (fgets(line, sizeof line, stdin)) {
        double ox, oy, oz, x, y, z;
        if (strncmp(line, "hello", 5) == 0) {
            printf("hello 2 cosine.c\n");
        } else if (sscanf(line, "sample %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y) == 5) {
            const double r = sqrt(x), up = sqrt(1 - x), phi = 2 * pi * y;
            printf("%a %a %a %a\n", r * cos(phi), r * sin(phi), up, up / pi);
        } else if (sscanf(line, "pdf %lf %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y, &z) == 6) {
            printf("%a\n", z > 0 ? z / pi : 0.0);
        } else if (sscanf(line, "f %lf %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y, &z) == 6) {
            printf("%a\n", z > 0 ? 0.5 / pi : 0.0);
        } else {
            printf("?\n");
        }
        fflush(stdout); /* the asker waits for every answer */
    }
    return 0;
}
