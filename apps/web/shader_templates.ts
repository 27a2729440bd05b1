// What a user's sampler in WGSL starts from: files for `crescent check FILE.wgsl`, with their snippets in comments.
import { Template } from "./templates";

export const shaderTemplates: Readonly<Record<string, Template>> = {
  "wgsl-cosine": {
    title: "cosine", ground: "lambert",
    code: `// crescent: sample = wi = cosine_sample(u)
// crescent: pdf    = cosine_pdf(wi)
const PI: f32 = 3.14159265;

fn cosine_sample(u: vec2<f32>) -> vec3<f32> {  // u: two numbers in [0, 1); u1 to u8 with the key numbers
    let r = sqrt(u.x);
    let phi = 2.0 * PI * u.y;
    // WGSL lets sin and cos be off by 2^-11.
    return normalize(vec3<f32>(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x)));
}

fn cosine_pdf(wi: vec3<f32>) -> f32 { return wi.z / PI; }  // 1/sr
`,
  },
  "wgsl-ggx": {
    title: "GGX visible normals", ground: "ggx",
    code: `// crescent: sample = wi = ggx_sample(wo, u, alpha)
// crescent: pdf    = ggx_pdf(wo, wi, alpha)
// crescent: uses   = alpha
const PI: f32 = 3.14159265;

// Walter et al. 2007, (33) and (34).
fn ggx_D(m: vec3<f32>, alpha: f32) -> f32 {
    let t = alpha * alpha * m.z * m.z + m.x * m.x + m.y * m.y;
    return alpha * alpha / (PI * t * t);
}
fn ggx_G1(w: vec3<f32>, alpha: f32) -> f32 {
    let tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * tan2));
}

// Dupuy and Benyoub 2023: a point of a spherical cap in the stretched space.
fn ggx_sample(wo: vec3<f32>, u: vec2<f32>, alpha: f32) -> vec3<f32> {
    let v = normalize(vec3<f32>(alpha * wo.xy, wo.z));
    let z = (1.0 - u.x) * (1.0 + v.z) - v.z;
    let r = sqrt(max(0.0, 1.0 - z * z));
    let phi = 2.0 * PI * u.y;
    let h = vec3<f32>(r * cos(phi), r * sin(phi), z) + v;
    let m = normalize(vec3<f32>(alpha * h.xy, h.z));
    return 2.0 * dot(wo, m) * m - wo;
}

fn ggx_pdf(wo: vec3<f32>, wi: vec3<f32>, alpha: f32) -> f32 {
    return ggx_G1(wo, alpha) * ggx_D(normalize(wo + wi), alpha) / (4.0 * wo.z);
}
`,
  },
};
