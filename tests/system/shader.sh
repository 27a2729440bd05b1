#!/bin/bash
# `crescent check FILE.wgsl|glsl|hlsl|slang`: samplers in shaders are right, planted faults are found, and what cannot be
# compiled or evaluated is an error with its place; nothing is left over.
. "$(dirname "$0")/common.sh"

for python in "${CRESCENT_PYTHON:-python3}" "${CRESCENT_BUILD:-.}/python-test/bin/python"; do
    "$python" -c 'import numpy, wgpu' 2>/dev/null && export CRESCENT_PYTHON=$python && break
done
"${CRESCENT_PYTHON:-python3}" -c 'import numpy, wgpu' 2>/dev/null || skip "no Python with numpy and wgpu"
export PYTHONPATH="$CRESCENT_SOURCE/python" XDG_CACHE_HOME="$work/cache" TMPDIR="$work/tmp"
mkdir tmp
"$CRESCENT" check --device list >printed 2>said || skip "$(cat said)"
[ -s printed ] || die "no adapter is listed"
cp printed adapters
languages=wgsl
if command -v glslangValidator >/dev/null; then languages+=" glsl hlsl"; fi
if "$CRESCENT_PYTHON" -c 'import crescent_shader.compilers as c; c.slangc()' 2>/dev/null; then languages+=" slang"; fi
lobes="$CRESCENT_SOURCE/tests/known_samplers/shaders/lobes"
check() { "$CRESCENT" check --quiet --wo 40 "$@"; }

# The device is named, once.
"$CRESCENT" check "$lobes.wgsl" --wo 40 --sample 'wi = cosine_sample(u)' --pdf 'cosine_pdf(wi)' >printed 2>said
[ "$(grep -c "^lobes is evaluated on .*, single precision$" said)" -eq 1 ] || die "no device: $(cat said)"

# Right samplers, each with what it needs.
for language in $languages; do
    file=$lobes.$language
    expect 0 check "$file" --sample 'wi = cosine_sample(u); pdf = cosine_pdf(wi)' --pdf 'cosine_pdf(wi)' --f 1.0/PI \
        --json right.json
    grep -q '"state": *"right"' right.json || die "no result: $(cat right.json)"
    [ -s said ] && die "--quiet is not quiet: $(cat said)"
    expect 0 check "$file" --sample 'wi = mixture_sample(wo, u3, u, alpha)' --pdf 'mixture_pdf(wo, wi, alpha)' \
        --f 'mixture_f(wo, wi, alpha)' --set alpha=0.3 --numbers 3
    expect 1 check "$file" --sample 'wi = ggx_sample(wo, u, alpha)' --pdf 'ggx_pdf(wo, wi, alpha) * 1.03' --set alpha=0.3
    grep -q "normalised" printed || die "a factor of 1.03 has no verdict: $(cat printed)"
