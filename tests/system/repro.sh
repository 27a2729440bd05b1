#!/bin/bash
# `check --repro`: a script without crescent that shows the fault at a w_o of round numbers, and ends with 0 once the
# sampler is corrected; for programs of both protocols and for samplers in Python files.
. "$(dirname "$0")/common.sh"
. "$here/docs/python.sh"
/usr/bin/python3 -c 'import numpy' || die "python3-numpy is missing"

# A cosine lobe over Lambert of 0.5 with one fault.
cat >faulty.c <<'C'
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const char *kind;

static int has(const char *name) { return strcmp(kind, name) == 0; }

static double lobe(double z) {
    if (z <= 0 || (has("dark") && z < 0.3)) return 0;
    return z / pi * (has("factor") ? 1.2 : 1) / (has("dark") ? 0.91 : 1);
}

int main(int count, char **words) {
    static char line[4096];
    double x[6];
    kind = words[count - 1];
    while (fgets(line, sizeof line, stdin)) {
        const int numbers = sscanf(line, "%*s %lf %lf %lf %lf %lf %lf", x, x + 1, x + 2, x + 3, x + 4, x + 5);
        if (line[0] == 'h') puts("hello 2 faulty domain=hemisphere");
        else if (numbers == 5) {
            const double u = has("dark") ? 0.91 * x[3] : x[3], z = has("uniform") ? 1 - u : sqrt(1 - u);
            const double r = sqrt(1 - z * z), p = lobe(z) * (has("two") ? 1.1 : 1);
            printf("%.17g %.17g %.17g %.17g\n", r * cos(2 * pi * x[4]), r * sin(2 * pi * x[4]), z,
                has("nan") && u > 0.7 ? NAN : p);
        } else if (line[0] == 'p') printf("%a\n", lobe(x[5]));
        else printf("%.17g\n", (has("bright") ? 1.02 : has("lopsided") ? 0.5 + 0.2 * x[5] : 0.5) / pi);
        fflush(stdout);
    }
    return 0;
}
C
expect 0 "${CC:-cc}" -O2 -o faulty faulty.c -lm

# shows WORDS SCRIPT: it fails, prints these words, is short, and needs nothing of crescent.
shows() {
    expect 1 /usr/bin/python3 "$2"
    grep -q -- "$1" printed || die "$2 does not print '$1': $(cat printed "$2")"
    ! grep -q crescent "$2" || die "$2 needs crescent: $(cat "$2")"
    [ "$(wc -l <"$2")" -le 42 ] || die "$2 is long: $(cat "$2")"
}
while read -r kind verdict words; do
    expect 1 "$CRESCENT" check --quiet --exec "./faulty $kind" --wo 50.3,12.7 --repro $kind.py
    grep -q "^# $verdict: " $kind.py || die "$kind is not shown by $verdict: $(head -n 1 $kind.py)"
    grep -q "^wo = at(45, 0)$" $kind.py || die "w_o of $kind is not round: $(grep '^wo' $kind.py)"
    shows "$words" $kind.py
    sed -i "s/faulty $kind/faulty right/" $kind.py
    expect 0 /usr/bin/python3 $kind.py
done <<'END'
nan valid pdf nan
dark support f cos
factor normalised pdf integrates to 1.2
uniform density of the draws
two identity pdf of the draw
bright physics reflects 1.0[12]
lopsided physics f(a, b)
END
grep -q "sample(wo, np.array(\[\[0\.[0-9]*, 0\(\.[0-9]\)*\]\]))" nan.py two.py || die "u is not round: $(grep sample nan.py two.py)"

expect 0 "${CC:-cc}" -O2 -o block "$CRESCENT_SOURCE/examples/pipe_samplers/cosine_block.c" -lm
sed 's/up \/ pi/up \/ 3.0/; s/row\[5\] \/ pi/row[5] \/ 3.0/' "$CRESCENT_SOURCE/examples/pipe_samplers/cosine_block.c" >dim.c
expect 0 "${CC:-cc}" -O2 -o dim dim.c -lm
expect 1 "$CRESCENT" check --quiet --exec ./dim --wo 45 --repro dim.py
shows "pdf integrates to" dim.py
sed -i "s/\.\/dim/.\/block/" dim.py
expect 0 /usr/bin/python3 dim.py

# Points of a domain, and an estimator of a number.
cat >points.c <<'C'
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const char *kind;

static int has(const char *name) { return strcmp(kind, name) == 0; }

