// The data of a pixel's surface point, as src/render/shading_points.h collects it and src/samplers/sampler.h passes it
// to a sampler. Directions are in the local frame unless stated otherwise; lengths in m, radiance in W/(sr m^2).
//
// `shading_points` has one texel per pixel and these layers, written by src/gl/point_texture.cpp:
//   0  wo, s                  3  the frame's t (world), fill_d     6 + 2k  disk k: from the surface to its centre, d
//   1  alpha, Y(rho_d),       4  its b, fill_s                     7 + 2k  disk k: its normal, s
//      rho_s, -               5  its n, lobe + 1 (-1: no surface)
//   2  the point (from the scene's origin, world), shape
// and after the disks five per other light: a, d;  b, s;  c, number 0;  numbers 1 to 4;  numbers 5 and 6, kind, power.
#include "lights.glsl"

uniform sampler2DArray shading_points;
uniform vec3 disk_kind[DISK_SLOTS];  // radius; 1: emits from both sides; power, Y(L) pi r^2 relative to all disks

// A disk light as seen from the surface.
struct LocalDisk {
    vec3 to_center, normal;
    float radius, two_sided, power;
    float along;  // to_center.normal, m; 0 if the disk's plane passes through the point, which receives nothing from it
};
// Returns whether the surface is in front of an emitting side.
bool faces(LocalDisk d) { return d.along < 0.0 || (d.along > 0.0 && d.two_sided > 0.0); }
LocalDisk disks[DISK_SLOTS];
vec2 disk_worth[DISK_SLOTS];  // Y of L rho_d / pi and of L rho_s: X = (cos/p) (d + s lobe)

struct ShadingPoint {
    vec3 wo;
    float s, alpha, diffuse, lobe;  // Phong exponent, GGX roughness, Y(rho_d), rho_s
};
ShadingPoint shading_point;

// Values used only by the estimator.
struct Surroundings {
    Frame frame;  // world
    vec3 point;   // from the scene's origin, along the world's axes
    float shape;
    float fill_d, fill_s;  // like disk_worth, for the fill
    float kind;            // lobe + 1; -1: no surface
};

Surroundings load_point(ivec2 at) {
    vec4 a = texelFetch(shading_points, ivec3(at, 0), 0), b = texelFetch(shading_points, ivec3(at, 1), 0),
         c = texelFetch(shading_points, ivec3(at, 2), 0);
    vec4 t = texelFetch(shading_points, ivec3(at, 3), 0), u = texelFetch(shading_points, ivec3(at, 4), 0),
         n = texelFetch(shading_points, ivec3(at, 5), 0);
    shading_point = ShadingPoint(a.xyz, a.w, b.x, b.y, b.z);
    for (int k = 0; k < DISKS; ++k) {
        vec4 center = texelFetch(shading_points, ivec3(at, 6 + 2 * k), 0), normal = texelFetch(shading_points, ivec3(at, 7 + 2 * k), 0);
        float height = dot(center.xyz, normal.xyz);
        bool apart = abs(height) > 1e-6 * (length(center.xyz) + disk_kind[k].x);
        disks[k] =
            LocalDisk(center.xyz, normal.xyz, disk_kind[k].x, disk_kind[k].y, disk_kind[k].z, apart ? height : 0.0);
        disk_worth[k] = vec2(center.w, normal.w);
    }
    for (int k = 0; k < OTHERS; ++k) {
        vec4 n[5];
        for (int j = 0; j < 5; ++j) n[j] = texelFetch(shading_points, ivec3(at, 6 + 2 * DISKS + 5 * k + j), 0);
        others[k] = LocalLight(int(n[4].z), n[4].w, n[0].xyz, n[1].xyz, n[2].xyz,
            float[7](n[2].w, n[3].x, n[3].y, n[3].z, n[3].w, n[4].x, n[4].y));
        light_worth[k] = vec2(n[0].w, n[1].w);
    }
    return Surroundings(Frame(t.xyz, u.xyz, n.xyz), c.xyz, c.w, t.w, u.w, n.w);
}
