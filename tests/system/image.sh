#!/bin/bash
# The last stage of the Dockerfile, its own lines run in a bare root of Debian 12 made by debootstrap: what the recipe
# installs is sufficient for the program to start and to make a run. The program is the one built here; instead of the
# recipe's copy from the stage `build`, `cmake --install` installs it. Packages come from this machine's mirror.
. "$(dirname "$0")/common.sh"

recipe="$CRESCENT_SOURCE/Dockerfile"
# The first stage builds what ./run builds: it installs no packages of its own.
joined() { sed -e ':next' -e '/\\$/{N;s/\\\n/ /;b next' -e '}' -e '/^#/d' "$recipe" | sed 's/  */ /g'; }
build=$(joined | sed -n '/ AS build$/,/^FROM [^ ]*$/p' | sed -n 's/^RUN //p')
prefix=$(sed -nE 's/.*cmake --install build --prefix ([^ ]+).*/\1/p' <<<"$build")
[ -n "$prefix" ] || die "the stage 'build' has no cmake --install: $build"
grep -q '\./run' <<<"$build" || die "the stage 'build' does not build as ./run does: $build"
! grep -q 'apt-get.* install' <<<"$build" || die "the stage 'build' has a list of packages beside tools/packages.txt"

# Each instruction of the last stage on a line.
last_stage() { joined | awk '/^FROM / { n = 0 } { line[++n] = $0 } END { for (i = 1; i <= n; ++i) print line[i] }'; }
from=$(last_stage | sed -n 's/^FROM debian:\([0-9]*\).*/\1/p')
. /etc/os-release
[ "$ID $VERSION_ID" = "debian $from" ] || skip "this is not Debian $from, which the image is"
[ "$(id -u)" -eq 0 ] || skip "not root"
command -v debootstrap >/dev/null || skip "no debootstrap here"
unshare -m true 2>/dev/null || skip "no mount namespaces here"

# Own namespaces: mounts and processes end with the script.
if [ -z "${IN_OWN_NAMESPACE:-}" ]; then
    IN_OWN_NAMESPACE=1 unshare -mpf --kill-child bash "$here/image.sh"
    exit
fi
mount -t proc proc /proc
root="$work/root"
mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    awk -v name="$VERSION_CODENAME" '$2 == name && $3 == "main" { print $1; exit }')
[ -n "$mirror" ] || skip "apt has no list of $VERSION_CODENAME (apt-get update)"
debootstrap --variant=minbase "$VERSION_CODENAME" "$root" "$mirror" >log 2>&1 ||
    skip "debootstrap could not make a root: $(tail -n 1 log)"
for file in /etc/apt /etc/resolv.conf /etc/hosts /etc/ssl /usr/share/keyrings /usr/share/ca-certificates; do
    [ -e "$file" ] || continue
    rm -rf "${root:?}$file" && cp -rL "$file" "$root$file" || die "cannot copy $file into the root"
done
mount -t proc proc "$root/proc"
trap 'umount -l "$root/proc"; rm -rf "$work"' EXIT

expect 0 cmake --install "$CRESCENT_BUILD" --prefix "$work/install" --strip
folder=/ entry='' preset=''
# inside COMMAND: in the root, as the image would start it.
inside() { chroot "$root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    ${http_proxy:+http_proxy="$http_proxy"} DEBIAN_FRONTEND=noninteractive sh -c "cd '$folder' && $1"; }
words() { tr -d '[]",' <<<"$1"; }
while read -r instruction rest; do
    case $instruction in
    '' | FROM) ;;
    RUN) inside "$rest" >log 2>&1 || die "RUN $rest: $(tail -n 20 log)" ;;
    COPY)
        read -r stage source target <<<"$rest"
        [ "$stage" = --from=build ] || die "COPY $rest: not from the stage 'build'"
        case $source in
        "$prefix"*) source="$work/install${source#"$prefix"}" ;;
        /crescent/*) source="$CRESCENT_SOURCE${source#/crescent}" ;;
        *) die "COPY $rest: the stage 'build' has no $source" ;;
        esac
        mkdir -p "$root$target" && cp -r "$source/." "$root$target/" || die "COPY $rest" ;;
    WORKDIR) folder=$rest && mkdir -p "$root$rest" ;;
    ENTRYPOINT) entry=$(words "$rest") ;;
    CMD) preset=$(words "$rest") ;;
    *) die "the recipe has $instruction, which this script does not know" ;;
    esac
done < <(last_stage)

expect 0 inside "$entry $preset"
[ -s printed ] || die "$entry $preset prints nothing"
expect 0 inside "$entry --version"
expect 0 "$CRESCENT" --version
cp printed here && expect 0 inside "$entry --version" && cmp here printed ||
    die "another version in the image: $(cat printed)"
[ "$(inside 'ls experiments')" = "$(ls "$CRESCENT_SOURCE/experiments")" ] || die "the image has other experiments"

# A small run with its plates and report, the same numbers as here.
cp "$tiny" "$root/tiny.toml"
expect 0 inside "$entry run /tiny.toml --quiet --out /out"
expect 0 "$CRESCENT" run "$tiny" --quiet --out out
[ -s "$root/out/report.html" ] && ls "$root"/out/plates/*.png >/dev/null || die "no report or no plates"
cmp out/metrics.csv "$root/out/metrics.csv" || die "other numbers in the image"

# What the image omits is reported in a sentence.
expect 3 inside "$entry run /tiny.toml --quiet --instrument gl --out /gl"
