#include "support/coverage.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/pixel_moments.h"
#include "analysis/statistics.h"

namespace parhelion::test {

std::string Coverage::text() const {
    const double pixels = double(trusted + others + dark);
    return fmt::format(
        "image {:.1f} %; trusted pixels ({:.1f} %) {:.2f} %; others ({:.1f} %) {:.1f} %; error within its interval "
        "{:.1f} %; {:.1f} samples, z of the mean {:.2f}",
        100 * ofImage(), 100 * double(trusted) / pixels, 100 * ofTrusted(), 100 * double(others) / pixels,
        100 * ofOthers(), 100 * double(errorTrusted) / double(renders), samples, meanZ);
}

namespace {

std::uint64_t samplesOf(const Film& film, std::size_t pixel) {
    return film.pixelSamples.empty() ? film.samples : film.pixelSamples[pixel];
}

}  // namespace

Coverage coverageOf(const std::function<Film(std::uint32_t seed)>& render, std::uint32_t firstSeed, std::size_t renders,
                    std::span<const double> truth) {
    Coverage coverage{.renders = renders};
    RunningMoments means;
    double mean = 0;
    for (const double value : truth) mean += value / double(truth.size());
    for (std::size_t k = 0; k < renders; ++k) {
        const Film film = render(firstSeed + std::uint32_t(k));
        const FilmError error = estimateFilmError(film).value_or(FilmError{});
        const std::vector<float> factors = varianceFactorsOf(film);
        const PixelErrors pixels = estimatePixelErrors(film);
        const double unit = film.radianceUnit;
        coverage.image += error.mean[3].lower <= mean * unit && mean * unit <= error.mean[3].upper;
        means.add(error.mean[3].value / unit);
        double squares = 0;
        for (std::size_t i = 0; i < film.pixels.size(); ++i) {
            const PixelMoments moments = momentsOf(film.pixels[i], samplesOf(film, i));
            const PixelInterval interval = intervalOf(moments, factors.empty() ? 1.0 : double(factors[i]));
            const bool isTrusted = pixels.isTrusted[i] > 0;
            coverage.samples += moments.samples / double(film.pixels.size() * renders);
            squares += std::pow(moments.mean - truth[i], 2) / double(film.pixels.size());
            if (moments.isDark()) {
                ++coverage.dark;
                continue;
            }
            ++(isTrusted ? coverage.trusted : coverage.others);
            (isTrusted ? coverage.trustedCovered : coverage.othersCovered) += interval.covers(truth[i]);
        }
        const double rms = std::sqrt(squares) / mean;
        coverage.errorTrusted += error.rms.lower <= rms && rms <= error.rms.upper;
    }
    coverage.meanZ = (means.mean() - mean) / means.standardError();
    return coverage;
}

std::vector<double> meanLuminance(const std::function<Film(std::uint32_t seed)>& render, std::uint32_t firstSeed,
                                  std::size_t renders) {
    std::vector<double> sums;
    for (std::size_t k = 0; k < renders; ++k) {
        const Film film = render(firstSeed + std::uint32_t(k));
        sums.resize(film.pixels.size(), 0.0);
        for (std::size_t i = 0; i < sums.size(); ++i)
            sums[i] += momentsOf(film.pixels[i], samplesOf(film, i)).mean / double(renders);
    }
    return sums;
}

RenderSettings settingsWithControls(const CompiledScene& scene, std::uint64_t samples, std::uint32_t seed, bool sobol) {
    RenderSettings settings;
    settings.sampleCount = samples;
    settings.seed = seed;
    settings.featureSamples = 0;
    settings.quality.sobol = sobol;
    settings.effects = scene.effects;
    settings.controls = chooseControlPixels(scene.cropSize, seed);
    return settings;
}

}  // namespace parhelion::test
