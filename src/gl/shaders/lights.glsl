// Lights other than disks, as src/scene/lights/sphere.h and rectangle.h, in a surface point's local frame: the meaning
// of a, b, c and the numbers depends on the kind and is documented there. SPHERE_LIGHT and RECTANGLE_LIGHT are indices
// in the list of kinds.
#include "frame.glsl"

struct LocalLight {
    int kind;
    float power;  // its share in the choice among lights
    vec3 a, b, c;
    float number[7];
};
LocalLight others[OTHER_SLOTS];
vec2 light_worth[OTHER_SLOTS];  // like disk_worth

// A direction towards a light and its density in 1/sr; 0 if the light does not reach the point.
struct Aimed {
    vec3 wi;
    float pdf;
};

bool shines(LocalLight l) { return l.number[l.kind == SPHERE_LIGHT ? 3 : 6] > 0.0; }

bool meets_sphere_light(LocalLight l, vec3 w, out float t) {
    float along = dot(l.a, w);
    vec3 off = l.a - w * along;
    float rest = sqr(l.number[0]) - dot(off, off);
    t = l.number[5] * (l.number[4] + l.number[0]) / (along + sqrt(max(rest, 0.0)));
    return rest >= 0.0 && along > 0.0 && shines(l);
}
bool meets_rectangle_light(LocalLight l, vec3 w, out float t) {
    vec3 n = cross(l.b, l.c);
    float height = dot(l.a, n), v = dot(w, n);
    bool ahead = height * v > 0.0;
    t = height / (ahead ? v : 1.0);
    vec3 off = w * height - l.a * v;
    return abs(dot(off, l.b)) <= l.number[0] * abs(v) && abs(dot(off, l.c)) <= l.number[1] * abs(v) && ahead &&
        shines(l);
}
// Returns whether w meets it, and at which distance.
bool meets_other(LocalLight l, vec3 w, out float t) {
    return l.kind == SPHERE_LIGHT ? meets_sphere_light(l, w, t) : meets_rectangle_light(l, w, t);
}

// By area.
// ---------------------------------------------------------------------------------------------------------------
float sphere_area_density(LocalLight l) { return (0.5 / pi) / (sqr(l.number[0]) * max(l.number[1], 1e-12)); }
float rectangle_area_density(LocalLight l) { return 0.25 / (l.number[0] * l.number[1]); }

Aimed sphere_by_area(LocalLight l, vec2 u) {
    float drop = u.x * l.number[1], z = 1.0 - drop, r = l.number[0] * sqrt(drop * (2.0 - drop));
    SinCos phi = sincos_turns(u.y);
    vec3 at = vec3(r * phi.cos, r * phi.sin, l.number[5] + l.number[0] * drop);
    vec3 y = to_world(frame_about(l.a * (1.0 / l.number[4])), at);
    float t2 = dot(y, y), t = sqrt(t2);
    float cosine = max((z * l.number[5] - l.number[0] * drop) / t, 1e-7);
    return Aimed(y * (1.0 / t), shines(l) ? sphere_area_density(l) * t2 / cosine : 0.0);
}
Aimed rectangle_by_area(LocalLight l, vec2 u) {
    vec3 y = l.a + l.b * (l.number[0] * (2.0 * u.x - 1.0)) + l.c * (l.number[1] * (2.0 * u.y - 1.0));
    float t2 = dot(y, y), t = sqrt(t2), height = abs(dot(l.a, cross(l.b, l.c)));
    return Aimed(y * (1.0 / t), shines(l) ? rectangle_area_density(l) * t2 * t / max(height, 1e-30) : 0.0);
}
Aimed other_by_area(LocalLight l, vec2 u) {
    return l.kind == SPHERE_LIGHT ? sphere_by_area(l, u) : rectangle_by_area(l, u);
}
float other_area_pdf(LocalLight l, vec3 w) {
    float t;
    if (!meets_other(l, w, t)) return 0.0;
    if (l.kind == SPHERE_LIGHT) {
        float cosine = max((dot(l.a, w) - t) / l.number[0], 1e-7);
        return sphere_area_density(l) * sqr(t) / cosine;
    }
    return rectangle_area_density(l) * sqr(t) / max(abs(dot(w, cross(l.b, l.c))), 1e-30);
}

// By solid angle.
// --------------------------------------------------------------------------------------------------------
float sphere_angle_density(LocalLight l) { return shines(l) ? (0.5 / pi) / max(l.number[2], 1e-30) : 0.0; }

Aimed sphere_by_angle(LocalLight l, vec2 u) {
    float drop = u.x * l.number[2];  // 1 - cos
    float sin = sqrt(drop * (2.0 - drop));
    SinCos phi = sincos_turns(u.y);
    vec3 axis = l.a * (1.0 / l.number[4]);
    vec3 e = to_world(frame_about(axis), vec3(sin * phi.cos, sin * phi.sin, -drop));
    return Aimed(axis + e, sphere_angle_density(l));
}
// Urena, Fajardo & King 2013; points of the rectangle if its solid angle is too small for floats.
Aimed rectangle_by_angle(LocalLight l, vec2 u) {
    if (!(l.number[2] > 0.0)) return rectangle_by_area(l, u);
    const float tiny = 1e-30;
    vec3 n = cross(l.b, l.c);
    float z = dot(l.a, n), z2 = sqr(z), across = dot(l.a, l.b), up = dot(l.a, l.c);
    SinCos d = sincos_turns((l.number[3] + u.x * l.number[2]) * (0.5 / pi));
    float sin2 = sqr(d.sin), b0 = l.number[4];
    float sum = l.number[5] - sin2 / (1.0 + max(d.cos, -0.9999)) * b0;  // b0 cos D + b1
    float x_there = abs(z) * d.sin / sqrt(max(sqr(sum) - (1.0 - sqr(b0)) * sin2, tiny));
    float x = min(max(x_there, across - l.number[0]), across + l.number[0]);
    float far2 = sqr(x) + z2, low = up - l.number[1], high = up + l.number[1];
    float h0 = low / sqrt(far2 + sqr(low)), h1 = high / sqrt(far2 + sqr(high)), h = h0 + u.y * (h1 - h0);
    float y_there = h * sqrt(far2 / max((1.0 - h) * (1.0 + h), tiny));
    float y = min(max(y_there, low), high);
    vec3 to = l.b * x + l.c * y + n * z;
    return Aimed(to * (1.0 / sqrt(max(dot(to, to), tiny))), 1.0 / l.number[2]);
}
Aimed other_by_angle(LocalLight l, vec2 u) {
    return l.kind == SPHERE_LIGHT ? sphere_by_angle(l, u) : rectangle_by_angle(l, u);
}
float other_angle_pdf(LocalLight l, vec3 w) {
    float t;
    if (l.kind == SPHERE_LIGHT) return meets_other(l, w, t) ? sphere_angle_density(l) : 0.0;
    if (l.number[2] > 0.0) return meets_other(l, w, t) ? 1.0 / max(l.number[2], 1e-30) : 0.0;
    return other_area_pdf(l, w);
}
