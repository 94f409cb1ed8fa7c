#include "gpu/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "gpu/device_internals.h"
#include "gpu/spirv_interface.h"
#include "gpu/vulkan_error.h"

namespace parhelion::gpu {

struct ComputePipeline::State {
    VkDevice device = VK_NULL_HANDLE;
    VkPhysicalDeviceLimits limits{};
    std::string name;  ///< the shader's path, for messages
    SpirvInterface interface;
    Handle<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout> setLayout;
    Handle<VkPipelineLayout, &vkDestroyPipelineLayout> layout;
    Handle<VkPipeline, &vkDestroyPipeline> pipeline;
    Handle<VkDescriptorPool, &vkDestroyDescriptorPool> pool;
    VkDescriptorSet set = VK_NULL_HANDLE;  ///< freed with its pool

    void createLayouts();
    void createPipeline(VkPipelineCache cache, std::span<const std::uint32_t> spirv, const Specialisation& constants);
    void allocateSet();
    void requireFits(const SpirvInterface::Resource& resource, VkBuffer buffer) const;
};

namespace {

/// The values a module declares constants for, laid out as Vulkan takes them: one 32-bit word each.
struct ConstantTable {
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<std::uint32_t> words;
};

std::uint32_t wordOf(bool value) { return value ? VK_TRUE : VK_FALSE; }
std::uint32_t wordOf(std::uint32_t value) { return value; }
std::uint32_t wordOf(float value) { return std::bit_cast<std::uint32_t>(value); }

ConstantTable tableOf(const Specialisation& constants, const SpirvInterface& interface, const std::string& shader) {
    using Type = SpirvInterface::ConstantType;
    ConstantTable table;
    for (const auto& [id, value] : constants) {
        const auto declared = interface.constants.find(id);
        if (declared == interface.constants.end()) continue;
        const Type given = std::holds_alternative<bool>(value)            ? Type::kBool
                           : std::holds_alternative<std::uint32_t>(value) ? Type::kInteger
                                                                          : Type::kFloat;
        if (given != declared->second)
            throw RuntimeFailure(fmt::format("{}: constant_id {} is given a value of another type", shader, id));
        table.entries.push_back({id, static_cast<std::uint32_t>(table.words.size() * sizeof(std::uint32_t)), 4});
        table.words.push_back(std::visit([](auto v) { return wordOf(v); }, value));
    }
    return table;
}

bool isTexelBuffer(VkDescriptorType type) {
    return type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
}

}  // namespace

void ComputePipeline::State::createLayouts() {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const SpirvInterface::Resource& resource : interface.resources)
        bindings.push_back({resource.binding, resource.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    VkDescriptorSetLayoutCreateInfo setInfo{};
    setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    setInfo.pBindings = bindings.data();
    VkDescriptorSetLayout created = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device, &setInfo, nullptr, &created), "vkCreateDescriptorSetLayout");
    setLayout = {device, created};

    if (interface.pushConstantBytes > limits.maxPushConstantsSize)
        throw RuntimeFailure(fmt::format("{}: {} bytes of push constants exceed the device's {}", name,
                                         interface.pushConstantBytes, limits.maxPushConstantsSize));
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, interface.pushConstantBytes};
    VkPipelineLayoutCreateInfo layoutInfo{};
    layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &created;
    layoutInfo.pushConstantRangeCount = range.size == 0 ? 0 : 1;
    layoutInfo.pPushConstantRanges = &range;
    VkPipelineLayout pipelineLayout = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device, &layoutInfo, nullptr, &pipelineLayout), "vkCreatePipelineLayout");
    layout = {device, pipelineLayout};
}

void ComputePipeline::State::createPipeline(VkPipelineCache cache, std::span<const std::uint32_t> spirv,
                                            const Specialisation& constants) {
    VkShaderModuleCreateInfo moduleInfo{};
    moduleInfo.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    moduleInfo.codeSize = spirv.size_bytes();
    moduleInfo.pCode = spirv.data();
    VkShaderModule created = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device, &moduleInfo, nullptr, &created), "vkCreateShaderModule");
    const Handle<VkShaderModule, &vkDestroyShaderModule> module(device, created);

    const ConstantTable table = tableOf(constants, interface, name);
    const VkSpecializationInfo specialisation{static_cast<std::uint32_t>(table.entries.size()), table.entries.data(),
                                              table.words.size() * sizeof(std::uint32_t), table.words.data()};
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = created;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialisation;
    info.layout = layout.get();
    VkPipeline result = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device, cache, 1, &info, nullptr, &result),
          fmt::format("{}: vkCreateComputePipelines", name).c_str());
    pipeline = {device, result};
}

