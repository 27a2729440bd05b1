// Samplers in the local frame, n = +z. u.x is radius, u.y angle.
const PI: f32 = 3.14159265358979;

fn at_angle(z: f32, phi: f32) -> vec3<f32> {
    let r = sqrt(max(0.0, 1.0 - z * z));
    return vec3<f32>(r * cos(phi), r * sin(phi), z);
}

// In a frame whose third axis is w.
fn about(w: vec3<f32>, local: vec3<f32>) -> vec3<f32> {
    let s = select(-1.0, 1.0, w.z >= 0.0);  // Duff et al. 2017, "Building an Orthonormal Basis, Revisited"
    let a = -1.0 / (s + w.z);
    let b = w.x * w.y * a;
    let t = vec3<f32>(1.0 + s * w.x * w.x * a, s * b, -s * w.x);
    let v = vec3<f32>(b, s + w.y * w.y * a, -w.y);
    return local.x * t + local.y * v + local.z * w;
}

fn cosine_sample(u: vec2<f32>) -> vec3<f32> { return at_angle(sqrt(1.0 - u.x), 2.0 * PI * u.y); }
fn cosine_pdf(wi: vec3<f32>) -> f32 { return wi.z / PI; }

// Phong about the reflected direction.
fn phong_sample(wo: vec3<f32>, u: vec2<f32>, s: f32) -> vec3<f32> {
    return about(vec3<f32>(-wo.xy, wo.z), at_angle(pow(1.0 - u.x, 1.0 / (s + 1.0)), 2.0 * PI * u.y));
}
fn phong_pdf(wo: vec3<f32>, wi: vec3<f32>, s: f32) -> f32 {
    return (s + 1.0) / (2.0 * PI) * pow(max(0.0, dot(vec3<f32>(-wo.xy, wo.z), wi)), s);
}

// Walter et al. 2007, (33) and (34); visible normals: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with
// Spherical Caps".
fn ggx_D(m: vec3<f32>, alpha: f32) -> f32 {
    // 1 + (alpha^2 - 1) cos^2 without its cancellation at small angles
    let t = alpha * alpha * m.z * m.z + m.x * m.x + m.y * m.y;
    return alpha * alpha / (PI * t * t);
}
fn ggx_G1(w: vec3<f32>, alpha: f32) -> f32 {
    let tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * tan2));
}
fn ggx_normal(wo: vec3<f32>, u: vec2<f32>, alpha: f32) -> vec3<f32> {
    let v = normalize(vec3<f32>(alpha * wo.xy, wo.z));
    let h = at_angle((1.0 - u.x) * (1.0 + v.z) - v.z, 2.0 * PI * u.y) + v;
    return normalize(vec3<f32>(alpha * h.xy, h.z));
}
fn ggx_sample(wo: vec3<f32>, u: vec2<f32>, alpha: f32) -> vec3<f32> {
    let m = ggx_normal(wo, u, alpha);
    return 2.0 * dot(wo, m) * m - wo;
}
fn ggx_pdf(wo: vec3<f32>, wi: vec3<f32>, alpha: f32) -> f32 {
    return ggx_G1(wo, alpha) * ggx_D(normalize(wo + wi), alpha) / (4.0 * wo.z);
}
fn ggx_f(wo: vec3<f32>, wi: vec3<f32>, alpha: f32) -> f32 {
    return ggx_D(normalize(wo + wi), alpha) * ggx_G1(wo, alpha) * ggx_G1(wi, alpha) / (4.0 * wo.z * wi.z);
}

// A third number chooses between a cosine lobe and GGX.
fn mixture_sample(wo: vec3<f32>, choice: f32, u: vec2<f32>, alpha: f32) -> vec3<f32> {
    if (choice < 0.3) { return cosine_sample(u); }
    return ggx_sample(wo, u, alpha);
}
fn mixture_pdf(wo: vec3<f32>, wi: vec3<f32>, alpha: f32) -> f32 {
    return 0.3 * cosine_pdf(wi) + 0.7 * ggx_pdf(wo, wi, alpha);
}
fn mixture_f(wo: vec3<f32>, wi: vec3<f32>, alpha: f32) -> vec3<f32> {
    return vec3<f32>(0.5, 0.3, 0.1) / PI + 0.5 * ggx_f(wo, wi, alpha);
}

// Henyey and Greenstein 1941; both directions leave the point, so that forward is -wo.
fn hg(wo: vec3<f32>, wi: vec3<f32>, g: f32) -> f32 {
    let t = 1.0 + g * g + 2.0 * g * dot(wo, wi);
    return (1.0 - g * g) / (4.0 * PI * t * sqrt(t));
}
fn hg_sample(wo: vec3<f32>, u: vec2<f32>, g: f32) -> vec3<f32> {
    let s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x);
    return about(-wo, at_angle((1.0 + g * g - s * s) / (2.0 * g), 2.0 * PI * u.y));
}

