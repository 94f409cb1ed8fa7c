#pragma once

#include <vector>

#include "compile/compiled_scene.h"
#include "gpu/device.h"
#include "gpu/pipeline.h"

namespace parhelion::render {

/// A CompiledScene in device buffers, with the bindings of shaders/core/scene.glsl.
class DeviceScene {
public:
    /// @throws RuntimeFailure when an array exceeds what the device can bind.
    DeviceScene(gpu::Device& device, const CompiledScene& scene);

    const std::vector<gpu::Binding>& bindings() const { return bindings_; }

private:
    template <typename T>
    void addTexels(gpu::Device& device, std::uint32_t binding, const std::vector<T>& values, VkFormat format);

    std::vector<gpu::Buffer> buffers_;
    std::vector<gpu::Binding> bindings_;
};

}  // namespace parhelion::render
