// Samplers in the local frame, n = +z. u.x is radius, u.y angle.
static const float PI = 3.14159265358979;

float3 at_angle(float z, float phi) {
    float r = sqrt(max(0.0, 1.0 - z * z));
    return float3(r * cos(phi), r * sin(phi), z);
}

// In a frame whose third axis is w.
float3 about(float3 w, float3 local) {
    float s = (w.z >= 0.0 ? 1.0 : -1.0);  // Duff et al. 2017, "Building an Orthonormal Basis, Revisited"
    float a = -1.0 / (s + w.z);
    float b = w.x * w.y * a;
    float3 t = float3(1.0 + s * w.x * w.x * a, s * b, -s * w.x);
    float3 v = float3(b, s + w.y * w.y * a, -w.y);
    return local.x * t + local.y * v + local.z * w;
}

float3 cosine_sample(float2 u) { return at_angle(sqrt(1.0 - u.x), 2.0 * PI * u.y); }
float cosine_pdf(float3 wi) { return wi.z / PI; }

// Phong about the reflected direction.
float3 phong_sample(float3 wo, float2 u, float s) {
    return about(float3(-wo.xy, wo.z), at_angle(pow(1.0 - u.x, 1.0 / (s + 1.0)), 2.0 * PI * u.y));
}
float phong_pdf(float3 wo, float3 wi, float s) {
    return (s + 1.0) / (2.0 * PI) * pow(max(0.0, dot(float3(-wo.xy, wo.z), wi)), s);
}

// Walter et al. 2007, (33) and (34); visible normals: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with
// Spherical Caps".
float ggx_D(float3 m, float alpha) {
    // 1 + (alpha^2 - 1) cos^2 without its cancellation at small angles
    float t = alpha * alpha * m.z * m.z + m.x * m.x + m.y * m.y;
    return alpha * alpha / (PI * t * t);
}
float ggx_G1(float3 w, float alpha) {
    float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * tan2));
}
float3 ggx_normal(float3 wo, float2 u, float alpha) {
    float3 v = normalize(float3(alpha * wo.xy, wo.z));
    float3 h = at_angle((1.0 - u.x) * (1.0 + v.z) - v.z, 2.0 * PI * u.y) + v;
    return normalize(float3(alpha * h.xy, h.z));
}
float3 ggx_sample(float3 wo, float2 u, float alpha) {
    float3 m = ggx_normal(wo, u, alpha);
    return 2.0 * dot(wo, m) * m - wo;
}
float ggx_pdf(float3 wo, float3 wi, float alpha) {
    return ggx_G1(wo, alpha) * ggx_D(normalize(wo + wi), alpha) / (4.0 * wo.z);
}
float ggx_f(float3 wo, float3 wi, float alpha) {
    return ggx_D(normalize(wo + wi), alpha) * ggx_G1(wo, alpha) * ggx_G1(wi, alpha) / (4.0 * wo.z * wi.z);
}

// A third number chooses between a cosine lobe and GGX.
float3 mixture_sample(float3 wo, float choice, float2 u, float alpha) {
    if (choice < 0.3) { return cosine_sample(u); }
    return ggx_sample(wo, u, alpha);
}
float mixture_pdf(float3 wo, float3 wi, float alpha) {
    return 0.3 * cosine_pdf(wi) + 0.7 * ggx_pdf(wo, wi, alpha);
}
float3 mixture_f(float3 wo, float3 wi, float alpha) {
    return float3(0.5, 0.3, 0.1) / PI + 0.5 * ggx_f(wo, wi, alpha);
}

// Henyey and Greenstein 1941; both directions leave the point, so that forward is -wo.
float hg(float3 wo, float3 wi, float g) {
    float t = 1.0 + g * g + 2.0 * g * dot(wo, wi);
    return (1.0 - g * g) / (4.0 * PI * t * sqrt(t));
}
float3 hg_sample(float3 wo, float2 u, float g) {
    float s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x);
    return about(-wo, at_angle((1.0 + g * g - s * s) / (2.0 * g), 2.0 * PI * u.y));
}

