// Elementary functions as in src/math/simd/math.h: the same polynomials, because the accuracy of GLSL's built-in
// functions depends on the driver. The compensated part is omitted (a compiler of GLSL may cancel (a + b) - a): log2 is
// one float, so pow is accurate to about |log2 x^y| 1e-7 instead of 3 ULP.
//
//
//   sincos_turns   u in [0, 1]               1.5e-7 absolute
//   power          x in [0, 1], y > 0        2e-7 + 1e-7 |log2 x^y| relative; 0 below 2^-126
//   root           u in [2^-24, 1]           2e-7 + 1e-7 y |log2 u| relative

const float pi = 3.14159265358979323846;

float sqr(float x) { return x * x; }
vec3 unit(vec3 a) { return a * (1.0 / sqrt(dot(a, a))); }

// sin and cos of 2 pi u.
struct SinCos {
    float sin, cos;
};
SinCos sincos_turns(float u) {
    float a = 4.0 * u;
    float quarter = floor(a + 0.5);
    float r = a - quarter;  // in quarter turns, [-1/2, 1/2]
    float z = r * r;
    float s = r * (1.5707963220e+00 + z * (-6.4596347991e-01 + z * (7.9680238338e-02 + z * -4.6022006005e-03)));
    float c = 1.0 + z * (-1.2337005494e+00 + z * (2.5366941067e-01 + z * (-2.0861531193e-02 + z * 9.0674695455e-04)));
    int k = int(quarter);
    bool swapped = (k & 1) == 1;
    float sine = swapped ? c : s, cosine = swapped ? s : c;
    return SinCos((k & 2) == 2 ? -sine : sine, ((k + 1) & 2) == 2 ? -cosine : cosine);
}

// 2^x and 1 - 2^x, the latter without cancellation for x near 0.
struct Power {
    float value, one_minus;
};
Power exp2_split(float x) {
    float k = floor(x + 0.5);
    float r = x - k;
    float r2 = r * r;
    float low = 6.9314718803e-01 + r * 2.4022651084e-01;
    float middle = 5.5503571055e-02 + r * 9.6180308269e-03;
    float high = 1.3390866863e-03 + r * 1.5469717178e-04;
    float q = r * (low + r2 * (middle + r2 * high));
    float value = (1.0 + q) * uintBitsToFloat(uint(int(k) + 127) << 23u);
    return Power(value, k == 0.0 ? -q : 1.0 - value);
}

// log2(x) for normal x > 0; `x_minus_1` is used if x is close to 1. After FreeBSD's e_logf.c.
float log2_from(float x, float x_minus_1) {
    uint t = floatBitsToUint(x) + (0x3f800000u - 0x3f3504f3u);  // mantissa range [sqrt(1/2), sqrt(2))
    float e = float(int(t >> 23u) - 127);
    float m = uintBitsToFloat((t & 0x007fffffu) + 0x3f3504f3u);
    float f = e == 0.0 ? x_minus_1 : m - 1.0;
    float s = f / (2.0 + f);
    float z = s * s;
    float w = z * z;
    float R = z * (0.66666662693 + w * 0.28498786688) + w * (0.40000972152 + w * 0.24279078841);
    float square = 0.5 * f * f;
    return e + (f - (square - s * (square + R))) * 1.44269504;
}

// x^y and 1 - x^y for x in [0, 1] given x and x - 1; x <= 0 gives 0 (the clamp of a lobe), and so does a result below
// 2^-126.
Power power(float x, float x_minus_1, float y) {
    bool positive = x > 1.17549435e-38;  // smallest normal
    float l = y * log2_from(positive ? x : 1.0, positive ? x_minus_1 : 0.0);
    bool in_range = positive && l > -126.0;
    Power p = exp2_split(in_range ? l : 0.0);
    return Power(in_range ? p.value : 0.0, in_range ? p.one_minus : 1.0);
}
Power power(float x, float y) { return power(x, x - 1.0, y); }

// u^y and 1 - u^y for u in [2^-24, 1] and 0 < y <= 1/2, the inverse of a lobe's distribution.
Power root(float u, float y) { return exp2_split(y * log2_from(u, u - 1.0)); }

// (a.b)^s of unit vectors, from |a - b|^2, which keeps its precision where they nearly coincide.
float cosine_power(vec3 a, vec3 b, float s) {
    vec3 d = a - b;
    float x_minus_1 = -0.5 * dot(d, d);
    return power(1.0 + x_minus_1, x_minus_1, s).value;
}
