// Random numbers as a pure function of (seed, pixel, sample, dimension): src/math/simd/random.h in GLSL, bit for bit.
// pcg4d of Jarzynski & Olano 2020, "Hash Functions for GPU Rendering", JCGT 9(3).

uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// The four integers behind samples 2 `pair` (x, y) and 2 `pair` + 1 (z, w); `block` counts pairs of dimensions.
uvec4 draws(uint pixel, uint pair, uint block, uint seed) { return pcg4d(uvec4(pixel, pair, block, seed)); }

// u = (2k + 1) / 2^24 from the upper 23 bits; exact in a float.
vec2 unit_floats(uvec2 h) { return vec2(ivec2((h >> 8u) | 1u)) * 5.9604644775390625e-8; }
