// Phase functions. Directions point away from the vertex; mu = dot(-wo, wi), so E[mu] = g.
// evalPhase is also the density of samplePhase, per steradian. Samples are (mu, sinTheta, density).
#ifndef VOLUME_PHASE_FUNCTION_GLSL
#define VOLUME_PHASE_FUNCTION_GLSL

#include "core/math.glsl"
#include "core/scene.glsl"
#include "sampling/distribution.glsl"
#include "sampling/sampler.glsl"

// What a vertex in a medium scatters by. Fields are those of Medium.
struct PhaseFunction {
    uint kind;      // kPhase*
    float g;        // dual: of the lobe to sample
    float g2;       // dual: of the other lobe
    float weight;   // dual: of the lobe to sample
    uint offset;
    uint count;
    uint distribution;
    float fill;     // tabulated: digits that the word to sample by lacks
};

// Shader only: where there is no medium.
PhaseFunction noPhase() { return PhaseFunction(kPhaseIsotropic, 0.0, 0.0, 1.0, 0u, 1u, 0u, 0.0); }

// Henyey-Greenstein from the squared distance of the unit directions: nothing cancels next to
// mu = +-1 (H5). |g| <= 1 - 2^-20.
float evalHenyeyGreenstein(float g, vec3 wo, vec3 wi) {
    float a = abs(g);
    vec3 difference = g >= 0.0 ? wi + wo : wi - wo;
    float b = 1.0 - a;
    float square = b * b + a * dot(difference, difference);
    return kInvFourPi * b * (1.0 + a) / (square * sqrt(square));
}

// With 1 - mu and 1 + mu as products, every g and u in [0, 1) keeps full accuracy: relative error
// <= 1e-6 (H1-H4).
vec3 sampleHenyeyGreenstein(float g, float u) {
    float a = abs(g);
    float v = g >= 0.0 ? u : 1.0 - u;
    float minus = 1.0 - a, plus = 1.0 + a;
    float k = minus + 2.0 * a * v;
    float inverse = 1.0 / k;
    float oneMinusMu = 2.0 * minus * minus * (1.0 - v) * (1.0 + a * v) * (inverse * inverse);
    float onePlusMu = 2.0 * plus * plus * v * (minus + a * v) * (inverse * inverse);
    float mu = oneMinusMu < 1.0 ? 1.0 - oneMinusMu : onePlusMu - 1.0;
    float pdf = kInvFourPi * k * k * k / ((minus * plus) * (minus * plus));
    return vec3(g >= 0.0 ? mu : -mu, sqrt(oneMinusMu * onePlusMu), pdf);
}

float evalRayleigh(vec3 wo, vec3 wi) {
    float mu = dot(wo, wi);
    return 0.75 * kInvFourPi * (1.0 + mu * mu);
}

// Two Newton steps for x = 1 - |mu| from a start within 0.3 %, then one that damps relative errors of x
// at least fourfold. No sum here cancels by more than a quarter, so sinTheta is good at the poles too.
vec3 sampleRayleigh(float u) {
    float v = min(u, 1.0 - u);
    float x = v * (1.25348395 + 1.48495149 * v);
    x = (x * x * (2.0 * x - 3.0) + 8.0 * v) / (3.0 * ((1.0 - x) * (1.0 - x) + 1.0));
    x = (x * x * (2.0 * x - 3.0) + 8.0 * v) / (3.0 * ((1.0 - x) * (1.0 - x) + 1.0));
    x = 8.0 * v / (6.0 - 3.0 * x + x * x);
    float mu = 1.0 - x;
    return vec3(u < 0.5 ? -mu : mu, sqrt(x * (2.0 - x)), 0.75 * kInvFourPi * (1.0 + mu * mu));
}

// Shader only: value i of a table's part in the texel buffer.
float phaseTexel(uint index) { return texelFetch(phaseTexels, int(index)).x; }

// Counts intervals from the nearer pole, where mu is known best.
float evalTabulated(uint offset, uint count, vec3 wo, vec3 wi) {
    bool forwards = dot(wo, wi) < 0.0;
    vec3 difference = forwards ? wi + wo : wi - wo;
    float x = 0.25 * float(count) * dot(difference, difference);
    uint i = min(uint(x), count - 1u);
    float t = min(x - float(i), 1.0);
    uint near = forwards ? count - i : i, far = forwards ? near - 1u : near + 1u;
    return phaseTexel(offset + near) * (1.0 - t) + phaseTexel(offset + far) * t;
}

