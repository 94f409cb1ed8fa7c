// Environment map (README, "Environment map").
#ifndef LIGHT_ENVIRONMENT_GLSL
#define LIGHT_ENVIRONMENT_GLSL

#include "core/scene.glsl"
#include "sampling/distribution.glsl"
#include "sampling/sampler.glsl"

// Where a direction meets the map: the cell between the texels (column, row), (column + 1, row + 1), and how far into it.
struct EnvironmentPlace {
    uint column, row;
    vec2 fraction;  // in [0, 1]
};

EnvironmentPlace environmentPlace(vec3 d) {
    vec3 local = vec3(dot(environmentMap.localX, d), dot(environmentMap.localY, d), dot(environmentMap.localZ, d));
    float turn = angleOf(local.x, -local.z) * (0.5 * kInvPi);  // within half a turn
    float x = turn * float(environmentMap.width) - 0.5;
    // The polar angle from both coordinates: next to the poles its cosine has no digits left (H58).
    float y = angleOf(length(local.xz), local.y) * kInvPi * float(environmentMap.height - 1u);
    float left = floor(x);
    int column = int(left) + (left < 0.0 ? int(environmentMap.width) : 0);
    uint row = min(uint(y), environmentMap.height - 2u);
    return EnvironmentPlace(uint(column), row, vec2(x - left, min(y - float(row), 1.0)));
}

// Radiance (rgb) from a direction, and the density per steradian with which sampleEnvironment finds it (w).
vec4 environmentAt(vec3 d) {
    EnvironmentPlace place = environmentPlace(d);
    uint next = place.column + 1u == environmentMap.width ? 0u : place.column + 1u;
    int above = int(place.row * environmentMap.width), below = above + int(environmentMap.width);
    vec4 a = texelFetch(environmentTexels, above + int(place.column));
    vec3 b = texelFetch(environmentTexels, above + int(next)).rgb;
    vec3 c = texelFetch(environmentTexels, below + int(place.column)).rgb;
    vec3 e = texelFetch(environmentTexels, below + int(next)).rgb;
    vec2 f = place.fraction, g = 1.0 - f;
    return vec4(g.y * (g.x * a.rgb + f.x * b) + f.y * (g.x * c + f.x * e), a.w);
}

// Direction (xyz) from the words of a light draw, and its density per steradian (w): of the cell it was taken from, also
// where rounding puts it next door.
vec4 sampleEnvironment(uvec3 words) {
    vec2 fill = fillDigits(words.z);
    Choice row = invertDistribution(environmentMap.distribution, environmentMap.height - 1u, words.x, fill.x);
    uint cells = environmentMap.distribution + environmentMap.height + row.entry * (environmentMap.width + 1u);
    Choice column = invertDistribution(cells, environmentMap.width, words.y, fill.y);
    vec2 edge = texelFetch(environmentRows, int(row.entry)).xy;
    bool north = 2u * row.entry + 1u < environmentMap.height;
    float h = edge.x + edge.y * (north ? row.offset : row.left);  // 1 - cos of the angle from the nearer pole
    float sine = sqrt(h * (2.0 - h)), cosine = north ? 1.0 - h : h - 1.0;
    float turn = (float(column.entry) + (0.5 + column.offset)) / float(environmentMap.width);
    vec2 sc = sinCosTurn(turn < 1.0 ? turn : turn - 1.0);
    vec3 local = vec3(sine * sc.x, cosine, -sine * sc.y);
    vec3 d = local.x * environmentMap.localX + local.y * environmentMap.localY + local.z * environmentMap.localZ;
    uint cell = row.entry * environmentMap.width + column.entry;
    return vec4(normalize(d), texelFetch(environmentTexels, int(cell)).w);
}

#endif
