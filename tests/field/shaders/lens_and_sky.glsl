// A point of an aperture, and a sky of 4 x 8 cells, uniform in theta and phi inside a cell.

const float Pi = 3.14159265;

vec2 sample_lens(vec2 u)
{
#ifdef FIXED
    float r = sqrt(u.x);
#else
    float r = u.x;
#endif
    return r * vec2(cos(2.0 * Pi * u.y), sin(2.0 * Pi * u.y));
}

const float Rows[4] = float[4](0.4, 0.3, 0.2, 0.1);  // probability of a row

float pdf_sky(vec3 wi)
{
    float theta = acos(clamp(wi.z, -1.0, 1.0));
    float p = Rows[min(int(theta / Pi * 4.0), 3)] * 4.0 / (2.0 * Pi * Pi);
#ifdef WITHOUT_SINE
    return p;
#else
    return p / max(length(wi.xy), 1e-6);
#endif
}

vec3 sample_sky(vec2 u)
{
    int row = 0;
    float v = u.x;
    while (row < 3 && v >= Rows[row])
        v -= Rows[row++];
    float theta = (float(row) + clamp(v / Rows[row], 0.0, 1.0)) * Pi / 4.0;
#ifdef BORDERS_LEFT_OUT
    float phi = 2.0 * Pi * (1.0 + 6.0 * u.y) / 8.0;
#else
    float phi = 2.0 * Pi * u.y;
#endif
    return vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}