done
# What the compilers made is kept; a damaged file is made again.
if [[ $languages = *glsl* ]]; then
    for file in "$work"/cache/crescent/shaders/*; do printf damaged >"$file"; done
    expect 0 check "$lobes.glsl" --sample 'wi = cosine_sample(u)' --pdf 'cosine_pdf(wi)'
fi
if [[ $languages = *slang* ]]; then  # what the others lack: methods, interfaces, generics, initialiser lists
    cat >material.slang <<'S'
interface IBsdf { float3 sample(float2 u); float pdf(float3 wi); }
struct Lambert : IBsdf {
    float scale;
    float3 sample(float2 u) { float r = sqrt(u.x), a = 6.2831853 * u.y; return float3(r * cos(a), r * sin(a), sqrt(1 - u.x)); }
    float pdf(float3 wi) { return scale * max(wi.z, 0) / 3.14159265; }
}
float density<T : IBsdf>(T bsdf, float3 wi) { return bsdf.pdf(wi); }
S
    expect 0 check material.slang --sample 'wi = m.sample(u); pdf = m.pdf(wi)' --pdf 'density(m, wi)' \
        --let 'Lambert m = { 1.0 }'
    expect 1 check material.slang --sample 'wi = m.sample(u)' --pdf 'm.pdf(wi)' --let 'Lambert m = { 1.03 }'
    printf 'float3 a(float2 u) {\n    return float3(u, y);\n}\n' >bad.slang
    expect 2 check bad.slang --sample 'wi = a(u)' --pdf 1.0
    grep -qF "bad.slang:2:" said || die "a mistake in Slang has no place: $(cat said)"
fi
file=$lobes.wgsl
expect 0 check "$file" --sample 'wi = hg_sample(wo, u, g)' --pdf 'hg(wo, wi, g)' --f-cos 'hg(wo, wi, g)' --set g=0.6 \
    --domain sphere --sides both
expect 0 "$CRESCENT" check --quiet "$file" --sample 'wi = rectangle_sample(u)' --pdf 'rectangle_pdf(wi)' --sides none
expect 0 check "$file" --sample 'wi = glass_sample(wo, u3, u, alpha, n)' --pdf 'glass_pdf(wo, wi, alpha, n)' \
    --f-cos 'glass_f_cos(wo, wi, alpha, n)' --set alpha=0.4 --set n=1.5 --numbers 3 --domain sphere --sides both \
    --eta 1.5
expect 0 check "$file" --sample 'wi = phong_sample(wo, u, s)' --pdf 'phong_pdf(wo, wi, s)' --over s=2,60
for value in 2 60; do grep -q "lobes s $value" printed || die "no verdict at s = $value: $(cat printed)"; done

# Faults: the draw's density without its Jacobian, the other side's cosine, a lobe that is never chosen.
expect 1 check "$file" --sample 'wi = ggx_sample(wo, u, 0.3)' \
    --pdf 'ggx_pdf(wo, wi, 0.3) * 4.0 * dot(wo, normalize(wo + wi))'
expect 1 check "$file" --sample 'wi = cosine_sample(u)' --pdf 'wo.z / PI'
expect 1 check "$file" --sample 'wi = mixture_sample(wo, 0.5, u, alpha)' --pdf 'mixture_pdf(wo, wi, alpha)' \
    --set alpha=0.3
expect 1 check "$file" --sample 'wi = cosine_sample(u); pdf = cosine_pdf(wi); wi = wi / 0.0 * 0.0' --pdf 'cosine_pdf(wi)'

# SARIF has the line of the definition of the function that draws: of a declaration before it, a comment, a type on its own
# line, a method, and of statements in comments of the file.
cat >placed.wgsl <<'W'
// crescent: sample = wi = normalize(vec3<f32>(lobe(u), 0.0)) * 0.0 + up(u); pdf = 1.0
/* fn lobe(u: vec2<f32>) -> vec2<f32> {
   is not this one */
// fn lobe(u: vec2<f32>) -> vec2<f32> { nor this one }
fn up(u: vec2<f32>) -> vec3<f32> { return vec3<f32>(0.0, 0.0, lobe(u).x * 0.0 + 1.0); }
fn lobe(u: vec2<f32>) -> vec2<f32> {
    return u + vec2<f32>(0.1);
}
W
expect 1 check ./placed.wgsl --pdf 1.0 --sarif placed.sarif
placed placed.sarif placed.wgsl 6
expect 1 check placed.wgsl --sample 'wi = up(u)' --pdf 1.0 --sarif placed.sarif
placed placed.sarif placed.wgsl 5
if [[ $languages = *glsl* ]]; then
    printf '%s\n' 'vec3 up(vec2 u);' 'vec3' 'up(' '    vec2 u)' '{ return vec3(0.0, 0.0, 1.0); }' >placed.glsl
    expect 1 check placed.glsl --sample 'wi = up(u)' --pdf 1.0 --sarif placed.sarif
    placed placed.sarif placed.glsl 2
fi

# JSON, JUnit and the page name the adapter, the driver and the precision, also of both sides of a comparison.
expect 0 check "$file" --sample 'wi = cosine_sample(u)' --pdf 'cosine_pdf(wi)' --json device.json --junit device.xml \
    --html device.html
expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" <<'END'
import json, sys
import jsonschema
result = json.load(open("device.json"))
jsonschema.Draft202012Validator(json.load(open(sys.argv[1] + "/docs/check.schema.json"))).validate(result)
(device,) = result["devices"]
assert device["arm"] == "lobes" and device["precision"] == "single", device
adapters = open("adapters").read().splitlines()
text = f"{device['name']}, {device['driver']}"
assert text == adapters[0], (text, adapters)
assert f'name="device of lobes" value="{text}, single precision"' in open("device.xml").read()
assert f"evaluated on {text}, single precision" in open("device.html").read()
END
expect 0 check "$file" --sample 'wi = cosine_sample(u)' --pdf 'cosine_pdf(wi)' --against cosine --json device.json
grep -q '"devices"' device.json || die "a comparison names no device"

# From C++.
if [ -n "${CRESCENT_SHADER_SUITE:-}" ]; then
    suite() { (cd "${lobes%/*}" && "$CRESCENT_SHADER_SUITE" "--gtest_filter=$1"); }
    expect 0 suite 'Right.*'
    expect 1 suite 'Wrong.*'
    grep -q "normalised is wrong" printed || die "a factor of 1.03 has no verdict in C++: $(cat printed)"
    grep -q "Actual: mine" printed || die "the sampler is not named: $(cat printed)"
    expect 1 suite 'Mistake.*'
    grep -q -- "--sample:1:6: " printed || die "a mistake has no place in C++: $(cat printed)"
    expect 1 env CRESCENT_PYTHON=/nowhere/python bash -c "cd '${lobes%/*}' && '$CRESCENT_SHADER_SUITE' --gtest_filter='Right.*'"
    grep -qF "pip install 'crescent-bench[shader]'" printed || die "a missing package has no name: $(cat printed)"
fi

# What surrounds the functions: comments of the file, random numbers, another axis, a world frame, uniforms.
cat >own.wgsl <<'W'
// crescent: sample = wi = lobe(&state); pdf = density(wi)
// crescent: pdf    = density(wi)
// crescent: let    = var state = 1u
// crescent: random = rand
override width: f32 = 2.0;
fn rand(state: ptr<function, u32>) -> f32 { *state = *state * 747796405u + 1u; return f32(*state) / 4294967296.0; }
fn lobe(state: ptr<function, u32>) -> vec3<f32> {
    let r = sqrt(rand(state));
    let a = 6.2831853 * rand(state);
    return vec3<f32>(r * cos(a), sqrt(1.0 - r * r), r * sin(a));
}
fn density(wi: vec3<f32>) -> f32 { return wi.y * width / 3.14159265; }
W
expect 0 check own.wgsl --up y --set width=1.0
expect 1 check own.wgsl --up y
expect 1 check own.wgsl --set width=1.0
expect 2 check own.wgsl --up y --numbers 1
grep -q "takes 2 random numbers" said || die "the second number is not reported: $(cat said)"
printf '\357\273\277// crescent: sample = wi = draw(u)\nfn draw(u: vec2<f32>) -> vec3<f32> {\n    return vec3<f32>(sqrt(u.x) * cos(6.2831853 * u.y), sqrt(u.x) * sin(6.2831853 * u.y), sqrt(1.0 - u.x));\n}\n' >marked.wgsl
expect 0 check marked.wgsl --pdf 'wi.z / PI' --let 'const PI = 3.14159265;'
expect 0 check "$file" --frame world --sample 'wi = about(n, cosine_sample(u))' --pdf 'dot(wi, n) / PI'

