// The integers of the random streams, one hash per fragment: fragment (x, y) has pixel x + y width, and everything else
// is uniform. Used to test that they equal the CPU's.
#include "random.glsl"

uniform int image_width;
uniform uint pair, block, seed;
layout(location = 0) out uvec4 integers;

void main() { integers = draws(uint(int(gl_FragCoord.y) * image_width + int(gl_FragCoord.x)), pair, block, seed); }
