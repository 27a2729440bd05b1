#!/bin/bash
# kill -9 at any moment: all that stands under the final names is of one run, the one before or the new one; the next
# run is none the worse; and no file of others is touched. The two runs are of different experiments.
. "$(dirname "$0")/common.sh"

other="$work/other.toml"
sed -e 's/^seed = 7/seed = 11/' -e 's/plates.hero/plates.picture/' "$tiny" >other.toml
expect 0 "$CRESCENT" run "$tiny" --quiet --out first
start=$(date +%s%N)
expect 0 "$CRESCENT" run "$other" --quiet --out second
length=$((($(date +%s%N) - start) / 1000000))

# visible FOLDER: what a reader finds there under names that are not hidden, links followed.
visible() { (cd "$1" && find -L . -type f ! -path './.*' ! -name timing.json -exec sha256sum {} + | sort -k 2); }
visible first >of_first
visible second >of_second
cmp -s of_first of_second && die "the two experiments have the same outputs"

prepare() {
    rm -rf killed
    cp -a first killed
    mkdir -p killed/.crescent-99999-backup && echo mine >killed/.crescent-99999-backup/thesis.txt
    echo mine >killed/notes.txt
    echo mine >killed/plates/mine.png
}
judge() {
    for name in .crescent-99999-backup/thesis.txt notes.txt plates/mine.png; do
        [ "$(cat "killed/$name" 2>/dev/null)" = mine ] || die "killed $1: $name is gone"
        rm "killed/$name"
    done
    visible killed >of_killed
    cmp -s of_killed of_first && return
    cmp -s of_killed of_second && { reached=1; return; }
    die "killed $1: a mixture of two runs: $(cat of_killed)"
}

for part in 10 60 90 100; do
    prepare
    "$CRESCENT" run "$other" --quiet --out killed >/dev/null 2>&1 &
    run=$!
    sleep "$(awk "BEGIN { print $length * $part / 100000 }")"
    kill -s KILL "$run" 2>/dev/null
    wait "$run" 2>/dev/null
    judge "after $part % of a run"
done

# Before system calls that publish, and Ctrl-C at the same places; files_test.cpp stops before each single one.
if command -v strace >/dev/null && strace -qq -o /dev/null true 2>/dev/null; then
    prepare
    strace -f -qq -e trace=renameat,linkat,symlinkat,unlinkat,fsync -o calls "$CRESCENT" run "$other" --quiet \
        --out killed >/dev/null 2>&1
    judge "never"
    for call in renameat linkat symlinkat unlinkat fsync; do
        many=$(grep -c "[^a-z]$call(" calls)
        [ "$many" -ge 5 ] || die "only $many calls of $call publish"
        for k in 1 $((many / 4)) $((many / 2)) $((3 * many / 4)) "$many"; do
            for signal in KILL INT; do
                [ $signal = INT ] && [ $call != renameat ] && continue
                prepare
                strace -f -qq -e trace=$call -e inject=$call:signal=$signal:when=$((k > 0 ? k : 1)) -o /dev/null \
                    "$CRESCENT" run "$other" --quiet --out killed >/dev/null 2>&1
                judge "by SIG$signal at $call number $k of $many"
            done
        done
    done
fi

prepare
expect 0 "$CRESCENT" run "$other" --quiet --out killed
judge "never"
[ "${reached:-0}" = 1 ] || die "the new outputs never came"
find killed -name '.crescent-stage-*' | grep -q . && die "stages are left: $(ls -A killed)"
exit 0
