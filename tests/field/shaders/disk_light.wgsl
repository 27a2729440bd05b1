// A disk light of radius 0.8 at height 1, tilted by 27 degrees, seen from the origin.

const Pi: f32 = 3.14159265;
const Radius: f32 = 0.8;
const Centre = vec3<f32>(0.0, 0.0, 1.0);
const Normal = vec3<f32>(0.4472136, 0.0, -0.8944272);
const Along = vec3<f32>(0.8944272, 0.0, 0.4472136);
const Across = vec3<f32>(0.0, 1.0, 0.0);

fn sample_disk(u: vec2<f32>) -> vec3<f32> {
    let r = Radius * sqrt(u.x);
    return normalize(Centre + r * cos(2.0 * Pi * u.y) * Along + r * sin(2.0 * Pi * u.y) * Across);
}

fn pdf_disk(wi: vec3<f32>) -> f32 {
    let cosine = -dot(wi, Normal);
    let t = dot(Centre, Normal) / dot(wi, Normal);
    let q = t * wi - Centre;
    if cosine <= 0.0 || t <= 0.0 || dot(q, q) > Radius * Radius {
        return 0.0;
    }
#ifdef FIXED
    return t * t / (cosine * Pi * Radius * Radius);
#else
    return 1.0 / (Pi * Radius * Radius);
#endif
}
