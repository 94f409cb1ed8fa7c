#include "image/color_space.h"

#include <cmath>

namespace parhelion {

namespace {

glm::dvec3 xyzOf(glm::dvec2 xy) { return {xy.x, xy.y, 1.0 - xy.x - xy.y}; }

double squaredDistance(const Chromaticities& a, const Chromaticities& b) {
    const glm::dvec2 differences[] = {a.red - b.red, a.green - b.green, a.blue - b.blue, a.white - b.white};
    double sum = 0.0;
    for (const glm::dvec2& difference : differences) sum += glm::dot(difference, difference);
    return sum;
}

}  // namespace

bool spansColours(const Chromaticities& space) {
    constexpr double kLeast = 1e-6;  // Rec. 709 has .22, twice its triangle's area
    const glm::dvec2 toGreen = space.green - space.red, toBlue = space.blue - space.red;
    return std::abs(toGreen.x * toBlue.y - toGreen.y * toBlue.x) >= kLeast && std::abs(space.white.y) >= kLeast;
}

glm::dmat3 xyzFromRgb(const Chromaticities& space) {
    const glm::dmat3 primaries(xyzOf(space.red), xyzOf(space.green), xyzOf(space.blue));
    const glm::dvec3 amounts = glm::inverse(primaries) * (xyzOf(space.white) / space.white.y);
    return {primaries[0] * amounts.x, primaries[1] * amounts.y, primaries[2] * amounts.z};
}

glm::dmat3 rec709FromRgb(const Chromaticities& space) {
    constexpr double kSame = 1e-6;  // Mitsuba's
    constexpr Chromaticities kXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3.0, 1.0 / 3.0}};
    if (squaredDistance(space, kRec709) < kSame) return glm::dmat3(1.0);
    if (squaredDistance(space, kXyz) < kSame) return kRec709FromXyz;
    return glm::inverse(xyzFromRgb(kRec709)) * xyzFromRgb(space);
}

glm::dvec3 rgbFromChroma(double y, double ry, double by, const Chromaticities& space) {
    const glm::dmat3 xyz = xyzFromRgb(space);
    const glm::dvec3 weights = glm::dvec3(xyz[0].y, xyz[1].y, xyz[2].y) / (xyz[0].y + xyz[1].y + xyz[2].y);
    const double red = (ry + 1.0) * y, blue = (by + 1.0) * y;
    return {red, (y - red * weights.r - blue * weights.b) / weights.g, blue};
}

}  // namespace parhelion
