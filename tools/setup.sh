# Shell functions of ./run and ./test: packages, configuration, build. Sourced, with `root` set to the repository. The
# output of each step goes to build/log/; the terminal shows one line per step, and the end of the log if a step fails.

log_dir="$root/build/log"
mkdir -p "$log_dir" 2>/dev/null || { echo "cannot write to $root/build" >&2; exit 3; }

say() { printf '%s\n' "$*" >&2; }

# fail CODE LOG MESSAGE: prints the message, the end of the log, and its path.
fail() {
    local code=$1 log=$2
    shift 2
    [ -s "$log" ] && { tail -n 40 "$log" >&2; say "the whole log: $log"; }
    say "$*"
    exit "$code"
}

# packages_of GROUP...: the names listed under these groups.
packages_of() {
    local group
    for group in "$@"; do awk -v group="$group" '$1 == group { print $2 }' "$root/tools/packages.txt"; done
}

# missing PACKAGE...: those that are not installed.
missing() {
    [ $# -gt 0 ] || return 0
    # An empty line first: without a line of dpkg's, awk would take the names for dpkg's list.
    { echo; dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' "$@" 2>/dev/null; } |
        awk 'NR == FNR { if ($1 == "ii") have[$2] = 1; next } !($1 in have)' - <(printf '%s\n' "$@")
}

# progress WHAT DONE TOTAL: one line, which the next overwrites on a terminal. In a log, one line every 15 s.
progress_shown=0
progress() {
    if [ -t 2 ]; then printf '\r\e[K%s: %s of %s' "$@" >&2
    elif [ $((SECONDS - progress_shown)) -ge 15 ]; then
        progress_shown=$SECONDS
        say "  $1: $2 of $3"
    fi
}

# end_progress: clears that line.
end_progress() { [ ! -t 2 ] || printf '\r\e[K' >&2; }

# follow_apt: shows the lines that apt writes to its Status-Fd, "pmstatus:PACKAGE:PERCENT:TEXT".
follow_apt() {
    local kind percent
    progress_shown=$SECONDS
    while IFS=: read -r kind _ percent _; do
        case $kind in
        dlstatus) progress "downloading packages" "${percent%.*}" "100 %" ;;
        pmstatus) progress "installing packages" "${percent%.*}" "100 %" ;;
        esac
    done
    end_progress
}

# apt ARGUMENT...: its output goes to the log, its progress to the terminal.
apt() {
    local as=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || { echo "neither root nor sudo"; return 1; }
        as=(sudo)
    fi
    "${as[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 \
        -o APT::Status-Fd=1 "$@" 2>&1 | tee -a "$log_dir/packages.log" | follow_apt
    return "${PIPESTATUS[0]}"
}

