#!/bin/bash
# The Dockerfile without Docker: the environment of its stage `build` is made by the recipe's own command from the wheel
# in dist/, which ./wheel made as that stage does, and the lines of the last stage run in a bare root of Debian 12 that
# debootstrap makes. So what the recipe installs is all that the program needs.
. "$(dirname "$0")/common.sh"
wheels_of_this_build

recipe="$CRESCENT_SOURCE/Dockerfile"
joined() { sed -e ':next' -e '/\\$/{N;s/\\\n/ /;b next' -e '}' -e '/^#/d' "$recipe" | sed 's/  */ /g'; }
build=$(joined | sed -n '/ AS build$/,/^FROM [^ ]*$/p' | sed -n 's/^RUN //p')
[ "$(head -n 1 <<<"$build")" = "apt-get update && ./wheel /usr/bin/python3" ] ||
    die "the stage 'build' does not make the wheel as ./wheel does: $build"
environment=$(sed -n 2p <<<"$build")
prefix=$(sed -nE 's/^python3 -m venv ([^ ]+) .*/\1/p' <<<"$environment")
[[ $prefix == /opt/* ]] || die "the stage 'build' makes no environment in /opt: $build"

# Each instruction of the last stage on a line.
last_stage() { joined | awk '/^FROM / { n = 0 } { line[++n] = $0 } END { for (i = 1; i <= n; ++i) print line[i] }'; }
from=$(last_stage | sed -n 's/^FROM debian:\([0-9]*\).*/\1/p')
. /etc/os-release
[ "$ID $VERSION_ID" = "debian $from" ] || skip "this is not Debian $from, which the image is"
own_namespace
mount -t tmpfs opt /opt
tag=$(/usr/bin/python3 -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
mkdir -p build/dist && cp "$CRESCENT_SOURCE"/dist/crescent_bench-*-"$tag"-"$tag"-*.whl build/dist ||
    skip "dist/ has no wheel for this machine's python3"
(cd build && PATH="/usr/bin:$PATH" bash -ec "$environment") >log 2>&1 || skip "$environment: $(tail -n 1 log)"
root="$work/root"
bare_root "$root"

entry='' preset='' image_path=''
words() { tr -d '[]",' <<<"$1"; }
while read -r instruction rest; do
    case $instruction in
    '' | FROM) ;;
    RUN) inside "$rest" >log 2>&1 || die "RUN $rest: $(tail -n 20 log)" ;;
    COPY)
        read -r stage source target <<<"$rest"
        [ "$stage $source" = "--from=build $prefix" ] || die "COPY $rest: not from the stage 'build'"
        mkdir -p "$root$target" && cp -r "$source/." "$root$target/" || die "COPY $rest" ;;
    ENV) [[ $rest == PATH=* ]] && image_path=${rest#PATH=} || die "ENV $rest: this script knows PATH alone" ;;
    WORKDIR) folder=$rest && mkdir -p "$root$rest" ;;
    ENTRYPOINT) entry=$(words "$rest") ;;
    CMD) preset=$(words "$rest") ;;
    *) die "the recipe has $instruction, which this script does not know" ;;
    esac
done < <(last_stage)

expect 0 inside "$entry $preset"
[ -s printed ] || die "$entry $preset prints nothing"
expect 0 "$CRESCENT" --version
cp printed here && expect 0 inside "$entry --version" && cmp here printed ||
    die "another version in the image: $(cat printed)"

# A small run with its plates and report, the same numbers as here.
cp "$tiny" "$root/tiny.toml"
expect 0 inside "$entry run /tiny.toml --quiet --out /out"
expect 0 "$CRESCENT" run "$tiny" --quiet --out out
[ -s "$root/out/report.html" ] && ls "$root"/out/plates/*.png >/dev/null || die "no report or no plates"
cmp out/metrics.csv "$root/out/metrics.csv" || die "other numbers in the image"
expect 0 inside "$entry run gallery --seeds 1 --only metrics --quiet --out /gallery"

# What the image omits is reported in a sentence.
expect 3 inside "$entry run /tiny.toml --quiet --instrument gl --out /gl"
grep -q 'install the packages' said || die "what --instrument gl needs is not named: $(cat said)"
