#version 450
// The text of lobes.hlsl in GLSL.
#define float2 vec2
#define float3 vec3
#define static
#include "lobes.hlsl"