# need_packages GROUP...: installs the missing packages of these groups, and of the optional ones that go with them
# (GROUP?) those that can be had. Uses neither apt nor the network if nothing is missing.
need_packages() {
    command -v dpkg-query >/dev/null || { say "no dpkg here: taking the needed packages as installed"; return; }
    local log="$log_dir/packages.log" unavailable="$root/build/unavailable-packages" package
    local needed=() optional=()
    mapfile -t needed < <(missing $(packages_of "$@"))
    # A package that was not available is not tried again until the list changes.
    [ "$unavailable" -nt "$root/tools/packages.txt" ] || : >"$unavailable"
    mapfile -t optional < <(missing $(packages_of "${@/%/?}") | grep -vxF -f "$unavailable")
    [ ${#needed[@]} -gt 0 ] || [ ${#optional[@]} -gt 0 ] || return 0
    say "installing packages: ${needed[*]} ${optional[*]}"
    : >"$log"
    touch "$root/build/packages-installed"
    apt update
    if [ ${#needed[@]} -gt 0 ]; then
        apt install --no-install-recommends "${needed[@]}"
        mapfile -t needed < <(missing "${needed[@]}")
        [ ${#needed[@]} -eq 0 ] || fail 3 "$log" "needed and not to be had through apt: ${needed[*]}"
    fi
    if [ ${#optional[@]} -gt 0 ]; then
        apt install --no-install-recommends "${optional[@]}" ||
            for package in "${optional[@]}"; do apt install --no-install-recommends "$package"; done
        mapfile -t optional < <(missing "${optional[@]}")
        printf '%s\n' "${optional[@]}" | grep . >>"$unavailable"
        [ ${#optional[@]} -eq 0 ] || say "going on without: ${optional[*]}"
    fi
}

# binary_dir PRESET: where CMakePresets.json builds it.
binary_dir() {
    case $1 in
    release | parts | run) echo "$root/build" ;;
    *) echo "$root/build-$1" ;;
    esac
}

# follow NAME LOG: copies ninja's lines to stdout (the log) and its count to the terminal.
follow() {
    local line started=
    progress_shown=$SECONDS
    while IFS= read -r line; do
        printf '%s\n' "$line"
        [ -z "$started" ] && [[ $line == *Building* ]] && started=1 && say "building $1 (log: ${2#"$root"/})"
        [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] && progress "$1" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]} steps"
    done
    end_progress
    return 0
}

# build_core MACHINE [TARGET...]: builds only the numerical core for another machine, tests/portability/MACHINE.cmake.
build_core() {
    local dir="$root/build-$1" log="$log_dir/$1.log" start=$SECONDS
    grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root/tests/portability" "$dir/CMakeCache.txt" 2>/dev/null || rm -rf "$dir"
    [ -f "$dir/build.ninja" ] || cmake -S "$root/tests/portability" -B "$dir" -G Ninja \
        -DCMAKE_TOOLCHAIN_FILE="$root/tests/portability/$1.cmake" >"$log" 2>&1 ||
        fail 3 "$log" "configuring tests/portability for $1 failed"
    ninja -C "$dir" "${@:2}" 2>&1 | follow "$1" "$log" >>"$log"
    [ "${PIPESTATUS[0]}" -eq 0 ] || fail 3 "$log" "building the core for $1 failed"
    [ $((SECONDS - start)) -lt 2 ] || say "built $1 in $((SECONDS - start)) s"
}

# build_page: builds the module of the page and checks its scripts.
build_page() {
    local dir="$root/build-web" log="$log_dir/page.log" start
    build_core wasm32 core
    start=$SECONDS
    grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root/apps/web" "$dir/CMakeCache.txt" 2>/dev/null || rm -rf "$dir"
    [ -f "$dir/build.ninja" ] || cmake -S "$root/apps/web" -B "$dir" -G Ninja \
        -DCMAKE_TOOLCHAIN_FILE="$root/tests/portability/wasm32.cmake" >"$log" 2>&1 ||
        fail 3 "$log" "configuring the page failed"
    ninja -C "$dir" 2>&1 | follow page "$log" >>"$log"
    [ "${PIPESTATUS[0]}" -eq 0 ] || fail 3 "$log" "building the page's module failed"
    tsc -p "$root/apps/web" >"$log" 2>&1 || fail 3 "$log" "the page's scripts are not sound"
    [ $((SECONDS - start)) -lt 2 ] || say "built the page in $((SECONDS - start)) s"
}

# other_compiler PRESET: the setting for another compiler if clang++-19, which the preset names, is not installed.
other_compiler() {
    case $1 in release | parts | run) ;; *) return 0 ;; esac
    ! command -v clang++-19 >/dev/null || return 0
    local name
    for name in clang++ g++; do
        command -v "$name" >/dev/null && { echo "-DCMAKE_CXX_COMPILER=$name"; return; }
    done
}

# configure PRESET: makes the build folder of CMakePresets.json if it is not there. `run` is a part of `parts`, which is a
# part of `release`, all in one folder: what is there once stays.
configure() {
    local preset=$1 dir log stamp compiler
    dir=$(binary_dir "$preset")
    log="$log_dir/$1.log"
    [ "$preset" = run ] && [ -f "$dir/configured-parts" ] && preset=parts
    case $preset in run | parts) [ -f "$dir/configured-release" ] && preset=release ;; esac
    stamp="$dir/configured-$preset"
    # A repository that was moved is configured again.
    grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$dir/CMakeCache.txt" 2>/dev/null ||
        rm -rf "$dir/CMakeCache.txt" "$dir/build.ninja"
    [ -f "$dir/build.ninja" ] && [ "$stamp" -nt "$root/CMakePresets.json" ] &&
        ! [ "$root/build/packages-installed" -nt "$stamp" ] && return
    compiler=$(other_compiler "$preset")
    say "configuring $preset${compiler:+ with ${compiler#*=}, since there is no clang++-19}"
    (cd "$root" && cmake --preset "$preset" $compiler) >"$log" 2>&1 || fail 3 "$log" "cmake --preset $preset failed"
    touch "$stamp"
}

# build PRESET [TARGET...]: configures, then brings the targets (default: all) up to date.
build() {
    local preset=$1 dir log start=$SECONDS
    shift
    dir=$(binary_dir "$preset")
    log="$log_dir/$preset.log"
    : >"$log"
    configure "$preset"
    ninja -C "$dir" "$@" 2>&1 | follow "$preset" "$log" >>"$log"
    [ "${PIPESTATUS[0]}" -eq 0 ] || fail 3 "$log" "building $preset failed"
    [ $((SECONDS - start)) -lt 2 ] || say "built $preset in $((SECONDS - start)) s"
}
