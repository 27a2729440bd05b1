/* A smooth coat over a coloured diffuse base, for `crescent check --exec ./coat`.
 * cc -O2 -o coat coat.c -lm
 * The coat mirrors 1/5 of the light, a delta part; the rest meets a Lambert surface of three channels. Three random
 * numbers: the third chooses the part. Requests are read as they come, and answers flushed when none is waiting. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846, mirrored = 0.2, base[3] = {0.7, 0.4, 0.1};

static double pdf(double z) { return z > 0 ? (1 - mirrored) * z / pi : 0; }
static double f(int channel, double z) { return z > 0 ? (1 - mirrored) * base[channel] / pi : 0; }

int main(void) {
    static char line[512], out[1 << 16];
    setvbuf(stdout, out, _IOFBF, sizeof out);
    while (fgets(line, sizeof line, stdin)) {
        double ox, oy, oz, x, y, z;
        if (strncmp(line, "hello", 5) == 0) {
            printf("hello 2 coat.c u=3 domain=hemisphere channels=3 weight=yes delta=yes\n");
        } else if (sscanf(line, "sample %lf %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y, &z) == 6) {
            if (z < mirrored) {
                printf("%a %a %a delta %a 1 1 1\n", -ox, -oy, oz, mirrored);
            } else {
                const double r = sqrt(x), up = sqrt(1 - x), phi = 2 * pi * y;
                printf("%a %a %a %a", r * cos(phi), r * sin(phi), up, pdf(up));
                printf(" %a %a %a\n", base[0], base[1], base[2]);
            }
        } else if (sscanf(line, "pdf %lf %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y, &z) == 6) {
            printf("%a\n", pdf(z));
        } else if (sscanf(line, "f %lf %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y, &z) == 6) {
            printf("%a %a %a\n", f(0, z), f(1, z), f(2, z));
        } else {
            printf("?\n");
        }
        fflush(stdout); /* the asker waits for every answer */
    }
    return 0;
}
