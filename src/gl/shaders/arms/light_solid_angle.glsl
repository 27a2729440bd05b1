// light-solid-angle, as src/samplers/light_solid_angle.h: NEE, a disk light by solid angle: uniform over the smallest
// cap of directions about the disk's spherical ellipse that contains it. The disk is chosen by its power Y(L) pi r^2.
//   p = 1 / (2 pi (1 - cos b)),  cos = 1 - u1 (1 - cos b), phi = 2 pi u2, about the ellipse's centre a.
// Guillen et al. 2017, "Area-Preserving Parameterizations for Spherical Ellipses", section 3.
#include "sampler.glsl"

struct Cap {
    vec3 axis;
    float height;   // 1 - cos b
    float density;  // 1/sr; 0 if x is behind a one-sided disk
    vec3 y, off;    // where the axis meets the disk's plane, from x and from the disk's centre
};

Cap cap_of(LocalDisk d) {
    const float tiny = 1e-30;
    vec3 across = d.to_center - d.normal * d.along;  // from x's foot in the disk's plane to the centre
    vec3 t = across * (d.radius / sqrt(max(dot(across, across), tiny)));
    vec3 near = d.to_center - t, far = d.to_center + t;
    float q = -4.0 * dot(d.to_center, t) / max(sqr(sqrt(dot(near, near)) + sqrt(dot(far, far))), tiny);
    vec3 off = t * q, y = d.to_center + off;
    float y2 = max(dot(y, y), tiny);
    float tan2 = max(sqr(d.radius) * ((1.0 - q) * (1.0 + q)), 0.0) / y2;
    float cosine = 1.0 / sqrt(1.0 + tan2);
    float height = max(tan2 / (1.0 + tan2) / (1.0 + cosine), tiny);
    return Cap(y * (1.0 / sqrt(y2)), height, faces(d) ? (0.5 / pi) / height : 0.0, y, off);
}

// A direction is drawn as its difference e from the axis, which keeps its precision for a cap of any size.
Drawn towards(LocalDisk d, Cap cap, vec2 u) {
    float drop = u.x * cap.height;  // 1 - cos
    float sin = sqrt(drop * (2.0 - drop));
    SinCos phi = sincos_turns(u.y);
    vec3 e = to_world(frame_about(cap.axis), vec3(sin * phi.cos, sin * phi.sin, -drop));
    vec3 wi = cap.axis + e;
    float v = dot(wi, d.normal);
    vec3 miss = e * d.along - cap.y * dot(e, d.normal) + cap.off * v;
    aimed_met = dot(miss, miss) <= sqr(d.radius) * (v * v) && d.along * v > 0.0;
    return Drawn(wi, cap.density);
}

// Returns the density with which the lights except one draw wi.
float density_by_others(vec3 wi, int but) {
    float sum = 0.0, below = 0.0;
    for (int k = 0; k < DISKS; ++k) {
        float share = k + 1 < DISKS + OTHERS ? disks[k].power : 1.0 - below;
        Cap cap = cap_of(disks[k]);
        vec3 off = wi - cap.axis;
        sum += 0.5 * dot(off, off) <= cap.height && k != but ? share * cap.density : 0.0;
        below += share;
    }
    for (int k = 0; k < OTHERS; ++k) {
        float share = k + 1 < OTHERS ? others[k].power : 1.0 - below;
        sum += DISKS + k != but ? share * other_angle_pdf(others[k], wi) : 0.0;
        below += share;
    }
    return sum;
}
float pdf_light_solid_angle(vec3 wo, vec3 wi) { return density_by_others(wi, -1); }

Drawn sample_light_solid_angle(vec3 wo, vec2 u) {
    Drawn drawn = Drawn(vec3(0.0, 0.0, 1.0), 0.0);
    float below = 0.0;
    aimed_disk = -1;
    for (int k = 0; k < DISKS; ++k) {  // u.x in [below, below + power) chooses disk k and is stretched back to [0,1)
        float above = k + 1 < DISKS + OTHERS ? below + disks[k].power : 1.0;
        if (u.x >= below && u.x < above) {
            drawn = towards(disks[k], cap_of(disks[k]), vec2((u.x - below) / max(above - below, 1e-30), u.y));
            drawn.pdf *= above - below;
            aimed_disk = k;
        }
        below = above;
    }
    for (int k = 0; k < OTHERS; ++k) {
        float above = k + 1 < OTHERS ? below + others[k].power : 1.0;
        if (u.x >= below && u.x < above) {
            Aimed aimed = other_by_angle(others[k], vec2((u.x - below) / max(above - below, 1e-30), u.y));
            drawn = Drawn(aimed.wi, (above - below) * aimed.pdf);
            aimed_disk = DISKS + k;
            aimed_met = aimed.pdf > 0.0;
        }
        below = above;
    }
    // Caps may overlap: every light whose directions contain wi could have drawn it.
    if (DISKS + OTHERS > 1 && drawn.pdf > 0.0) drawn.pdf += density_by_others(drawn.wi, aimed_disk);
    return drawn;
}