void ComputePipeline::State::allocateSet() {
    std::map<VkDescriptorType, std::uint32_t> counts;
    for (const SpirvInterface::Resource& resource : interface.resources) ++counts[resource.type];
    std::vector<VkDescriptorPoolSize> sizes;
    for (const auto& [type, count] : counts) sizes.push_back({type, count});
    if (sizes.empty()) return;
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    VkDescriptorPool created = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device, &poolInfo, nullptr, &created), "vkCreateDescriptorPool");
    pool = {device, created};

    const VkDescriptorSetLayout wanted = setLayout.get();
    VkDescriptorSetAllocateInfo setInfo{};
    setInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    setInfo.descriptorPool = created;
    setInfo.descriptorSetCount = 1;
    setInfo.pSetLayouts = &wanted;
    check(vkAllocateDescriptorSets(device, &setInfo, &set), "vkAllocateDescriptorSets");
}

void ComputePipeline::State::requireFits(const SpirvInterface::Resource& resource, VkBuffer buffer) const {
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    const bool uniform = resource.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    const std::uint32_t limit = uniform ? limits.maxUniformBufferRange : limits.maxStorageBufferRange;
    if (needs.size > limit)
        throw RuntimeFailure(
            fmt::format("{}: \"{}\" takes {:.1f} MiB, but the device binds at most {:.1f} MiB ({}); "
                        "render a smaller part at once, or use another device",
                        name, resource.name, double(needs.size) / (1 << 20), double(limit) / (1 << 20),
                        uniform ? "maxUniformBufferRange" : "maxStorageBufferRange"));
}

ComputePipeline::ComputePipeline(Device& device, const std::filesystem::path& shader, const Specialisation& constants,
                                 const std::vector<std::string>& defines)
    : state_(std::make_unique<State>()) {
    const std::vector<std::uint32_t> spirv = compileShader(shader, defines);
    state_->device = device.handle();
    state_->limits = device.limits();
    state_->name = shader.string();
    state_->interface = reflect(spirv);
    state_->createLayouts();
    state_->createPipeline(device.internals().pipelineCache.get(), spirv, constants);
    state_->allocateSet();
}

ComputePipeline::~ComputePipeline() = default;
ComputePipeline::ComputePipeline(ComputePipeline&&) noexcept = default;

void ComputePipeline::bind(std::span<const Binding> bindings) {
    const auto& resources = state_->interface.resources;
    std::vector<VkDescriptorBufferInfo> buffers(resources.size());
    std::vector<VkBufferView> views(resources.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (std::size_t i = 0; i < resources.size(); ++i) {
        const auto given = std::find_if(bindings.begin(), bindings.end(),
                                        [&](const Binding& binding) { return binding.index == resources[i].binding; });
        const bool texels = isTexelBuffer(resources[i].type);
        if (given == bindings.end() || (texels ? given->view == VK_NULL_HANDLE : given->buffer == VK_NULL_HANDLE))
            throw RuntimeFailure(fmt::format("{}: binding {} (\"{}\") needs a {}, which the host did not give",
                                             state_->name, resources[i].binding, resources[i].name,
                                             texels ? "texel view" : "buffer"));
        if (!texels) state_->requireFits(resources[i], given->buffer);
        buffers[i] = {given->buffer, 0, VK_WHOLE_SIZE};
        views[i] = given->view;
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = state_->set;
        write.dstBinding = resources[i].binding;
        write.descriptorCount = 1;
        write.descriptorType = resources[i].type;
        write.pBufferInfo = &buffers[i];
        write.pTexelBufferView = &views[i];
        writes.push_back(write);
    }
    vkUpdateDescriptorSets(state_->device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

void ComputePipeline::record(VkCommandBuffer commands, std::span<const std::byte> pushConstants,
                             std::uint32_t groups) const {
    const State& state = *state_;
    if (pushConstants.size() != state.interface.pushConstantBytes)
        throw RuntimeFailure(fmt::format("{}: push constants take {} bytes; the host gave {}", state.name,
                                         state.interface.pushConstantBytes, pushConstants.size()));
    if (groups > state.limits.maxComputeWorkGroupCount[0])
        throw RuntimeFailure(fmt::format("{}: {} workgroups exceed the device's {} a dispatch", state.name, groups,
                                         state.limits.maxComputeWorkGroupCount[0]));
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, state.pipeline.get());
    if (state.set != VK_NULL_HANDLE)
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, state.layout.get(), 0, 1, &state.set, 0,
                                nullptr);
    if (!pushConstants.empty())
        vkCmdPushConstants(commands, state.layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           static_cast<std::uint32_t>(pushConstants.size()), pushConstants.data());
    vkCmdDispatch(commands, groups, 1, 1);
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                            VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
        &barrier, 0, nullptr, 0, nullptr);
}

}  // namespace parhelion::gpu
