# Shell functions of ./test: run tests and count them into `passed` and `failures`. Sourced after setup.sh.

passed=0 failures=0 skipped=0

add() { passed=$((passed + $1)) failures=$((failures + $2)); }

# sum NAME FILE...: the sum of an attribute over the opening <testsuites> of GoogleTest's XML.
sum() {
    local name=$1
    shift
    awk -v name="$name" '
        /<testsuites / && match($0, " " name "=\"[0-9]+\"") {
            total += substr($0, RSTART + length(name) + 3, RLENGTH - length(name) - 4)
        }
        END { print total + 0 }
    ' "$@"
}

# failed_tests LOG: for each test of ctest that failed, its line and the last lines of its output.
failed_tests() {
    awk -v most=16 '
        function tell() {
            for (i = count > most ? count - most : 0; i < count; ++i) print "    " said[i % most]
            count = in_one = 0
        }
        /^ *[0-9]+\/[0-9]+ +Test +#/ {
            tell()
            if (/\*\*\*(Failed|Timeout|Exception|Not Run)/) { print; in_one = 1 }
            next
        }
        /^ +Start +[0-9]+:/ || /% tests passed/ { tell(); next }
        in_one && NF { said[count++ % most] = $0 }
        END { tell() }
    ' "$1"
}

# longest LOG: the five slowest tests of ctest.
longest() {
    sed -nE 's/^ *[0-9]+\/[0-9]+ +Test +#[0-9]+: +([^ ]+) .* ([0-9]+)\.[0-9]+ sec.*/\2 \1/p' "$1" | sort -rn | head -n 5 |
        awk '{ printf "%s%s %d s", (NR > 1 ? ", " : ""), $2, $1 }'
}

# follow_tests NAME: copies ctest's lines to stdout (the log) and its count to the terminal.
follow_tests() {
    local line
    progress_shown=$SECONDS
    while IFS= read -r line; do
        printf '%s\n' "$line"
        [[ $line =~ ^\ *([0-9]+)/([0-9]+)\ +Test ]] &&
            progress "testing $1" "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]} tests and programs"
    done
    end_progress
}

# check PRESET [OPTION...]: runs ctest on its build. A test program counts as its test cases, a script as one.
check() {
    local dir log xml start=$SECONDS before=$passed broken=$failures
    dir=$(binary_dir "$1")
    log="$log_dir/$1-tests.log"
    rm -rf "$dir/results"
    mkdir -p "$dir/results"
    say "testing $1 (log: ${log#"$root"/})"
    ctest --test-dir "$dir" -j "$(nproc)" --output-on-failure "${@:2}" 2>&1 | follow_tests "$1" >"$log"
    # Lines such as " 3/12 Test  #5: unit-1 .......   Passed    0.41 sec".
    while read -r name outcome; do
        xml="$dir/results/${name//\//-}.xml"  # unit-check/sources writes unit-check-sources.xml
        if [ -f "$xml" ]; then
            local all bad
            all=$(sum tests "$xml") bad=$(($(sum failures "$xml") + $(sum errors "$xml")))
            # A program that fails after its last test has failed too.
            [ "$outcome" != passed ] && [ "$bad" -eq 0 ] && bad=1
            add $((all - bad)) "$bad"
        elif [ "$outcome" = passed ]; then add 1 0
        elif [ "$outcome" = failed ]; then add 0 1
        else skipped=$((skipped + 1)) && say "  skipped: $name"
        fi
    done < <(sed -nE 's/^ *[0-9]+\/[0-9]+ +Test +#[0-9]+: +//p' "$log" |
        sed -nE 's/^([^ ]+) .*(Passed|Skipped|Failed|Timeout|Exception|Not Run).*/\1 \2/p' |
        sed -E 's/Passed$/passed/; s/Skipped$/skipped/; s/(Failed|Timeout|Exception|Not Run)$/failed/')
    # A suite that never ran is a failure of its own.
    [ $((passed - before + failures - broken)) -gt 0 ] || add 0 1
    say "  $((passed - before)) passed, $((failures - broken)) failed in $((SECONDS - start)) s; longest: $(longest "$log")"
    [ "$failures" -eq "$broken" ] || failed_tests "$log" >&2
}

# fuzz PRESET TARGET SECONDS [CORPUS]: no finding in that time counts as one test. The corpus of NAME_fuzz is
# tests/fuzz/NAME; CORPUS is a second one. Always the same seed: what fails is due to the change that is tested.
fuzz() {
    local target log found corpus
    target="$(binary_dir "$1")/tests/fuzz/$2"
    log="$log_dir/$2.log"
    corpus="$root/tests/fuzz/${2%_fuzz}"
    [ -x "$target" ] || { skipped=$((skipped + 1)) && say "  skipped: $2"; return; }
    found="$(binary_dir "$1")/tests/fuzz/found-$2"
    mkdir -p "$found"
    say "fuzzing $2 for $3 s"
    if "$target" -seed=1 -max_total_time="$3" -timeout=10 -rss_limit_mb=2048 -artifact_prefix="$found/" \
        -dict="$root/tests/fuzz/experiment.dict" "$found" "$corpus" "${@:4}" >"$log" 2>&1; then
        add 1 0
    else
        add 0 1
        tail -n 30 "$log" >&2
    fi
}
