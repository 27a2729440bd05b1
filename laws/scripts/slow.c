/* The cosine-weighted hemisphere: as many quick answers as argument 1 says, then ten a second; argument 2 "nan": NaN at w_o = n. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int main(int count, char** words) {
    const double pi = 3.14159265358979323846;
    char line[512];
    long quick = count > 1 ? atol(words[1]) : 0;
    const int nan_at_n = count > 2 && strcmp(words[2], "nan") == 0;
    while (fgets(line, sizeof line, stdin)) {
        double ox, oy, oz, x, y, z;
        const struct timespec nap = {0, 100000000};
        if (quick-- <= 0) nanosleep(&nap, 0);
        if (strncmp(line, "hello", 5) == 0) {
            printf("hello 1 slow\n");
        } else if (sscanf(line, "sample %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y) == 5) {
            const double r = sqrt(x), up = sqrt(1 - x), phi = 2 * pi * y;
            printf("%.17g %.17g %.17g %.17g\n", r * cos(phi), r * sin(phi), up, nan_at_n && oz == 1 ? NAN : up / pi);
        } else if (sscanf(line, "pdf %lf %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y, &z) == 6) {
            printf("%.17g\n", z > 0 ? z / pi : 0.0);
        } else if (line[0] == 'f') {
            printf("-\n");
        }
        fflush(stdout);
    }
    return 0;
}
