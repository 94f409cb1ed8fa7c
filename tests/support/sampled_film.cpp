#include "support/sampled_film.h"

#include "reference/integrator/film.h"

namespace parhelion::test {
namespace {

constexpr std::uint32_t kTileEdge = 4;

/// A hash of 64 bits (Steele, Lea, Flood 2014, "Fast Splittable Pseudorandom Number Generators").
std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

double toUnit(std::uint64_t word) { return static_cast<double>(word >> 11) * 0x1p-53; }

/// Sample s of the van der Corput sequence with nested random digits (Owen 1995): a digit is flipped by a hash of those
/// before it.
double scrambled(std::uint64_t s, std::uint64_t stream) {
    std::uint64_t digits = 0;
    for (int bit = 0; bit < 40; ++bit) {
        const std::uint64_t plain = s >> bit & 1u, flip = mix(stream ^ mix(digits << 8 | std::uint64_t(bit))) & 1u;
        digits = digits << 1 | (plain ^ flip);
    }
    return (static_cast<double>(digits) + toUnit(mix(stream ^ s))) * 0x1p-40;
}

}  // namespace

SampledFilm::SampledFilm(const SampledScene& scene, std::uint64_t seed) : scene_(scene), seed_(mix(seed)) {
    film_.filmSize = film_.crop.size = scene.size;
    film_.stratified = scene.stratified;
    film_.pixels.resize(std::size_t{scene.size.x} * scene.size.y);
    film_.controlTileEdge = kTileEdge;
    for (std::uint32_t y = 0; y < scene.size.y; ++y)
        for (std::uint32_t x = 0; x < scene.size.x; ++x) {
            const std::uint64_t drawn = mix(seed_ ^ mix(std::uint64_t{y / kTileEdge} << 32 | x / kTileEdge)) % 16;
            if (drawn == y % kTileEdge * kTileEdge + x % kTileEdge)
                film_.controls.push_back({.pixel = y * scene.size.x + x, .runs = {}});
        }
}

void SampledFilm::addTo(shared::FilmPixel& pixel, std::uint64_t stream) {
    const std::uint64_t key = mix(seed_ ^ mix(stream));
    const double u = scene_.stratified ? scrambled(film_.samples, key) : toUnit(mix(key ^ mix(film_.samples)));
    reference::Counters counters{};
    reference::accumulate(pixel, glm::vec3(static_cast<float>(scene_.sample(u))), film_.samples == 0, counters);
}

const Film& SampledFilm::growTo(std::uint64_t samples) {
    for (; film_.samples < samples; ++film_.samples) {
        for (std::size_t i = 0; i < film_.pixels.size(); ++i) addTo(film_.pixels[i], i);
        for (ControlPixel& control : film_.controls)
            for (std::uint64_t run = 0; run < shared::kControlRuns; ++run)
                addTo(control.runs[run], (run + 1) << 32 | control.pixel);
    }
    return film_;
}

}  // namespace parhelion::test
