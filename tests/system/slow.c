/* The cosine-weighted hemisphere: as many quick answers as argument 1 says, then ten a second; argument 2: what is
 * printed for the pdf of a draw; "n:TEXT": at w_o = n alone. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int main(int count, char** words) {
    const double pi = 3.14159265358979323846;
    char line[512];
    long quick = count > 1 ? atol(words[1]) : 0;
    const char* text = count > 2 ? words[2] : 0;
    const int at_n = text && strncmp(text, "n:", 2) == 0;
    if (at_n) text += 2;
    while (fgets(line, sizeof line, stdin)) {
        double ox, oy, oz, x, y, z;
        const struct timespec nap = {0, 100000000};
        if (quick-- <= 0) nanosleep(&nap, 0);
        if (strncmp(line, "hello", 5) == 0) {
            printf("hello 2 slow\n");
        } else if (sscanf(line, "sample %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y) == 5) {
            const double r = sqrt(x), up = sqrt(1 - x), phi = 2 * pi * y;
            printf("%.17g %.17g %.17g ", r * cos(phi), r * sin(phi), up);
            if (text && (oz == 1 || !at_n)) printf("%s\n", text);
            else printf("%.17g\n", up / pi);
        } else if (sscanf(line, "pdf %lf %lf %lf %lf %lf %lf", &ox, &oy, &oz, &x, &y, &z) == 6) {
            printf("%.17g\n", z > 0 ? z / pi : 0.0);
        } else if (line[0] == 'f') {
            printf("-\n");
        }
        fflush(stdout);
    }
    return 0;
}
