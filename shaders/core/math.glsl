// Safe operations, and the elementary functions that the software driver gets wrong.
//
// Errors are against double precision over the stated range, measured by tests/parity/math_test.
#ifndef CORE_MATH_GLSL
#define CORE_MATH_GLSL

const float kPi = 3.14159265358979;
const float kInvPi = 0.318309886183791;
const float kInvFourPi = 0.0795774715459477;
const float kInfinity = 1.0 / 0.0;

// a / b, and 0 when b is 0.
float safeDivide(float a, float b) { return b == 0.0 ? 0.0 : a / b; }

float maxComponent(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Natural logarithm of a positive normal number, within 1 ulp also next to 1, where the driver's
// log loses every digit. Reduction and coefficients: FreeBSD msun e_logf (Sun Microsystems 1993).
float logPositive(float x) {
    int bits = floatBitsToInt(x);
    int exponent = (bits - 0x3f3504f3) >> 23;  // x = 2^exponent * m, m in [sqrt(1/2), sqrt(2))
    float f = intBitsToFloat(bits - (exponent << 23)) - 1.0;
    float s = f / (2.0 + f);
    float z = s * s;
    float w = z * z;
    float r = z * (0.66666662693 + w * 0.28498786688) + w * (0.40000972152 + w * 0.24279078841);
    float half_square = 0.5 * f * f;
    float k = float(exponent);
    return s * (half_square + r) + k * 9.0580006145e-6 - half_square + f + k * 0.69313812256;
}

// exp(x) for x in [-87, 0], within 2 ulp; 0 below (e^-87 is 1.6e-38, the smallest normal number).
float expNegative(float x) {
    float n = roundEven(x * 1.44269504089);
    float r = (x - n * 0.693359375) + n * 2.12194440e-4;  // Cody-Waite: n * 0.693359375 is exact
    float p = 1.0 + r * (1.0 + r * (0.5 + r * (0.16666667163 + r * (4.1666645557e-2 +
              r * (8.3333803341e-3 + r * 1.3888889225e-3)))));
    float scale = intBitsToFloat((int(max(n, -126.0)) + 127) << 23);
    return x < -87.0 ? 0.0 : p * scale;
}

// Of the two floats around a square root s good to 1 ulp: the nearer neighbour, or s.
// Shader only: the driver's sqrt need not be rounded correctly. (Dekker's product gives s * s exactly.)
float roundSqrtStep(float x, float s) {
    precise float big = 4097.0 * s;
    precise float high = big - (big - s);
    precise float low = s - high;
    precise float square = s * s;
    precise float tail = ((high * high - square) + 2.0 * high * low) + low * low;
    precise float rest = (x - square) - tail;  // x - s * s, exactly
    int bits = floatBitsToInt(s);
    precise float above = intBitsToFloat(bits + 1) - s;
    precise float below = s - intBitsToFloat(bits - 1);
    precise float up = s * above;
    precise float down = s * below;
    return intBitsToFloat(rest > up ? bits + 1 : rest <= -down ? bits - 1 : bits);
}

// Square root rounded to nearest, on every device, for x = 0 or in [2^-60, 2^60].
float roundedSqrt(float x) {
    float s = sqrt(x);
    s = roundSqrtStep(x, s);
    s = roundSqrtStep(x, s);
    return x == 0.0 ? 0.0 : s;
}

// Angle of (x, y) from the x axis, in (-pi, pi], within 3 ulp; 0 when both are 0. Reduction and coefficients: Cephes atanf
// (Moshier 1989).
float angleOf(float y, float x) {
    float low = min(abs(x), abs(y)), high = max(abs(x), abs(y));
    bool steep = low > 0.41421356 * high;  // beyond pi / 8
    float a = steep ? (low - high) / (low + high) : safeDivide(low, high);
    float z = a * a;
    float p = a + a * z * (-3.33329491539e-1 + z * (1.99777106478e-1 + z * (-1.38776856032e-1 + z * 8.05374449538e-2)));
    float angle = steep ? 0.785398163397 + p : p;
    if (abs(y) > abs(x)) angle = 1.57079632679 - angle;
    if (x < 0.0) angle = kPi - angle;
    return y < 0.0 ? -angle : angle;
}

// (sin, cos) of 2 pi u for u in [0, 1], within 1.5 ulp of the larger one. The reduction is exact:
// 4 u and its distance from the nearest integer have no rounding.
vec2 sinCosTurn(float u) {
    float quarter = roundEven(4.0 * u);
    float x = (4.0 * u - quarter) * 1.57079632679;
    float z = x * x;
    float s = x + x * z * (-0.16666666641 + z * (8.3333293855e-3 + z * (-1.9839334836e-4 + z * 2.7183114939e-6)));
    float c = 1.0 + z * (-0.49999999725 + z * (4.1666623323e-2 + z * (-1.3886763774e-3 + z * 2.4390448796e-5)));
    int q = int(quarter);
    vec2 result = (q & 1) == 0 ? vec2(s, c) : vec2(c, s);
    return vec2((q & 2) != 0 ? -result.x : result.x, ((q + 1) & 2) != 0 ? -result.y : result.y);
}

#endif
