#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/error_monitor.h"
#include "image/image.h"

namespace parhelion::app {

/// What a render says of its error: how wrong the image is, how far that can be trusted, and what less would cost.
struct ErrorReport {
    ErrorNorm norm = ErrorNorm::Rms;
    std::optional<double> target;          ///< --error
    std::optional<double> seconds;         ///< --time
    std::optional<std::uint64_t> maximum;  ///< --spp
    std::optional<FilmError> estimate;     ///< nothing for one sample a pixel and for a black image
    std::optional<double> controlError;    ///< by the norm, from the control pixels
    std::vector<ErrorCheckpoint> checkpoints;
    std::vector<TrustCheck> checks;
    std::optional<double> samplesForTarget, secondsForTarget;
    std::optional<double> samplesForHalf, secondsForHalf;  ///< half of the error that is reached

    bool isTrusted() const { return estimate && parhelion::isTrusted(checks); }
};

nlohmann::ordered_json toJson(const ErrorReport& report);
/// A few lines for a person.
std::string describe(const ErrorReport& report);
/// Attributes parhelion.error, .errorLower, .errorUpper (rms, shares of 1), .errorTrusted and the like.
void addAttributes(const ErrorReport& report, Image& image);
/// Channels error.Y, half width of the 95 % interval of each pixel's luminance [radiance], and trust.Y, 1 where that
/// interval can be trusted and else 0; nothing for films of one sample a pixel.
void addErrorLayers(Image& image, const Film& film);

}  // namespace parhelion::app
