#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "support/rendering.h"

namespace parhelion::test {

/// A scene and its image by Mitsuba in tests/references.
struct MitsubaReference {
    std::string name;       ///< of the image
    std::string scene;      ///< relative to the project's folder
    std::uint64_t samples;  ///< per pixel and seed that show meanTolerance
    double meanTolerance;   ///< relative, of the image mean
    /// Stratified samples leave little but the rare bright ones, and a pixel's eight images do not show how rare: where
    /// those rule, independent samples make the z-test of pixels a fair one.
    bool sobol = true;

    friend void PrintTo(const MitsubaReference& self, std::ostream* stream) { *stream << self.name; }
};

/// Renders with eight seeds at the reference's size and prints how it compares. Fails unless the image means, 8 x 8
/// tiles and pixels agree within the noise of both sides, and unless the 95 % interval of the ratio of the means lies
/// within the tolerance in each channel.
void expectAgreement(const MitsubaReference& reference, const std::string& projectFolder, Backend backend);

}  // namespace parhelion::test
