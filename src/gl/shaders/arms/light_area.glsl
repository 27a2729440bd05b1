// light-area, as src/samplers/light_area.h: next-event estimation (NEE), a disk light by area, the disk chosen by its
// power Y(L) pi r^2.
//   y = c + r sqrt(u1) (cos 2 pi u2, sin 2 pi u2);  p_A = 1/(pi r^2);  p = p_A |y - x|^2 / cos(light).
// Other kinds of light: lights.glsl. It reaches only the lights.
#include "sampler.glsl"

float disk_density(LocalDisk d, float r2, float cos_light) { return (1.0 / pi) / sqr(d.radius) * r2 / cos_light; }

// Returns the density with which the lights except one draw wi.
float density_of_other_lights(vec3 wi, int but) {
    float sum = 0.0;
    for (int k = 0; k < DISKS; ++k) {
        LocalDisk d = disks[k];
        float c = d.along, v = dot(wi, d.normal);
        vec3 off = wi * c - d.to_center * v;
        bool met = dot(off, off) <= sqr(d.radius) * (v * v) && faces(d) && c * v > 0.0 && k != but;
        float t = c / (met ? v : 1.0);
        sum += met ? d.power * disk_density(d, sqr(t), abs(v)) : 0.0;
    }
    for (int k = 0; k < OTHERS; ++k) sum += DISKS + k != but ? others[k].power * other_area_pdf(others[k], wi) : 0.0;
    return sum;
}
float pdf_light_area(vec3 wo, vec3 wi) { return density_of_other_lights(wi, -1); }

Drawn on_disk(LocalDisk d, vec2 u) {
    float r = sqrt(u.x);
    SinCos phi = sincos_turns(u.y);
    Frame about = frame_about(d.normal);
    vec3 y = d.to_center + about.t * d.radius * (r * phi.cos) + about.b * d.radius * (r * phi.sin);
    float r2 = dot(y, y), distance = sqrt(r2);
    float scale = faces(d) ? (1.0 / pi) / (sqr(d.radius) * abs(d.along)) : 0.0;  // r^2 / cos(light) = |y|^3 / |c.n|
    return Drawn(y * (1.0 / distance), scale * r2 * distance);
}

Drawn sample_light_area(vec3 wo, vec2 u) {
    Drawn drawn = Drawn(vec3(0.0, 0.0, 1.0), 0.0);
    float below = 0.0;
    aimed_disk = -1;
    for (int k = 0; k < DISKS; ++k) {  // u.x in [below, below + power) chooses disk k and is stretched back to [0,1)
        float above = k + 1 < DISKS + OTHERS ? below + disks[k].power : 1.0;
        if (u.x >= below && u.x < above) {
            drawn = on_disk(disks[k], vec2((u.x - below) / (above - below), u.y));
            drawn.pdf *= above - below;
            aimed_disk = k;
        }
        below = above;
    }
    for (int k = 0; k < OTHERS; ++k) {
        float above = k + 1 < OTHERS ? below + others[k].power : 1.0;
        if (u.x >= below && u.x < above) {
            Aimed aimed = other_by_area(others[k], vec2((u.x - below) / max(above - below, 1e-30), u.y));
            drawn = Drawn(aimed.wi, (above - below) * aimed.pdf);
            aimed_disk = DISKS + k;
        }
        below = above;
    }
    // Lights may lie one behind another: every one that wi meets could have drawn it.
    if (DISKS + OTHERS > 1 && drawn.pdf > 0.0) drawn.pdf += density_of_other_lights(drawn.wi, aimed_disk);
    aimed_met = drawn.pdf > 0.0;
    return drawn;
}
