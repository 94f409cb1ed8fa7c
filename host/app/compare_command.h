#pragma once

#include <optional>
#include <string>

#include "app/options.h"

namespace parhelion::app {

struct CompareArguments {
    std::string imageA, imageB;
    std::string error;     ///< EXR to write, or empty
    std::string pictures;  ///< prefix of PNGs to write, or empty
    std::optional<double> maxMse, maxMae, maxError, maxRelativeMse, maxMeanDifference, meanWithin;
    std::optional<double> errorRange;  ///< of the picture of the error
    bool requireAgreement = false;
    bool requireNoiseAlone = false;
    bool requireIndependentNoise = false;
    bool json = false;
};

Command addCompareCommand(CommandLine& program, CompareArguments& arguments);

/// Prints how two images differ. Returns kExitFailed when a threshold is exceeded.
int runCompareCommand(const CompareArguments& arguments);

}  // namespace parhelion::app
