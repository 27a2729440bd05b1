// GGX with visible normals: the density with G1 and without, and lobes chosen by thresholds. Local frame, n = +z.

static const float Pi = 3.14159265;

float ggx_d(float3 m, float alpha)  // Walter et al. 2007, (33)
{
    float t = m.z * m.z * (alpha * alpha - 1) + 1;
    return alpha * alpha / (Pi * t * t);
}

float ggx_g1(float3 w, float alpha)  // (34)
{
    return 2 / (1 + sqrt(1 + alpha * alpha * (1 - w.z * w.z) / (w.z * w.z)));
}

float3 visible_normal(float3 wo, float2 u, float alpha)  // Dupuy and Benyoub 2023
{
    float3 v = normalize(float3(alpha * wo.xy, wo.z));
    float z = (1 - u.y) * (1 + v.z) - v.z;
    float s = sqrt(saturate(1 - z * z));
    float3 m = float3(s * cos(2 * Pi * u.x), s * sin(2 * Pi * u.x), z) + v;
    return normalize(float3(alpha * m.xy, m.z));
}

float3 sample_visible(float3 wo, float2 u, float alpha)
{
    return reflect(-wo, visible_normal(wo, u, alpha));
}

float pdf_visible(float3 wo, float3 wi, float alpha)
{
    float3 m = normalize(wo + wi);
#ifdef FIXED
    return ggx_d(m, alpha) * ggx_g1(wo, alpha) / (4 * wo.z);
#else
    return ggx_d(m, alpha) / (4 * dot(wo, m));
#endif
}

float pdf_lobes(float3 wo, float3 wi, float alpha)
{
    float3 m = normalize(wo + wi);
    return 0.6 * wi.z / Pi + 0.4 * ggx_d(m, alpha) * ggx_g1(wo, alpha) / (4 * wo.z);
}

// The GGX lobe with 0.4, the diffuse one with 0.6, by u.z; pdf 0: no sample.
float3 sample_lobes(float3 wo, float3 u, float alpha, out float pdf)
{
    float r = sqrt(u.x);
    float3 wi = float3(r * cos(2 * Pi * u.y), r * sin(2 * Pi * u.y), sqrt(1 - u.x));
    bool shiny = u.z < 0.4;
    if (shiny)
        wi = sample_visible(wo, u.xy, alpha);
#ifdef FIXED
    bool drawn = true;
#else
    bool drawn = shiny || u.z < 0.6;
#endif
    pdf = drawn ? pdf_lobes(wo, wi, alpha) : 0;
    return wi;
}