int main(int count, char **words) {
    static char line[4096];
    kind = words[count - 1];
    while (fgets(line, sizeof line, stdin)) {
        double u = 0, v = 0;
        sscanf(line, "%*s %lf %lf", &u, &v);
        if (line[0] == 'h') puts(count > 2 ? "hello 2 estimator domain=number u=1" : "hello 2 lens domain=disk");
        else if (count > 2) printf("%.17g\n", has("bad") && u > 0.9 ? NAN : has("bias") ? 2.04 * u : 2 * u);
        else if (line[0] == 's') {
            const double r = (has("root") ? u : sqrt(u)) * (has("outside") ? 1.1 : 1);
            printf("%.17g %.17g %.17g\n", r * cos(2 * pi * v), r * sin(2 * pi * v), (has("two") ? 1.1 : 1) / pi);
        } else if (line[0] == 'p') printf("%.17g\n", (has("factor") ? 1.2 : 1) / pi);
        else puts("-");
        fflush(stdout);
    }
    return 0;
}
C
expect 0 "${CC:-cc}" -O2 -o points points.c -lm
while read -r kind verdict words; do
    case $kind in bias | bad) number=number estimates="--estimates 1" ;; *) number= estimates= ;; esac
    expect 1 "$CRESCENT" check --quiet --exec "./points $number $kind" $estimates --repro $kind.py
    grep -q "^# $verdict: " $kind.py || die "$kind is not shown by $verdict: $(head -n 1 $kind.py)"
    shows "$words" $kind.py
    sed -i "s/ $kind\"/ right\"/" $kind.py
    expect 0 /usr/bin/python3 $kind.py
done <<'END'
root density of the draws
outside valid the point
two identity pdf of the draw
factor normalised pdf integrates to 1.[12]
bias mean expected 1
bad valid values are not finite
END

# Weights without a pdf, and those of a reservoir, which estimate 1/p.
cat >weighs.c <<'C'
#include <math.h>
#include <stdio.h>
#include <string.h>

int main(int count, char **words) {
    static char line[4096];
    double x[6];
    const double pi = 3.14159265358979323846, part = strcmp(words[count - 1], "dim") == 0 ? 0.9 : 1;
    const int is_reservoir = strcmp(words[1], "reservoir") == 0;
    while (fgets(line, sizeof line, stdin)) {
        const int numbers = sscanf(line, "%*s %lf %lf %lf %lf %lf %lf", x, x + 1, x + 2, x + 3, x + 4, x + 5);
        if (line[0] == 'h')
            printf("hello 2 weighs domain=hemisphere %s\n", is_reservoir ? "weight=reciprocal" : "weight=yes pdf=no");
        else if (numbers == 5) {
            const double z = sqrt(1 - x[3]), r = sqrt(x[3]), phi = 2 * pi * x[4] / (is_reservoir ? 1 : 0.9);
            if (phi > 2 * pi) puts("0 0 1 0 0");
            else
                printf("%.17g %.17g %.17g %.17g%s\n", r * cos(phi), r * sin(phi), z, is_reservoir ? part * pi / z : 1,
                    is_reservoir ? "" : part < 1 ? " 0.5" : " 0.55555555555555556");
        } else printf("%.17g\n", is_reservoir ? x[5] : 0.5 / pi);
        fflush(stdout);
    }
    return 0;
}
C
expect 0 "${CC:-cc}" -O2 -o weighs weighs.c -lm
for kind in plain reservoir; do
    expect 1 "$CRESCENT" check --quiet --exec "./weighs $kind dim" --wo 50.3,12.7 --repro $kind.py
    grep -q "^# mean: " $kind.py || die "$kind is not shown by mean: $(head -n 1 $kind.py)"
    shows "and mean of the weights" $kind.py
    sed -i "s/ dim\"/ right\"/" $kind.py
    expect 0 /usr/bin/python3 $kind.py
done

# Without a fault there is no script; other samplers than a program and a Python file have none.
expect 0 "$CRESCENT" check --quiet --exec "./faulty right" --wo 45 --repro none.py
grep -q "no verdict is wrong" said && [ ! -e none.py ] || die "a script without a fault: $(cat said)"
expect 2 "$CRESCENT" check --quiet phong --repro none.py
grep -q -- "--repro.*needs --exec or a sampler in a Python file" said || die "no reason: $(cat said)"

python=$(page_python)
[ -n "$python" ] || exit 0
mkdir -p bsdf/lobes && touch bsdf/lobes/__init__.py
cp "$CRESCENT_SOURCE/examples/clearcoat.py" bsdf/lobes/
export CRESCENT_PYTHON=$python PYTHONPATH=$CRESCENT_BUILD/python
expect 1 "$CRESCENT" check --quiet bsdf/lobes/clearcoat.py --repro clearcoat_repro.py
unset PYTHONPATH
shows "pdf integrates to 2.8" clearcoat_repro.py

# A file that makes a crescent.Sampler is shown without crescent; one that uses more of it says that it needs it.
sed '1i import crescent' "$CRESCENT_SOURCE/examples/clearcoat.py" >held.py
printf '\nlobe = crescent.Sampler(sample, pdf, f)\n' >>held.py
PYTHONPATH=$CRESCENT_BUILD/python expect 1 "$CRESCENT" check --quiet held.py:lobe --repro held_repro.py
expect 1 /usr/bin/python3 held_repro.py
grep -q "pdf integrates to 2.8" printed || die "a file that imports crescent is not shown without: $(cat said held_repro.py)"
sed 's/^lobe = .*/lobe = crescent.adapters.numpy(sample, lambda wo, wi: f(wo, wi) * abs(wi[:, 2]), pdf)/' held.py >adapted.py
PYTHONPATH=$CRESCENT_BUILD/python expect 1 "$CRESCENT" check --quiet adapted.py:lobe --repro adapted_repro.py
grep -q "^# The file of the sampler needs crescent" adapted_repro.py || die "no remark: $(cat adapted_repro.py)"
