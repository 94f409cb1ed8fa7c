#include "scene/read_sky.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "shared/scene_types.h"

namespace parhelion {
namespace {

void readStars(PropertyReader& reader, const SkyNames& names, ColorRole role, SkyDescription& sky) {
    constexpr double kPi = std::numbers::pi;
    constexpr NumberRange kSize{1e-3, 10.0, false, false, "be in [0.001, 10] degrees"};
    sky.starDensity = reader.number(names.starDensity, 0.0, kNonNegative);
    sky.starSizeDegrees = reader.number(names.starSize, 0.1, kSize);
    sky.starRadiance = reader.color(names.starRadiance, 1.0, kNonNegative, role);
    sky.starSeed = std::uint32_t(reader.integer(names.starSeed, 0, 0, 0xffffffffll));
    const double stars = 4.0 * kPi * sky.starDensity;
    if (stars > shared::kMaxStars)
        reader.fail(reader.whereOf(names.starDensity),
                    fmt::format("\"{}\" must be at most {:.0f} per steradian ({} stars); got {}", names.starDensity,
                                std::floor(shared::kMaxStars / (4.0 * kPi)), shared::kMaxStars, sky.starDensity));
    const double sine = std::sin(sky.starSizeDegrees * kPi / 720.0);  // of half the radius
    const double covered = stars * sine * sine;
    if (covered > 0.1)
        reader.fail(reader.whereOf(names.starDensity),
                    fmt::format("stars must cover at most a tenth of the sky; got {:.3g} of it, by \"{}\" {} per "
                                "steradian and \"{}\" {} degrees",
                                covered, names.starDensity, sky.starDensity, names.starSize, sky.starSizeDegrees));
}

}  // namespace

SkyDescription readSky(PropertyReader& reader, const SkyNames& names, ColorRole role) {
    SkyDescription sky;
    const glm::dvec3 axis = reader.triple(names.axis, sky.axis);
    const double length = glm::length(axis);
    if (!(length > 1e-150 && length < 1e150))
        reader.fail(reader.whereOf(names.axis),
                    fmt::format("\"{}\" must not be zero or longer than 1e150", names.axis));
    sky.axis = axis / length;
    constexpr NumberRange kOffset{-1e30, 1e30, false, false, "be in [-1e30, 1e30]"};
    sky.offset = reader.number(names.offset, sky.offset, kOffset);
    sky.width = reader.number(names.width, sky.width, kNonNegative);
    sky.power = reader.number(names.power, sky.power, kNonNegative);
    sky.bottom = reader.color(names.bottom, 0.0, kNonNegative, role);
    sky.top = reader.color(names.top, 1.0, kNonNegative, role);
    readStars(reader, names, role, sky);
    return sky;
}

}  // namespace parhelion
