#!/bin/bash
# kill -9 at any moment: a reader finds the files of one run, the previous or the new one, and the next run leaves the
# same files as after a run that was never killed, with the user's files and nothing else. The two runs are of different
# experiments. files_test.cpp ends before each single change; here whole processes are killed at any time.
. "$(dirname "$0")/common.sh"

other="$work/other.toml"
sed -e 's/^seed = 7/seed = 11/' -e 's/plates.hero/plates.picture/' "$tiny" >other.toml
expect 0 "$CRESCENT" run "$tiny" --quiet --out first
start=$(date +%s%N)
expect 0 "$CRESCENT" run "$other" --quiet --out second
length=$((($(date +%s%N) - start) / 1000000))

# visible FOLDER: its contents without the user's files and what varies from run to run.
visible() {
    (cd "$1" && find . -type f ! -name timing.json ! -name notes.txt ! -path '*/mine*' -exec sha256sum {} + | sort -k 2)
}
visible first >of_first
visible second >of_second
cmp -s of_first of_second && die "the two experiments have the same outputs"
theirs=(notes.txt plates/mine.png films/mine/film.exr mine/thesis.txt)

prepare() {
    find killed .killed.crescent -mindepth 1 -delete 2>/dev/null
    mkdir -p killed && cp -a first/. killed
    for name in "${theirs[@]}"; do
        mkdir -p "$(dirname "killed/$name")" && echo mine >"killed/$name"
    done
}
# check_outputs HOW WHEN: checks after a kill, and after the next run. one_by_one: files may be of two runs in between.
check_outputs() {
    visible killed >of_killed
    if [ "$1" = whole ]; then
        cmp -s of_killed of_second && reached=1
        [ "${reached:-0}" = 1 ] || cmp -s of_killed of_first || cmp -s of_killed of_second ||
            die "killed $2: a mixture of two runs: $(diff of_first of_killed)"
        for name in notes.txt plates/mine.png; do [ -e "killed/$name" ] || die "killed $2: $name is gone"; done
    fi
    expect 0 "$CRESCENT" run "$other" --quiet --out killed
    visible killed | diff of_second - >difference || die "killed $2: the next run: $(cat difference)"
    for name in "${theirs[@]}"; do
        [ "$(cat "killed/$name" 2>/dev/null)" = mine ] || die "killed $2: $name is gone"
    done
    [ -z "$(ls -Ad .killed.crescent killed/.crescent-work 2>/dev/null)" ] || die "killed $2: something is left behind"
}
kill_at() { # PERMILLE HOW [COMMAND...]: kills a run at that part of its time
    "${@:3}" "$CRESCENT" run "$other" --quiet --out killed >/dev/null 2>&1 &
    local run=$!
    sleep "$(awk "BEGIN { print $length * $1 / 1000000 }")"
    kill -s KILL "$run" 2>/dev/null
    wait "$run" 2>/dev/null
    check_outputs "$2" "after $1/1000 of a run"
}

for part in 50 300 500 700 800 850 900 950 1000 1050; do
    prepare
    kill_at $part whole
done

# A file system that cannot exchange two folders, or that fails to rename one; and a kill at system calls that publish.
if command -v strace >/dev/null && strace -qq -o /dev/null true 2>/dev/null; then
    for fault in renameat2:error=EINVAL renameat2:error=EXDEV renameat2:signal=KILL linkat:error=EPERM \
        unlink:signal=KILL:when=1 unlink:signal=KILL:when=3 rmdir:signal=KILL:when=1 rename:signal=KILL:when=1; do
        prepare
        strace -f -qq -e "trace=${fault%%:*}" -e "inject=$fault" -o calls "$CRESCENT" run "$other" --quiet \
            --out killed >/dev/null 2>&1
        case $fault in
            *error*) visible killed | diff of_second - >difference || die "with $fault: $(cat difference)" ;;
        esac
        reached=1 check_outputs whole "by $fault"
    done
fi

# If OUT cannot be renamed: a mount point, with its stage inside if nothing can be created next to it.
rm -rf killed && mkdir killed
if mount -t tmpfs -o size=64m none killed 2>/dev/null; then
    trap 'umount "$work/killed"; rm -rf "$work"' EXIT
    for part in 600 900 1000; do
        prepare
        kill_at $part one_by_one
    done
fi
[ "${reached:-0}" = 1 ] || die "the new outputs never came"
exit 0