// Ureña, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles": corner (-1, -0.5, 2), edges
// 2 along x and 1 along y.
fn rectangle_angle() -> vec3<f32> {  // solid angle, b0, k
    let z0 = -2.0;
    let x0 = -1.0; let x1 = 1.0; let y0 = -0.5; let y1 = 0.5;
    let n0 = normalize(vec3<f32>(0.0, z0, -y0));
    let n1 = normalize(vec3<f32>(-z0, 0.0, x1));
    let n2 = normalize(vec3<f32>(0.0, -z0, y1));
    let n3 = normalize(vec3<f32>(z0, 0.0, -x0));
    let g0 = acos(-dot(n0, n1)); let g1 = acos(-dot(n1, n2));
    let g2 = acos(-dot(n2, n3)); let g3 = acos(-dot(n3, n0));
    let k = 2.0 * PI - g2 - g3;
    return vec3<f32>(g0 + g1 - k, n0.z, k);
}
fn rectangle_sample(u: vec2<f32>) -> vec3<f32> {
    let z0 = -2.0; let y0 = -0.5; let y1 = 0.5;
    let q = rectangle_angle();
    let n2 = normalize(vec3<f32>(0.0, -z0, y1));
    let a = u.x * q.x + q.z;
    let fu = (cos(a) * q.y - n2.z) / sin(a);
    let cu = clamp(select(-1.0, 1.0, fu > 0.0) / sqrt(fu * fu + q.y * q.y), -1.0, 1.0);
    let xu = clamp(-(cu * z0) / sqrt(max(1e-12, 1.0 - cu * cu)), -1.0, 1.0);
    let d2 = xu * xu + z0 * z0;
    let h0 = y0 / sqrt(d2 + y0 * y0);
    let h1 = y1 / sqrt(d2 + y1 * y1);
    let h = h0 + u.y * (h1 - h0);
    let yv = h * sqrt(d2 / (1.0 - h * h));
    return normalize(vec3<f32>(xu, yv, 2.0));
}
fn rectangle_pdf(wi: vec3<f32>) -> f32 {
    let p = wi * (2.0 / max(wi.z, 1e-6));
    let inside = wi.z > 0.0 && abs(p.x) <= 1.0 && abs(p.y) <= 0.5;
    return select(0.0, 1.0 / rectangle_angle().x, inside);
}

// Rough glass after Walter et al. 2007: u3 chooses reflection with the probability of Fresnel's factor. eta = n_below / n_above.
fn fresnel(c: f32, eta: f32) -> f32 {  // c: cosine on the side of wo; eta: index of the other side over this one
    let s2 = (1.0 - c * c) / (eta * eta);
    if (s2 >= 1.0) { return 1.0; }
    let t = sqrt(1.0 - s2);
    let a = (c - eta * t) / (c + eta * t);
    let b = (eta * c - t) / (eta * c + t);
    return 0.5 * (a * a + b * b);
}
fn glass_sample(wo_: vec3<f32>, choice: f32, u: vec2<f32>, alpha: f32, eta_: f32) -> vec3<f32> {
    let side = select(-1.0, 1.0, wo_.z > 0.0);
    let eta = select(1.0 / eta_, eta_, wo_.z > 0.0);
    let wo = wo_ * side;
    let m = ggx_normal(wo, u, alpha);
    let c = dot(wo, m);
    if (choice < fresnel(c, eta)) {
        let r = 2.0 * c * m - wo;
        if (r.z <= 0.0) { return vec3<f32>(0.0, 0.0, 0.0); }  // nothing drawn
        return side * r;
    }
    let t = sqrt(max(0.0, 1.0 - (1.0 - c * c) / (eta * eta)));
    let r = (c / eta - t) * m - wo / eta;
    if (r.z >= 0.0) { return vec3<f32>(0.0, 0.0, 0.0); }
    return side * r;
}
// f cos / G1(wi), and the pdf, have these factors in common.
fn glass_pdf(wo_: vec3<f32>, wi_: vec3<f32>, alpha: f32, eta_: f32) -> f32 {
    let side = select(-1.0, 1.0, wo_.z > 0.0);
    let eta = select(1.0 / eta_, eta_, wo_.z > 0.0);
    let wo = wo_ * side;
    let wi = wi_ * side;
    if (wo.z * wi.z == 0.0) { return 0.0; }
    if (wi.z > 0.0) {
        let m = normalize(wo + wi);
        return fresnel(dot(wo, m), eta) * ggx_G1(wo, alpha) * ggx_D(m, alpha) / (4.0 * wo.z);
    }
    let h = wo + eta * wi;
    var m = normalize(h);
    if (m.z < 0.0) { m = -m; }
    let co = dot(wo, m);
    let ci = dot(wi, m);
    if (co <= 0.0 || ci >= 0.0) { return 0.0; }
    let d = co + eta * ci;
    return (1.0 - fresnel(co, eta)) * ggx_G1(wo, alpha) * ggx_D(m, alpha) * co / wo.z * eta * eta * (-ci) / (d * d);
}
fn glass_f_cos(wo: vec3<f32>, wi: vec3<f32>, alpha: f32, eta: f32) -> f32 {  // of radiance
    let p = glass_pdf(wo, wi, alpha, eta) * ggx_G1(wi, alpha);
    let e = select(1.0 / eta, eta, wo.z > 0.0);
    return select(p, p / (e * e), wo.z * wi.z < 0.0);
}