// Both distances from the ends of the interval come from their own formula: 1 - mu and 1 + mu keep
// their digits in the outermost intervals. Values are scaled so that no square leaves the range.
vec3 sampleTabulated(uint offset, uint count, Choice choice) {
    uint interval = choice.entry;
    float low = phaseTexel(offset + interval), high = phaseTexel(offset + interval + 1u);
    float scale = max(low, high), a = safeDivide(low, scale), b = safeDivide(high, scale);
    float root = sqrt(a * a * choice.left + b * b * choice.offset);
    float fromLow = min(safeDivide(choice.offset * (a + b), a + root), 1.0);
    float fromHigh = min(safeDivide(choice.left * (a + b), b + root), 1.0);
    float width = 2.0 / float(count);
    float onePlusMu = (float(interval) + fromLow) * width;
    float oneMinusMu = (float(count - 1u - interval) + fromHigh) * width;
    float mu = oneMinusMu < 1.0 ? 1.0 - oneMinusMu : onePlusMu - 1.0;
    return vec3(mu, sqrt(oneMinusMu * onePlusMu), low * fromHigh + high * fromLow);
}

// Readies the phase function of a medium for sampling: `word` chooses the lobe, or fills up what chooses the interval.
// Shader only: the reference refers to media and chooses in samplePhase.
PhaseFunction choosePhase(Medium medium, uint word) {
    PhaseFunction phase = noPhase();
    if (hasHenyeyGreenstein || hasDualHenyeyGreenstein || hasRayleigh || hasTabulatedPhase) phase.kind = medium.phase;
    phase.g = medium.g;
    if (hasDualHenyeyGreenstein && medium.phase == kPhaseDualHenyeyGreenstein) {
        bool first = toUniform(word) < medium.lobeWeight;
        phase.g = first ? medium.g : medium.g2;
        phase.g2 = first ? medium.g2 : medium.g;
        phase.weight = first ? medium.lobeWeight : 1.0 - medium.lobeWeight;
    }
    if (hasTabulatedPhase && medium.phase == kPhaseTabulated) {
        phase.offset = medium.phaseOffset;
        phase.count = medium.phaseCount;
        phase.distribution = medium.phaseDistribution;
        phase.fill = toUniform(word);
    }
    return phase;
}

float evalPhase(PhaseFunction p, vec3 wo, vec3 wi) {
    float value = kInvFourPi;
    bool dual = hasDualHenyeyGreenstein && p.kind == kPhaseDualHenyeyGreenstein;
    if (dual || (hasHenyeyGreenstein && p.kind == kPhaseHenyeyGreenstein)) value = evalHenyeyGreenstein(p.g, wo, wi);
    if (dual) value = p.weight * value + (1.0 - p.weight) * evalHenyeyGreenstein(p.g2, wo, wi);
    if (hasRayleigh && p.kind == kPhaseRayleigh) value = evalRayleigh(wo, wi);
    if (hasTabulatedPhase && p.kind == kPhaseTabulated) value = evalTabulated(p.offset, p.count, wo, wi);
    return value;
}

// The deflection from the direction of travel, or from the world's z where scattering is isotropic.
vec3 samplePhase(PhaseFunction p, uint word) {
    float u = toUniform(word);
    vec3 polar = vec3(1.0 - 2.0 * u, 2.0 * sqrt(u * (1.0 - u)), kInvFourPi);
    bool dual = hasDualHenyeyGreenstein && p.kind == kPhaseDualHenyeyGreenstein;
    if (dual || (hasHenyeyGreenstein && p.kind == kPhaseHenyeyGreenstein)) polar = sampleHenyeyGreenstein(p.g, u);
    if (dual) {
        float other = evalHenyeyGreenstein(p.g2, vec3(0.0, 0.0, -1.0), vec3(polar.y, 0.0, polar.x));
        polar.z = p.weight * polar.z + (1.0 - p.weight) * other;
    }
    if (hasRayleigh && p.kind == kPhaseRayleigh) polar = sampleRayleigh(u);
    if (hasTabulatedPhase && p.kind == kPhaseTabulated)
        polar = sampleTabulated(p.offset, p.count, invertDistribution(p.distribution, p.count, word, p.fill));
    return polar;
}

#endif
