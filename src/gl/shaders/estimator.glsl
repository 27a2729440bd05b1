// The estimator, as src/render/kernel_body.h: one pixel per fragment, samples [first_sample, first_sample + samples)
// one after another, X = f L_i cos / p with f = rho_d/pi + rho_s lobe. The files of a sampler and of a lobe precede
// this one; LOBE is that lobe's index in the list from 1 on, 0 for none.
//
//
//   sums    sum of g = cos/p, of g lobe, of (X - mean)^2 of this draw's samples; largest X
//   counts  directions below the horizon, directions that met a disk, bad samples; mean X of this draw
//   met     sum of g and of g lobe over the samples that met disk first_recorded + 2k (x, y) and the next (z, w)
//
// Sums run in float over 16 samples, over 16 such blocks and over the rest, so that a draw of 4096 samples has an error
// of at most three times 16 roundings (relative error < 3e-6, usually a tenth of that); the program sums draws in
// double.
#include "shading_point.glsl"
#include "disk_hit.glsl"
#include "random.glsl"

uniform ivec2 corner;     // of this framebuffer in the image, pixels
uniform int image_width;  // pixels
uniform uint seed;
uniform int first_sample, samples;
uniform int first_recorded;  // the first light whose sums are written

layout(location = 0) out vec4 sums;
layout(location = 1) out vec4 counts;
#if RECORDED > 0
layout(location = 2) out vec4 met[(RECORDED + 1) / 2];
#endif

struct Sums {
    vec2 all;                   // g, g lobe
    vec2 disk[RECORDED_SLOTS];  // an even number, at least 2
};
Sums block, middle, top;
float largest = 0.0;
// Mean of X over the blocks so far, sum of (X - mean)^2 over them; sums of X - mean and of its square in the block. The
// first block uses the smaller of the draw's first two X instead of a mean, because outliers are large.
float mean = 0.0, spread = 0.0, block_off = 0.0, block_square = 0.0;
uint horizon = 0u, hits = 0u, bad = 0u;
Surroundings around;

Sums no_sums() {
    Sums s;
    s.all = vec2(0.0);
    for (int k = 0; k < RECORDED_SLOTS; ++k) s.disk[k] = vec2(0.0);
    return s;
}
void add(inout Sums to, inout Sums from) {  // and clears what was added
    to.all += from.all;
    for (int k = 0; k < RECORDED_SLOTS; ++k) to.disk[k] += from.disk[k];
    from = no_sums();
}

// Joins the block's `more` samples to the `before` samples so far: Chan, Golub & LeVeque 1983, "Algorithms for
// Computing the Sample Variance".
void join(float before, float more) {
    float off = block_off / more, all = before + more;
    spread += (block_square - block_off * off) + sqr(off) * (before * more / all);
    mean += off * (more / all);
    block_off = 0.0, block_square = 0.0;
}

float lobe_of(vec3 wo, vec3 wi) {
#if LOBE > 0
    return lobe_here(wo, wi);
#else
    return 0.0;
#endif
}

bool meets(int k, vec3 wi, int aimed, bool met, out float v) {
    bool hit = meets_disk(facing[k], wi, v);
    return k == aimed ? met && v < 0.0 : hit;
}
bool meets_light(int k, vec3 wi, int aimed, bool met, out float t) {
    bool hit = meets_other(others[k], wi, t);
    return DISKS + k == aimed ? met && shines(others[k]) : hit;
}

// Handles a sample that met a disk: finds the nearest disk, or the first one in the file if rounding cannot order them,
// then tests the bodies before it. Returns X if one was met, else x.
float resolve_light_hit(vec3 wi, float g, float lobe, float x, int aimed, bool met) {
    float nearest = 1e30;
    int index = -1;
    for (int k = 0; k < DISKS; ++k) {
        float v;
        bool hit = meets(k, wi, aimed, met, v);
        float t = hit ? facing[k].k / v : 1e30;
        bool nearer = t < nearest * (1.0 - 1e-5);
        index = nearer ? k : index;
        nearest = nearer ? t : nearest;
    }
    for (int k = 0; k < OTHERS; ++k) {
        float t;
        bool nearer = meets_light(k, wi, aimed, met, t) && t < nearest * (1.0 - 1e-5);
        index = nearer ? DISKS + k : index;
        nearest = nearer ? t : nearest;
    }
    if (index < 0 || blocked(around.point, to_world(around.frame, wi), nearest, around.shape)) return x;
    for (int k = 0; k < RECORDED; ++k)
        if (index == first_recorded + k) block.disk[k] += g * vec2(1.0, lobe);
    for (int k = 0; k < DISKS; ++k)
        if (index == k) x = g * (disk_worth[k].x + lobe * disk_worth[k].y);
    for (int k = 0; k < OTHERS; ++k)
        if (index == DISKS + k) x = g * (light_worth[k].x + lobe * light_worth[k].y);
    ++hits;
    return x;
}

