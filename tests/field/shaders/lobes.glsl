// GGX with visible normals under another lobe: whose cosine G1 takes, and where a lobe's weight is evaluated. n = +z.

const float Pi = 3.14159265;

float ggx_d(vec3 m, float alpha)  // Walter et al. 2007, (33)
{
    float t = m.z * m.z * (alpha * alpha - 1.0) + 1.0;
    return alpha * alpha / (Pi * t * t);
}

float ggx_g1(float cosine, float alpha)  // (34)
{
    return 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * (1.0 - cosine * cosine) / (cosine * cosine)));
}

vec3 sample_visible(vec3 wo, vec2 u, float alpha)  // Dupuy and Benyoub 2023
{
    vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
    float z = (1.0 - u.y) * (1.0 + v.z) - v.z;
    float s = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 m = vec3(s * cos(2.0 * Pi * u.x), s * sin(2.0 * Pi * u.x), z) + v;
    return reflect(-wo, normalize(vec3(alpha * m.xy, m.z)));
}

float pdf_visible(vec3 wo, vec3 wi, float alpha)
{
    vec3 m = normalize(wo + wi);
#ifdef FIXED
    float g1 = ggx_g1(wo.z, alpha);
#else
    float g1 = ggx_g1(wi.z, alpha);
#endif
    return ggx_d(m, alpha) * g1 / (4.0 * wo.z);
}

float schlick(float c)
{
    return 0.04 + 0.96 * pow(1.0 - clamp(c, 0.0, 1.0), 5.0);
}

float pdf_lobes(vec3 wo, vec3 wi, float alpha)
{
    vec3 m = normalize(wo + wi);
#ifdef FIXED
    float share = schlick(wo.z);
#else
    float share = schlick(dot(wo, m));
#endif
    return (1.0 - share) * wi.z / Pi + share * ggx_d(m, alpha) * ggx_g1(wo.z, alpha) / (4.0 * wo.z);
}

vec3 sample_lobes(vec3 wo, vec3 u, float alpha)
{
    if (u.z < schlick(wo.z))
        return sample_visible(wo, u.xy, alpha);
    float r = sqrt(u.x);
    return vec3(r * cos(2.0 * Pi * u.y), r * sin(2.0 * Pi * u.y), sqrt(1.0 - u.x));
}