# Bad input: a place, exit 2, in one line.
bad() {
    local words=$1
    shift
    expect 2 check "$@"
    [ "$(wc -l <said)" -eq 1 ] || die "not one line: $(cat said)"
    grep -qF -- "$words" said || die "it does not say '$words': $(cat said)"
}
printf 'fn a(u: vec2<f32>) -> vec3<f32> {\n    return vec3<f32>(u, y);\n}\n' >bad.wgsl
bad "bad.wgsl:2:25: " bad.wgsl --sample 'wi = a(u)' --pdf 1.0
bad "--sample:1:6: " "$file" --sample 'wi = cosine_sampel(u)' --pdf 1.0
bad "--pdf:2:" "$file" --sample 'wi = cosine_sample(u)' --pdf $'1.0 +\n)'
bad "expected --sample" "$file"
sed 's/density(wi)$/densty(wi)/' own.wgsl >typing.wgsl
bad "typing.wgsl:1:48: " typing.wgsl
bad "no such file" nowhere.wgsl --sample 'wi = a(u)'
bad "expected NAME=VALUE" "$file" --sample 'wi = cosine_sample(u)' --pdf 1.0 --set alpha=x
bad "expected 1 to 8" "$file" --sample 'wi = cosine_sample(u)' --pdf 1.0 --numbers 9
bad "needs a shader" cosine --sample 'wi = a(u)'
bad "no such adapter" "$file" --sample 'wi = cosine_sample(u)' --pdf 1.0 --device nowhere
printf '// crescent: smaple = wi = a(u)\n' >key.wgsl
bad "key.wgsl:1: no key 'smaple'" key.wgsl
printf '@group(0) @binding(1) var<uniform> time: f32;\nfn a(u: vec2f) -> vec3f { return vec3f(u, time); }\n' >time.wgsl
bad "read 'time'" time.wgsl --sample 'wi = a(u)' --pdf 1.0
printf 'fn a(u: vec2f) -> vec3f { return vec3f(u, "); }\n' >quote.wgsl
bad "quote.wgsl:1:" quote.wgsl --sample 'wi = a(u)' --pdf 1.0
{ cat "$file" && yes '// a long file' | head -c 1000000; } >long.wgsl
expect 0 check long.wgsl --sample 'wi = cosine_sample(u)' --pdf 'cosine_pdf(wi)'
# A loop without an end: Mesa's CPU driver gives up after 65536 turns, others are ended with their process.
printf 'fn a(u: vec2f) -> vec3f { var x = u.x; while (x < 2.0) { x = fract(x + u.y); } return vec3f(x); }\n' >loop.wgsl
timeout 120 "$CRESCENT" check --quiet --wo 40 loop.wgsl --sample 'wi = a(u)' --pdf 1.0 --patience 5 --timeout 10 \
    >printed 2>said && die "an endless loop passes: $(cat printed)"
[ $? -ne 124 ] || die "an endless loop does not end"
if [[ $languages == *glsl* ]]; then
    printf 'uniform sampler2D sky;\nvec3 a(vec2 u) { return texture(sky, u).xyz; }\nvoid main() {}\n' >sky.glsl
    bad "read 'sky'" sky.glsl --sample 'wi = a(u)' --pdf 1.0
    printf 'vec3 a(vec2 u) {\n    return vec3(u, y);\n}\n' >bad.glsl
    bad "bad.glsl:2: " bad.glsl --sample 'wi = a(u)' --pdf 1.0
    cp bad.glsl bad.hlsl
    bad "bad.hlsl:1" bad.hlsl --sample 'wi = a(u)' --pdf 1.0
    expect 3 env PATH= "$CRESCENT" check "$lobes.glsl" --sample 'wi = cosine_sample(u)' --pdf 1.0
    grep -q "glslang-tools" said || die "the package is not named: $(cat said)"
fi
if ! /usr/bin/python3 -c 'import wgpu' 2>/dev/null; then
    expect 3 env CRESCENT_PYTHON=/usr/bin/python3 "$CRESCENT" check "$file" --sample 'wi = cosine_sample(u)' --pdf 1.0
    grep -q "crescent-bench\[shader\]" said || die "the package is not named: $(cat said)"
fi

# The page has the same text around the snippets.
"$CRESCENT_PYTHON" -m crescent_shader.page | cmp - "$CRESCENT_SOURCE/apps/web/shader_text.json" ||
    die "apps/web/shader_text.json is old: PYTHONPATH=python python -m crescent_shader.page >apps/web/shader_text.json"

# Ten at once; then nothing is left.
for i in $(seq 10); do check "$file" --sample 'wi = cosine_sample(u)' --pdf 'cosine_pdf(wi)' --timeout 100 --seed "$i" \
    >"at-once.$i" 2>&1 & done
for job in $(jobs -p); do wait "$job" || die "one of ten checks at once fails: $(cat at-once.*)"; done
[ -z "$(ls tmp)" ] || die "left over: $(ls tmp)"
! ps -eo args | grep -F "crescent_shader" | grep -F "$work" | grep -qv grep || die "a host still runs"
