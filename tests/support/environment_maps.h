#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "scene/scene_description.h"
#include "scene/transforms.h"

namespace parhelion::test {

/// texel() of tools/mitsuba/environment_maps.py.
inline float madeTexel(unsigned i, unsigned j, unsigned channel, glm::uvec2 size) {
    const double value = double((73 * i + 179 * j + 283 * channel + 31 * (i * j % 127)) % 1024 + 1) / 1024;
    const bool isHot = glm::uvec2(i, j) == size / 3u && size.x > 7;
    return float(value * (isHot ? 1e6 : 1));
}

/// A map of all kinds of values, one of them a million times as bright; turned about an oblique axis if asked.
inline EmitterDescription madeMap(glm::uvec2 size, double degrees = 0, bool isHot = true) {
    EmitterDescription emitter;
    emitter.type = EmitterDescription::Type::EnvironmentMap;
    emitter.map.size = size;
    for (unsigned j = 0; j < size.y; ++j)
        for (unsigned i = 0; i < size.x; ++i) {
            glm::vec3 texel(0);
            for (unsigned c = 0; c < 3; ++c) texel[int(c)] = madeTexel(i, j, c, size);
            emitter.map.texels.push_back(isHot ? texel : glm::min(texel, 1.0f));
        }
    if (degrees != 0) emitter.toWorld = rotationMatrix({0.48, 0.64, -0.6}, degrees);
    return emitter;
}

/// Where a direction meets a map, by Mitsuba's definition in double: shares of a turn and of half a turn.
struct MapPoint {
    double u, v, sine;
};
inline MapPoint mapPoint(const EmitterDescription& emitter, const glm::dvec3& direction) {
    const glm::dvec3 d = glm::transpose(glm::dmat3(emitter.toWorld)) * direction;
    const double sine = std::hypot(d.x, d.z);
    const double u = sine == 0 ? 0 : std::atan2(d.x, -d.z) / (2 * std::numbers::pi);
    return {u, std::atan2(sine, d.y) / std::numbers::pi, sine};
}

/// Mitsuba's filter: columns centred on (i + 1/2) / W and periodic, rows at j / (H - 1), the first and last the poles.
/// Maps of one or two rows have their last once more.
inline glm::dvec3 mapRadiance(const EmitterDescription& emitter, double u, double v) {
    const Bitmap& map = emitter.map;
    const unsigned height = map.size.y < 3 ? 3 : map.size.y;
    const double x = u * map.size.x - 0.5, y = v * (height - 1);
    const double column = std::floor(x), row = std::min(std::floor(y), double(height - 2));
    const auto texel = [&](double i, double j) {
        const double wrapped = i - std::floor(i / map.size.x) * map.size.x;
        return glm::dvec3(map.at(unsigned(wrapped), std::min(unsigned(j), map.size.y - 1)));
    };
    const double s = x - column, t = y - row;
    return emitter.value * ((1 - t) * ((1 - s) * texel(column, row) + s * texel(column + 1, row)) +
                            t * ((1 - s) * texel(column, row + 1) + s * texel(column + 1, row + 1)));
}

/// What the radiance may be if u and v are only known within `du` and `dv`.
struct ColourRange {
    glm::dvec3 low, high;
};
inline ColourRange mapRange(const EmitterDescription& emitter, const MapPoint& p, double du, double dv) {
    const double width = emitter.map.size.x, rows = std::max(emitter.map.size.y, 3u) - 1.0;
    std::vector<double> us{p.u - du, p.u, p.u + du}, vs;
    for (double i = std::ceil((p.u - du) * width - 0.5); i <= (p.u + du) * width - 0.5; ++i)
        us.push_back((i + 0.5) / width);
    for (const double v : {p.v - dv, p.v, p.v + dv}) vs.push_back(std::clamp(v, 0.0, 1.0));
    for (double j = std::ceil((p.v - dv) * rows); j <= (p.v + dv) * rows; ++j)
        vs.push_back(std::clamp(j / rows, 0.0, 1.0));
    ColourRange range{glm::dvec3(1e300), glm::dvec3(0)};
    for (const double u : us)
        for (const double v : vs) {
            const glm::dvec3 value = mapRadiance(emitter, u, v);
            range = {glm::min(range.low, value), glm::max(range.high, value)};
        }
    return range;
}

/// Roundings of u and v: `k` of the direction, whose azimuth is fuzzy near the poles, and as many of the result.
inline ColourRange mapRange(const EmitterDescription& emitter, const glm::dvec3& direction, double k) {
    const MapPoint p = mapPoint(emitter, direction);
    const double step = k * 0x1p-24;
    const double azimuth = p.sine > 0 ? step / (2 * std::numbers::pi * p.sine) : 0.5;
    return mapRange(emitter, p, std::min(step + azimuth, 0.5), 2 * step);
}

}  // namespace parhelion::test
