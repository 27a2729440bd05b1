#!/bin/bash
# Every code block of the documentation but README.md, which first.sh has, runs as it is printed
# (tests/system/docs/run_blocks.py); errors on a page are found.
. "$(dirname "$0")/common.sh"
. "$here/docs/python.sh"
python=$(page_python)
run_blocks() {
    python3 "$here/docs/run_blocks.py" --source "$CRESCENT_SOURCE" --build "$CRESCENT_BUILD" --python "$python" \
        --work "$work/pages" "$@"
}

# One wrong block of each language, each found by its line; a mark is counted, a correct block runs.
cat >wrong.md <<'PAGE'
```sh
crescent schema >schema.txt
crescent run nowhere.toml
```
```sh
crescent list >list.txt  # exit 1
crescent run nowhere.toml  # exit 2
```
```sh
crescent run nowhere.toml  # exit 2: a correct block
test -s list.txt
```
```python
x = 1

print(undefined)
```
```python
print(x, 2.0004)
```
```text
1 3
```
```python
print(x, 2.0004)
```
```text
1 2
```
```python
def test_x():
    assert 1 == 2
```
```toml
[image]
widht = 9
```
```json
{"a": 1,}
```
```cpp
int unused(int x) { return 1; }
```
```c
// twice.c
int twice(int x) { return 2 * x }
```
```cmake
project(x LANGUAGES CXX)
find_package(nowhere REQUIRED)
```
```sh
sbatch job.sh
```

Not run in the tests: needs a cluster.

```sh
sbatch job.sh  # exit 127
```
PAGE
expect 1 run_blocks wrong.md
wanted="1 5 13 18 30 34 38 41 44 48"
[ -n "$python" ] || wanted="1 5 34 38 41 44 48"
found=$(grep -o '^wrong.md:[0-9]*' printed | cut -d: -f2 | xargs)
[ "$found" = "$wanted" ] || die "wrong blocks at lines $wanted; found at $found:
$(cat printed)"
grep -q "line 16: NameError" printed || [ -z "$python" ] || die "no line of the page: $(cat printed)"
grep -q "^  wrong.md:52: needs a cluster$" printed || die "the mark is not counted: $(cat printed)"
printf '```\nx\n```\n' >bare.md
printf 'As\n\n    crescent list\n' >indented.md
for page in bare indented; do
    expect 1 run_blocks $page.md
    grep -q "^$page.md:[13]: .*expected one" printed || die "$page.md is not refused: $(cat printed)"
done

mapfile -t pages < <(find "$CRESCENT_SOURCE"/{CONTRIBUTING.md,docs,examples} -name '*.md' | sort)
run_blocks "${pages[@]}"