// Ureña, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles": corner (-1, -0.5, 2), edges
// 2 along x and 1 along y.
float3 rectangle_angle() {  // solid angle, b0, k
    float z0 = -2.0;
    float x0 = -1.0; float x1 = 1.0; float y0 = -0.5; float y1 = 0.5;
    float3 n0 = normalize(float3(0.0, z0, -y0));
    float3 n1 = normalize(float3(-z0, 0.0, x1));
    float3 n2 = normalize(float3(0.0, -z0, y1));
    float3 n3 = normalize(float3(z0, 0.0, -x0));
    float g0 = acos(-dot(n0, n1)); float g1 = acos(-dot(n1, n2));
    float g2 = acos(-dot(n2, n3)); float g3 = acos(-dot(n3, n0));
    float k = 2.0 * PI - g2 - g3;
    return float3(g0 + g1 - k, n0.z, k);
}
float3 rectangle_sample(float2 u) {
    float z0 = -2.0; float y0 = -0.5; float y1 = 0.5;
    float3 q = rectangle_angle();
    float3 n2 = normalize(float3(0.0, -z0, y1));
    float a = u.x * q.x + q.z;
    float fu = (cos(a) * q.y - n2.z) / sin(a);
    float cu = clamp((fu > 0.0 ? 1.0 : -1.0) / sqrt(fu * fu + q.y * q.y), -1.0, 1.0);
    float xu = clamp(-(cu * z0) / sqrt(max(1e-12, 1.0 - cu * cu)), -1.0, 1.0);
    float d2 = xu * xu + z0 * z0;
    float h0 = y0 / sqrt(d2 + y0 * y0);
    float h1 = y1 / sqrt(d2 + y1 * y1);
    float h = h0 + u.y * (h1 - h0);
    float yv = h * sqrt(d2 / (1.0 - h * h));
    return normalize(float3(xu, yv, 2.0));
}
float rectangle_pdf(float3 wi) {
    float3 p = wi * (2.0 / max(wi.z, 1e-6));
    bool inside = wi.z > 0.0 && abs(p.x) <= 1.0 && abs(p.y) <= 0.5;
    return (inside ? 1.0 / rectangle_angle().x : 0.0);
}

// Rough glass after Walter et al. 2007: u3 chooses reflection with the probability of Fresnel's factor. eta = n_below / n_above.
float fresnel(float c, float eta) {  // c: cosine on the side of wo; eta: index of the other side over this one
    float s2 = (1.0 - c * c) / (eta * eta);
    if (s2 >= 1.0) { return 1.0; }
    float t = sqrt(1.0 - s2);
    float a = (c - eta * t) / (c + eta * t);
    float b = (eta * c - t) / (eta * c + t);
    return 0.5 * (a * a + b * b);
}
float3 glass_sample(float3 wo_, float choice, float2 u, float alpha, float eta_) {
    float side = (wo_.z > 0.0 ? 1.0 : -1.0);
    float eta = (wo_.z > 0.0 ? eta_ : 1.0 / eta_);
    float3 wo = wo_ * side;
    float3 m = ggx_normal(wo, u, alpha);
    float c = dot(wo, m);
    if (choice < fresnel(c, eta)) {
        float3 r = 2.0 * c * m - wo;
        if (r.z <= 0.0) { return float3(0.0, 0.0, 0.0); }  // nothing drawn
        return side * r;
    }
    float t = sqrt(max(0.0, 1.0 - (1.0 - c * c) / (eta * eta)));
    float3 r = (c / eta - t) * m - wo / eta;
    if (r.z >= 0.0) { return float3(0.0, 0.0, 0.0); }
    return side * r;
}
// f cos / G1(wi), and the pdf, have these factors in common.
float glass_pdf(float3 wo_, float3 wi_, float alpha, float eta_) {
    float side = (wo_.z > 0.0 ? 1.0 : -1.0);
    float eta = (wo_.z > 0.0 ? eta_ : 1.0 / eta_);
    float3 wo = wo_ * side;
    float3 wi = wi_ * side;
    if (wo.z * wi.z == 0.0) { return 0.0; }
    if (wi.z > 0.0) {
        float3 m = normalize(wo + wi);
        return fresnel(dot(wo, m), eta) * ggx_G1(wo, alpha) * ggx_D(m, alpha) / (4.0 * wo.z);
    }
    float3 h = wo + eta * wi;
    float3 m = normalize(h);
    if (m.z < 0.0) { m = -m; }
    float co = dot(wo, m);
    float ci = dot(wi, m);
    if (co <= 0.0 || ci >= 0.0) { return 0.0; }
    float d = co + eta * ci;
    return (1.0 - fresnel(co, eta)) * ggx_G1(wo, alpha) * ggx_D(m, alpha) * co / wo.z * eta * eta * (-ci) / (d * d);
}
float glass_f_cos(float3 wo, float3 wi, float alpha, float eta) {  // of radiance
    float p = glass_pdf(wo, wi, alpha, eta) * ggx_G1(wi, alpha);
    float e = (wo.z > 0.0 ? eta : 1.0 / eta);
    return (wo.z * wi.z < 0.0 ? p / (e * e) : p);
}
