#include "gpu_fixture.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "gpu/device_internals.h"
#include "support/paths.h"

namespace parhelion::test {
namespace {

/// Owns the process's device, so that it is closed while failures can still be reported.
class GpuEnvironment : public testing::Environment {
public:
    gpu::Device& device() {
        if (!device_) {
            gpu::DeviceOptions options;
            options.validation = true;
            options.onValidationMessage = [this](const std::string& message) { messages_.push_back(message); };
            device_ = std::make_unique<gpu::Device>(options);
        }
        return *device_;
    }

    std::vector<std::string> takeMessages() {
        if (device_) device_->internals().log.messages.clear();
        return std::exchange(messages_, {});
    }

    void TearDown() override {
        device_.reset();
        for (const std::string& message : takeMessages()) ADD_FAILURE() << "Vulkan validation: " << message;
    }

private:
    std::vector<std::string> messages_;
    std::unique_ptr<gpu::Device> device_;
};

/// GoogleTest takes environments before main and deletes them after it.
GpuEnvironment& environment = *static_cast<GpuEnvironment*>(testing::AddGlobalTestEnvironment(new GpuEnvironment));

struct ProbeArguments {
    std::uint32_t count, inputsPerItem, outputsPerItem;
};

// Of probe.glsl.
constexpr std::uint32_t kProbeFunction = 255, kProbeArguments = 29, kProbeInputs = 30, kProbeOutputs = 31;
constexpr std::uint32_t kProbeGroup = 64;

std::filesystem::path testFolder() { return std::filesystem::path(projectFolder()) / "tests"; }

}  // namespace

gpu::Device& testDevice() { return environment.device(); }

std::vector<std::string> takeValidationMessages() { return environment.takeMessages(); }

std::vector<glm::vec4> probe(const std::filesystem::path& shader, std::uint32_t function,
                             std::span<const glm::vec4> inputs, std::uint32_t inputsPerItem,
                             std::uint32_t outputsPerItem, const gpu::Specialisation& constants,
                             std::span<const gpu::Binding> extra) {
    if (inputsPerItem == 0 || inputs.size() % inputsPerItem != 0)
        throw std::invalid_argument("probe: inputs must be whole items");
    const auto count = static_cast<std::uint32_t>(inputs.size() / inputsPerItem);
    gpu::Device& device = testDevice();
    gpu::Buffer inputBuffer = device.createBuffer(inputs.size_bytes());
    gpu::Buffer outputBuffer = device.createBuffer(std::size_t{count} * outputsPerItem * sizeof(glm::vec4));
    inputBuffer.write(0, std::as_bytes(inputs));
    const ProbeArguments arguments{count, inputsPerItem, outputsPerItem};
    gpu::Buffer argumentBuffer = device.createBuffer(sizeof arguments);
    argumentBuffer.write(0, std::as_bytes(std::span(&arguments, 1)));
    std::vector<gpu::Binding> bindings(extra.begin(), extra.end());
    bindings.push_back({.index = kProbeArguments, .buffer = argumentBuffer.handle()});
    bindings.push_back({.index = kProbeInputs, .buffer = inputBuffer.handle()});
    bindings.push_back({.index = kProbeOutputs, .buffer = outputBuffer.handle()});

    gpu::Specialisation withFunction = constants;
    withFunction[kProbeFunction] = function;
    gpu::ComputePipeline pipeline(device, testFolder() / shader, withFunction);
    pipeline.bind(bindings);
    device.submit(
        [&](VkCommandBuffer commands) { pipeline.record(commands, {}, (count + kProbeGroup - 1) / kProbeGroup); });
    const auto outputs = outputBuffer.as<glm::vec4>();
    return {outputs.begin(), outputs.end()};
}

}  // namespace parhelion::test
