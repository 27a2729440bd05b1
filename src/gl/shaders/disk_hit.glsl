// Finds the disk light that a direction meets first, and whether a body blocks it, as src/render/disk_hit.h: disks in
// the local frame, bodies in the world's. Lengths in m.
//
// Bodies are in order of kind, three vectors each:
//            sphere         box         quad        disk         plane
//   3i       centre         min         corner      centre       point      .w: index of the shape
//   3i + 1   -              max         edge u      normal       normal     .w: radius
//   3i + 2   -              -           edge v      -            -            .w: normal.point of its plane
// Large and far bodies have other numbers, see numbers() in src/scene/shapes/.
#include "shading_point.glsl"

uniform vec4 bodies[3 * BODY_SLOTS];
const int first_box = SPHERES, first_quad = first_box + BOXES, first_plate = first_quad + QUADS,
          first_plane = first_plate + PLATES, end_of_bodies = first_plane + PLANES;

// A disk with its normal turned so that the emitting side faces the surface: c.n < 0. If none does, r2 < 0.
struct FacingDisk {
    vec3 c, n;
    float k, r2;  // c.n; radius squared
};
FacingDisk facing[DISK_SLOTS];

FacingDisk facing_disk(LocalDisk disk) {
    float sign = disk.along > 0.0 ? -1.0 : 1.0;
    return FacingDisk(disk.to_center, disk.normal * sign, disk.along * sign, faces(disk) ? sqr(disk.radius) : -1.0);
}

// With v = w.n the ray meets the disk's plane at (k/v) w, so |k w - v c| <= r |v| needs no division; the
// distance is k/v.
bool meets_disk(FacingDisk disk, vec3 w, out float v) {
    v = dot(w, disk.n);
    vec3 off = w * disk.k - disk.c * v;
    return dot(off, off) <= disk.r2 * (v * v) && v < 0.0;
}

bool within(float t, float lo, float hi) { return t > lo && t < hi; }

// k: 1 / radius; p: its nearest point; n: the normal there.
bool crosses_far_sphere(vec3 p, vec3 n, float radius, float k, vec3 o, vec3 d, float t_max) {
    vec3 v = o - p, across = v - d * dot(v, d);
    float nd = dot(n, d), b = nd + k * dot(v, d);
    float disc = sqr(nd) - k * (2.0 * dot(n, across) + k * dot(across, across));
    float root = sqrt(max(disc, 0.0)), eps = t_max * 1e-5;
    float sum = b > 0.0 ? -(b + root) : root - b;
    float near = (k * dot(v, v) + 2.0 * dot(n, v)) / (sum == 0.0 ? 1e-30 : sum);
    return disc > 0.0 && (within(near, eps, t_max) || within(sum * radius, eps, t_max));
}

bool crosses_sphere(vec3 center, float radius, vec3 o, vec3 d, float t_max) {
    vec3 c = center - o;
    float along = dot(c, d);
    float disc = sqr(along) - (dot(c, c) - sqr(radius));
    float root = sqrt(max(disc, 0.0)), eps = t_max * 1e-5;
    return disc > 0.0 && (within(along - root, eps, t_max) || within(along + root, eps, t_max));
}

// Body i, a sphere.
bool crosses_ball(int i, vec3 o, vec3 d, float t_max) {
    vec3 at = bodies[3 * i].xyz, n = bodies[3 * i + 1].xyz;
    float radius = bodies[3 * i + 1].w, k = bodies[3 * i + 2].w;
    return k > 0.0 ? crosses_far_sphere(at, n, radius, k, o, d, t_max) : crosses_sphere(at, radius, o, d, t_max);
}

bool crosses_box(vec3 lo, vec3 hi, vec3 o, vec3 d, float t_max) {
    vec3 safe = mix(vec3(1e-20), d, greaterThan(abs(d), vec3(1e-20)));  // no 0/0
    vec3 t0 = (lo - o) / safe, t1 = (hi - o) / safe;
    vec3 entry = min(t0, t1), leave = max(t0, t1);
    float near = max(max(entry.x, entry.y), entry.z), far = min(min(leave.x, leave.y), leave.z), eps = t_max * 1e-5;
    return near < far && (within(near, eps, t_max) || within(far, eps, t_max));
}

// Returns where a ray meets the plane n.p = offset.
float plane_distance(float offset, vec3 n, vec3 o, vec3 d) {
    float denominator = dot(n, d);
    return (offset - dot(n, o)) / (denominator == 0.0 ? 1e-30 : denominator);
}

bool crosses_quad(vec3 corner, vec3 u, vec3 v, float large, float offset, vec3 o, vec3 d, float t_max) {
    vec3 n = cross(u, v);
    float t = plane_distance(offset, n, o, d);
    if (large > 0.0) {
        vec2 share = corner.xy + vec2(dot(u, o + d * t), dot(v, o + d * t));
        return within(t, t_max * 1e-5, t_max) && all(greaterThanEqual(share, vec2(0.0))) &&
            all(lessThanEqual(share, vec2(1.0)));
    }
    vec3 p = o + d * t - corner;
    float nn = dot(n, n), x = dot(cross(p, v), n), y = dot(cross(u, p), n);
    return within(t, t_max * 1e-5, t_max) && x >= 0.0 && x <= nn && y >= 0.0 && y <= nn;
}

bool crosses_plate(vec3 center, vec3 n, vec3 outwards, float radius, float offset, vec3 o, vec3 d, float t_max) {
    float t = plane_distance(offset, n, o, d);
    vec3 p = o + d * t - center;
    float reach = radius < 0.0 ? 2.0 * radius * dot(outwards, p) : sqr(radius);  // of (p + r outwards)^2 <= r^2
    return within(t, t_max * 1e-5, t_max) && dot(p, p) <= reach;
}

// Returns whether a body's surface crosses the ray o + t d before a light at `distance`. Crossings within 1e-5 of the
// distance from either end do not count, so a body that touches the surface point or the light hides nothing there. A
// shape does not shadow itself.
bool blocked(vec3 o, vec3 d, float distance, float own) {
    bool hidden = false;
    float t_max = distance * (1.0 - 1e-5);
    for (int i = 0; i < first_box; ++i) hidden = hidden || (bodies[3 * i].w != own && crosses_ball(i, o, d, t_max));
    for (int i = first_box; i < first_quad; ++i)
        hidden =
            hidden || (bodies[3 * i].w != own && crosses_box(bodies[3 * i].xyz, bodies[3 * i + 1].xyz, o, d, t_max));
    for (int i = first_quad; i < first_plate; ++i)
        hidden = hidden ||
            (bodies[3 * i].w != own &&
                crosses_quad(bodies[3 * i].xyz, bodies[3 * i + 1].xyz, bodies[3 * i + 2].xyz, bodies[3 * i + 1].w,
                    bodies[3 * i + 2].w, o, d, t_max));
    for (int i = first_plate; i < first_plane; ++i)
        hidden = hidden ||
            (bodies[3 * i].w != own &&
                crosses_plate(bodies[3 * i].xyz, bodies[3 * i + 1].xyz, bodies[3 * i + 2].xyz, bodies[3 * i + 1].w,
                    bodies[3 * i + 2].w, o, d, t_max));
    for (int i = first_plane; i < end_of_bodies; ++i)
        hidden = hidden ||
            (bodies[3 * i].w != own &&
                within(plane_distance(bodies[3 * i + 2].w, bodies[3 * i + 1].xyz, o, d), t_max * 1e-5, t_max));
    return hidden;
}
