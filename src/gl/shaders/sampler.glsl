// The interface of a sampler, as src/samplers/sampler.h: sample_<sampler>(wo, u) returns a direction and the density it
// was drawn with; pdf_<sampler>(wo, wi) returns that density, 0 off the support. Local frame (n = +z); u in [0,1)^2;
// pdf in 1/sr.
#include "shading_point.glsl"

// pdf 0: nothing was drawn, the sample has weight 0 and counts.
struct Drawn {
    vec3 wi;
    float pdf;
};

// A direction that was drawn towards a light: its index, and whether wi meets that light; this is known from the draw,
// while a test of the rounded direction may fail. Set by the samplers that aim at lights.
int aimed_disk = -1;
bool aimed_met = false;
