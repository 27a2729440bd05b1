// Orthonormal frames, as src/math/simd/frame.h: n = +z, wo is given, wi is drawn, both leave the surface.
#include "math.glsl"

struct Frame {
    vec3 t, b, n;
};
vec3 to_world(Frame f, vec3 w) { return f.t * w.x + f.b * w.y + f.n * w.z; }

// A frame about the unit vector n without a pole: Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
Frame frame_about(vec3 n) {
    float sign = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (sign + n.z);
    float b = n.x * n.y * a;
    return Frame(vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), vec3(b, sign + n.y * n.y * a, -n.y), n);
}

// R = reflect(-wo, n) in the local frame.
vec3 mirror(vec3 wo) { return vec3(-wo.xy, wo.z); }
