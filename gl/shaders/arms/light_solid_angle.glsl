// light-solid-angle, as src/arms/light_solid_angle.h: NEE, a disk light by solid angle: uniform over the smallest cap of
// directions about the disk's spherical ellipse that holds all of it. The disk is chosen by its power Y(L) pi r^2.
//   p = 1 / (2 pi (1 - cos b)),  cos = 1 - u1 (1 - cos b), phi = 2 pi u2, about the ellipse's centre a.
// Guillen et al. 2017, "Area-Preserving Parameterizations for Spherical Ellipses", section 3.
#include "sampler.glsl"

struct Cap {
    vec3 axis;
    float height;   // 1 - cos b
    float density;  // 1/sr; 0 where x is behind a one-sided disk
};

Cap cap_of(LocalDisk d) {
    const float tiny = 1e-30;
    float c = dot(d.to_center, d.normal);
    bool lit = c < 0.0 || (c > 0.0 && d.two_sided > 0.0);
    vec3 across = d.to_center - d.normal * c;  // from x's foot in the disk's plane to the centre
    vec3 t = across * (d.radius / sqrt(max(dot(across, across), tiny)));
    vec3 near = d.to_center - t, far = d.to_center + t;
    vec3 axis = unit(near * (1.0 / sqrt(max(dot(near, near), tiny))) + far * (1.0 / sqrt(max(dot(far, far), tiny))));
    float v = dot(axis, d.normal);
    vec3 y = axis * ((lit ? c : 1.0) / (abs(v) > 0.0 ? v : 1.0));
    vec3 off = y - d.to_center;
    float tan2 = max(sqr(d.radius) - dot(off, off), 0.0) / max(dot(y, y), tiny);
    float cosine = 1.0 / sqrt(1.0 + tan2);
    float height = max(tan2 / (1.0 + tan2) / (1.0 + cosine), 1e-12);
    return Cap(axis, height, lit ? (0.5 / pi) / height : 0.0);
}

vec3 on_cap(Cap cap, vec2 u) {
    float drop = u.x * cap.height;  // 1 - cos
    float sin = sqrt(drop * (2.0 - drop));
    SinCos phi = sincos_turns(u.y);
    return to_world(frame_about(cap.axis), vec3(sin * phi.cos, sin * phi.sin, 1.0 - drop));
}

float pdf_light_solid_angle(vec3 wo, vec3 wi) {
    float sum = 0.0, below = 0.0;
    for (int k = 0; k < DISKS; ++k) {
        float share = k + 1 < DISKS ? disks[k].power : 1.0 - below;
        Cap cap = cap_of(disks[k]);
        vec3 off = wi - cap.axis;
        sum += 0.5 * dot(off, off) <= cap.height ? share * cap.density : 0.0;
        below += share;
    }
    return sum;
}

Drawn sample_light_solid_angle(vec3 wo, vec2 u) {
    Drawn drawn = Drawn(vec3(0.0, 0.0, 1.0), 0.0);
    float below = 0.0;
    for (int k = 0; k < DISKS; ++k) {  // u.x in [below, below + power) chooses disk k and is stretched back to [0,1)
        float above = k + 1 < DISKS ? below + disks[k].power : 1.0;
        if (u.x >= below && u.x < above) {
            Cap cap = cap_of(disks[k]);
            drawn = Drawn(on_cap(cap, vec2((u.x - below) / max(above - below, 1e-30), u.y)), (above - below) * cap.density);
        }
        below = above;
    }
    if (DISKS > 1 && drawn.pdf > 0.0)  // caps may overlap; its own alone where rounding puts wi outside it
        drawn.pdf = max(pdf_light_solid_angle(wo, drawn.wi), drawn.pdf);
    return drawn;
}
