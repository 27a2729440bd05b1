// The estimator, as src/estimator/kernel_body.h: one pixel a fragment, samples [first_sample, first_sample + samples) one
// after another, X = f L_i cos / p with f = rho_d/pi + rho_s lobe. An arm's file stands before this one.
//
//   sums    sum of g = cos/p, of g lobe, of (X - pivot)^2; largest X
//   counts  samples under the horizon, samples that met a disk, bad ones
//   met     sum of g and of g lobe over the samples that met disk first_recorded + 2k (x, y) and the next (z, w)
//
// Sums run in float over 16 samples, over 16 such blocks and over what is left, so that a draw of 4096 samples loses no more
// than three times 16 roundings (relative error < 3e-6, a tenth of that as a rule); the program adds draws up in double.
#include "brdf.glsl"
#include "disk_hit.glsl"
#include "random.glsl"

uniform ivec2 corner;        // of this framebuffer in the image, pixels
uniform int image_width;     // pixels
uniform uint seed;
uniform int first_sample, samples;
uniform int first_recorded;  // the first disk whose sums are written

layout(location = 0) out vec4 sums;
layout(location = 1) out vec4 counts;
#if RECORDED > 0
layout(location = 2) out vec4 met[(RECORDED + 1) / 2];
#endif

struct Sums {
    vec3 all;                  // g, g lobe, (X - pivot)^2
    vec2 disk[RECORDED_SLOTS];  // an even number, 2 at least
};
Sums block, middle, top;
float largest = 0.0;
uint horizon = 0u, hits = 0u, bad = 0u;
Surroundings around;

Sums no_sums() {
    Sums s;
    s.all = vec3(0.0);
    for (int k = 0; k < RECORDED_SLOTS; ++k) s.disk[k] = vec2(0.0);
    return s;
}
void add(inout Sums to, inout Sums from) {  // and clears what was added
    to.all += from.all;
    for (int k = 0; k < RECORDED_SLOTS; ++k) to.disk[k] += from.disk[k];
    from = no_sums();
}

float lobe_of(vec3 wo, vec3 wi) {
#if LOBE == 1
    return lobe_phong(wo, wi, site.s);
#elif LOBE == 2
    return lobe_blinn_phong(wo, wi, site.s);
#elif LOBE == 3
    return lobe_ggx(wo, wi, site.alpha);
#else
    return 0.0;
#endif
}

// A sample that met a disk: the nearest disk first, then what stands before it. Returns X where one was met, else x.
float meet(vec3 wi, float g, float lobe, float x) {
    float nearest = 1e30;
    int index = -1;
    for (int k = 0; k < DISKS; ++k) {
        float v;
        bool hit = meets_disk(facing[k], wi, v);
        float t = hit ? facing[k].k / v : 1e30;
        index = t < nearest ? k : index;
        nearest = min(t, nearest);
    }
    if (index < 0 || blocked(around.point, to_world(around.frame, wi), nearest, around.shape)) return x;
    for (int k = 0; k < RECORDED; ++k)
        if (index == first_recorded + k) block.disk[k] += g * vec2(1.0, lobe);
    for (int k = 0; k < DISKS; ++k)
        if (index == k) x = g * (disk_worth[k].x + lobe * disk_worth[k].y);
    ++hits;
    return x;
}

// X of one drawn direction, adding what it carries to the sums.
float carry(Drawn drawn, float weight) {
    float cosine = drawn.wi.z;
    bool down = cosine <= 0.0;  // false for NaN, which must reach the sums and be counted
    bool up = !down && drawn.pdf != 0.0;
    horizon += down ? 1u : 0u;
    float g = up ? weight * (cosine / drawn.pdf) : 0.0;
    float lobe = up ? lobe_of(site.wo, drawn.wi) : 0.0;
    block.all.xy += g * vec2(1.0, lobe);
    float x = g * (around.fill_d + lobe * around.fill_s);
    bool any = false;
    for (int k = 0; k < DISKS; ++k) {
        float v;
        any = meets_disk(facing[k], drawn.wi, v) || any;
    }
    if (any && up) x = meet(drawn.wi, g, lobe, x);
    return x;
}

void take(uint pixel, uvec4 h, uint sample_index) {
    bool odd = (sample_index & 1u) == 1u;
    vec2 u = unit_floats(odd ? h.zw : h.xy);
#ifdef TWO_TECHNIQUES
    uvec4 second = draws(pixel, sample_index >> 1u, 1u, seed);
    Drawn a = sample_mixture(site.wo, u), b = sample_light_area(site.wo, unit_floats(odd ? second.zw : second.xy));
    float x = carry(a, weight_of(a.pdf, pdf_light_area(site.wo, a.wi)));
    x += carry(b, weight_of(b.pdf, pdf_mixture(site.wo, b.wi)));
#else
    float x = carry(sample_arm(site.wo, u), 1.0);
#endif
    block.all.z += sqr(x - around.pivot);
    largest = x > largest ? x : largest;
    // NaN, infinite and negative numbers alone have bits from 0x7f800000 up; -0 is no negative number.
    uint b_x = floatBitsToUint(x);
    bad += b_x > 0x7f7fffffu && b_x != 0x80000000u ? 1u : 0u;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    around = load_site(at);
    for (int k = 0; k < DISKS; ++k) facing[k] = facing_disk(disks[k]);
    uint pixel = uint((corner.y + at.y) * image_width + corner.x + at.x);
    bool mine = around.kind == float(LOBE);
    block = no_sums(), middle = no_sums(), top = no_sums();
    int j = first_sample, end = first_sample + (mine ? samples : 0);
    for (int blocks = 1; j < end; ++blocks) {
        int block_end = min((j / 16 + 1) * 16, end);
        while (j < block_end) {  // one hash serves an even sample and the odd one after it
            uvec4 h = draws(pixel, uint(j) >> 1u, 0u, seed);
            if ((j & 1) == 0) {
                take(pixel, h, uint(j));
                if (++j == block_end) break;
            }
            take(pixel, h, uint(j));
            ++j;
        }
        add(middle, block);
        if (blocks % 16 == 0) add(top, middle);
    }
    add(top, middle);
    if (!mine) discard;
    sums = vec4(top.all, largest);
    counts = vec4(float(horizon), float(hits), float(bad), 0.0);
#if RECORDED > 0
    for (int k = 0; k < (RECORDED + 1) / 2; ++k) met[k] = vec4(top.disk[2 * k], top.disk[2 * k + 1]);
#endif
}
