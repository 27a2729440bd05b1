# Shared by the scripts of this folder. They get the program as $CRESCENT and the repository as $CRESCENT_SOURCE; each
# works in a folder of its own, and ends at the first failure.
set -u
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tiny="$here/tiny.toml"
: "${CRESCENT:?the program}" "${CRESCENT_SOURCE:?the repository}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
# What is compiled here is found in ccache the next time, though the folder is another one.
if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$work CCACHE_NOHASHDIR=1
    export CCACHE_SLOPPINESS=pch_defines,time_macros
fi

die() {
    printf '%s\n' "$*" >&2
    exit 1
}

skip() {
    printf 'skipped: %s\n' "$*"
    exit 77
}

# expect CODE COMMAND...: runs it, storing stderr in `said` and stdout in `printed`; another exit code ends the script.
expect() {
    local code=$1 got=0
    shift
    "$@" >printed 2>said || got=$?
    [ "$got" -eq "$code" ] || die "exit $got, expected $code: $*
$(tail -n 40 printed said)"
}

# placed FILE.sarif URI LINE: every result of a SARIF file is at this line of this file, and there is one.
placed() {
    /usr/bin/python3 - "$@" <<'PY' || die "the SARIF file: $(cat "$1")"
import json, sys
file, uri, line = sys.argv[1:]
results = json.load(open(file))["runs"][0]["results"]
places = [r["locations"][0]["physicalLocation"] for r in results]
assert places and all(p == {"artifactLocation": {"uri": uri}, "region": {"startLine": int(line)}} for p in places), places
PY
}

# build_example NAME [OPTION...]: installs the build into prefix/, then builds examples/NAME against it, outside the
# tree, in NAME/build.
build_example() {
    expect 0 cmake --install "${CRESCENT_BUILD:?the build folder}" --prefix "$work/prefix"
    cp -r "$CRESCENT_SOURCE/examples/$1" "$1"
    expect 0 cmake -S "$1" -B "$1/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="${CXX:-g++}" \
        -DCMAKE_PREFIX_PATH="$work/prefix" "${@:2}"
    expect 0 cmake --build "$1/build"
}

# usable_arms: the built-in samplers that reach a light of an experiment without sky and meshes.
usable_arms() { "$CRESCENT" list arms | sed 's/ .*//' | grep -vxE 'sky|light-triangle'; }

# same_outputs A B: equal except for what varies from run to run.
same_outputs() { diff -r -x timing.json "$1" "$2" >difference || die "$1 and $2 differ: $(head -n 5 difference)"; }

# own_namespace: the rest of the script runs in namespaces of its own; what it mounts and every process ends with it.
own_namespace() {
    [ -z "${IN_OWN_NAMESPACE:-}" ] || { mount -t proc proc /proc && return; }
    [ "$(id -u)" -eq 0 ] || skip "not root"
    unshare -m true 2>/dev/null || skip "no mount namespaces here"
    IN_OWN_NAMESPACE=1 unshare -mpf --kill-child bash "$0"
    exit
}

# bare_root FOLDER [PACKAGE...]: a root of this machine's Debian with these packages and no others, in own_namespace().
# Packages come from where this machine's do.
bare_root() {
    local folder=$1 packages=${*:2} mirror file
    command -v debootstrap >/dev/null || skip "no debootstrap here"
    . /etc/os-release
    [ "$ID" = debian ] || skip "this is not Debian"
    mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
        awk -v name="$VERSION_CODENAME" '$2 == name && $3 == "main" { print $1; exit }')
    [ -n "$mirror" ] || skip "apt has no list of $VERSION_CODENAME (apt-get update)"
    debootstrap --variant=minbase ${packages:+--include="${packages// /,}"} "$VERSION_CODENAME" "$folder" "$mirror" \
        >log 2>&1 || skip "debootstrap could not make a root: $(tail -n 1 log)"
    for file in /etc/apt /etc/resolv.conf /etc/hosts /etc/ssl /usr/share/keyrings /usr/share/ca-certificates; do
        [ -e "$file" ] || continue
        rm -rf "${folder:?}$file" && cp -rL "$file" "$folder$file" || die "cannot copy $file into the root"
    done
    mount -t proc proc "$folder/proc"
    trap 'umount -l "'"$folder"'/proc"; rm -rf "$work"' EXIT
}

# inside COMMAND: a shell command in $root, in $folder, with the PATH of an image.
folder=/
inside() {
    chroot "${root:?a bare root}" env -i PATH="${image_path:-/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin}" \
        ${http_proxy:+http_proxy="$http_proxy"} DEBIAN_FRONTEND=noninteractive HOME=/root sh -c "cd '$folder' && $1"
}

# wheels_of_this_build: sets `wheels` to those of dist/; skips where ./wheel has not made them of the commit that
# $CRESCENT was built from.
wheels_of_this_build() {
    local file ours theirs
    wheels=("$CRESCENT_SOURCE"/dist/crescent_bench-*.whl)
    [ -f "${wheels[0]}" ] || skip "no wheel in dist/: ./wheel makes it"
    ours=$("$CRESCENT" --version | head -n 1)
    for file in "${wheels[@]}"; do
        rm -rf unpacked && python3 -m zipfile -e "$file" unpacked && chmod +x unpacked/crescent/bin/crescent ||
            die "cannot unpack $file"
        theirs=$(unpacked/crescent/bin/crescent --version | head -n 1)
        [ "$theirs" = "$ours" ] || skip "${file##*/} is $theirs, and this build is $ours: ./wheel makes the wheel anew"
    done
    rm -rf unpacked
}
