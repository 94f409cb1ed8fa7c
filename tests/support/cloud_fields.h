#pragma once

#include "shared/cloud_types.h"

namespace parhelion::test {

/// The field of scenes/cloud_detail.xml at some detail.
inline shared::CloudField sweepField(float detail, std::uint32_t resolution) {
    return {.detailAmount = detail,
            .noiseScale = 2.6f,
            .warpAmount = 0.28f,
            .erosionAmount = 0.30f,
            .surfaceWidth = 0.14f,
            .densityScale = 0.85f,
            .densityThreshold = 0.02f,
            .noiseSeed = 4,
            .resolution = glm::uvec3(resolution),
            .modulates = 0};
}

}  // namespace parhelion::test