// Returns X of one drawn direction and adds its contribution to the sums.
float accumulate(Drawn drawn, float weight, int aimed, bool met) {
    float cosine = drawn.wi.z;
    bool down = cosine <= 0.0;  // false for NaN, which must reach the sums and be counted
    bool up = !down && drawn.pdf != 0.0;
    horizon += down ? 1u : 0u;
    float g = up ? weight * (cosine / drawn.pdf) : 0.0;
    float lobe = up ? lobe_of(shading_point.wo, drawn.wi) : 0.0;
    block.all.xy += g * vec2(1.0, lobe);
    float x = g * (around.fill_d + lobe * around.fill_s);
    bool any = false;
    for (int k = 0; k < DISKS; ++k) {
        float v;
        any = meets(k, drawn.wi, aimed, met, v) || any;
    }
    for (int k = 0; k < OTHERS; ++k) {
        float t;
        any = meets_light(k, drawn.wi, aimed, met, t) || any;
    }
    if (any && up) x = resolve_light_hit(drawn.wi, g, lobe, x, aimed, met);
    return x;
}

void take(uint pixel, uvec4 h, uint sample_index) {
    bool odd = (sample_index & 1u) == 1u;
    vec2 u = unit_floats(odd ? h.zw : h.xy);
#ifdef TWO_TECHNIQUES
    uvec4 second = draws(pixel, sample_index >> 1u, 1u, seed);
    Drawn a = sample_mixture(shading_point.wo, u), b = sample_light_area(shading_point.wo, unit_floats(odd ? second.zw : second.xy));
    float x = accumulate(a, weight_of(a.pdf, pdf_light_area(shading_point.wo, a.wi)), -1, false);
    x += accumulate(b, weight_of(b.pdf, pdf_mixture(shading_point.wo, b.wi)), aimed_disk, aimed_met);
#else
    Drawn drawn = sample_arm(shading_point.wo, u);
    float x = accumulate(drawn, 1.0, aimed_disk, aimed_met);
#endif
    if (sample_index == uint(first_sample)) mean = x;
    block_off += x - mean;
    block_square += sqr(x - mean);
    if (sample_index == uint(first_sample + 1) && x < mean) mean = x, block_off = -block_off;
    largest = x > largest ? x : largest;
    // Only NaN, infinite and negative numbers have bits from 0x7f800000 up; -0 is not negative.
    uint b_x = floatBitsToUint(x);
    bad += b_x > 0x7f7fffffu && b_x != 0x80000000u ? 1u : 0u;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    around = load_point(at);
    for (int k = 0; k < DISKS; ++k) facing[k] = facing_disk(disks[k]);
    uint pixel = uint((corner.y + at.y) * image_width + corner.x + at.x);
    bool mine = around.kind == float(LOBE);
    block = no_sums(), middle = no_sums(), top = no_sums();
    int j = first_sample, end = first_sample + (mine ? samples : 0);
    for (int blocks = 1; j < end; ++blocks) {
        int block_begin = j, block_end = min((j / 16 + 1) * 16, end);
        while (j < block_end) {  // one hash serves an even sample and the odd one after it
            uvec4 h = draws(pixel, uint(j) >> 1u, 0u, seed);
            if ((j & 1) == 0) {
                take(pixel, h, uint(j));
                if (++j == block_end) break;
            }
            take(pixel, h, uint(j));
            ++j;
        }
        join(float(block_begin - first_sample), float(block_end - block_begin));
        add(middle, block);
        if (blocks % 16 == 0) add(top, middle);
    }
    add(top, middle);
    if (!mine) discard;
    sums = vec4(top.all, spread, largest);
    counts = vec4(float(horizon), float(hits), float(bad), mean);
#if RECORDED > 0
    for (int k = 0; k < (RECORDED + 1) / 2; ++k) met[k] = vec4(top.disk[2 * k], top.disk[2 * k + 1]);
#endif
}
