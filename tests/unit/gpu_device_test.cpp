#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "base/error.h"
#include "gpu/device_internals.h"
#include "gpu/software_driver.h"
#include "support/gpu_fixture.h"

namespace parhelion {
namespace {

using test::testDevice;
using testing::HasSubstr;

std::string failureOf(const auto& action) {
    try {
        action();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "no failure";
}

TEST(GpuDevice, OpensSoftwareDriverFirst) {
    const auto listed = gpu::listDevices();
    ASSERT_FALSE(listed.empty());
    const bool anySoftware = std::any_of(listed.begin(), listed.end(), [](const auto& info) { return info.software; });
    EXPECT_EQ(testDevice().info().software, anySoftware);
    EXPECT_FALSE(testDevice().info().driver.empty());
    EXPECT_GE(testDevice().memoryBytes(), std::uint64_t{256} << 20);
}

TEST(GpuDevice, SubgroupSpansOneVector) {
    gpu::Device& device = testDevice();
    if (!device.info().software) GTEST_SKIP() << "vector widths are the software driver's";
    const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
    ASSERT_NE(width, nullptr);
    EXPECT_EQ(device.subgroupSize() * 32, std::stoul(width));
    EXPECT_THAT(device.info().name, HasSubstr(std::string(width) + " bits"));
}

TEST(GpuDevice, KeepsShaderCachesOfWidthsApart) {
    testDevice();
    const char* folder = std::getenv("MESA_SHADER_CACHE_DIR");
    if (!folder) GTEST_SKIP() << "no folder can be written, or the caller disabled the driver's cache";
    EXPECT_THAT(folder, HasSubstr(std::getenv("LP_NATIVE_VECTOR_WIDTH")));
}

TEST(GpuDevice, RefusesVectorWidthOtherThanDecided) {
    testDevice();
    const unsigned decided = static_cast<unsigned>(std::stoul(std::getenv("LP_NATIVE_VECTOR_WIDTH")));
    const unsigned other = decided == 128 ? 256 : 128;
    EXPECT_THROW(gpu::configureSoftwareDriver(other), InputError);
    EXPECT_THROW(gpu::configureSoftwareDriver(100), InputError);
    EXPECT_NO_THROW(gpu::configureSoftwareDriver(decided));
}

TEST(GpuDevice, NamesThePresentOnesWhenNoneMatches) {
    const std::string message = failureOf([] { gpu::Device({.name = "no such device"}); });
    EXPECT_THAT(message, HasSubstr("no such device"));
    EXPECT_THAT(message, HasSubstr(gpu::listDevices().front().name));
    EXPECT_THROW(gpu::Device({.name = "99"}), InputError);
}

TEST(GpuDevice, OpensByIndexAndByPartOfNameWhateverItsCase) {
    const std::string name = gpu::listDevices().front().name;
    EXPECT_EQ(gpu::Device({.name = "0"}).info().name, name);
    std::string part = name.substr(0, 5);
    std::transform(part.begin(), part.end(), part.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_EQ(gpu::Device({.name = part}).info().name, name);
}

TEST(GpuDevice, WithValidationOutlivesOneWithout) {
    gpu::Device watched({.validation = true});
    { const gpu::Device other; }
    gpu::listDevices();
    EXPECT_NO_THROW(watched.submit([](VkCommandBuffer) {}));
}

TEST(GpuBuffer, StartsAsZeros) {
    gpu::Buffer buffer = testDevice().createBuffer(1 << 20);
    const auto words = buffer.as<std::uint32_t>();
    EXPECT_EQ(words.size(), (1u << 20) / 4);
    EXPECT_TRUE(std::all_of(words.begin(), words.end(), [](std::uint32_t word) { return word == 0; }));
}

TEST(GpuBuffer, KeepsItsContentWhenMoved) {
    gpu::Buffer buffer = testDevice().createBuffer(8);
    buffer.as<std::uint32_t>()[1] = 7;
    gpu::Buffer moved = std::move(buffer);
    EXPECT_EQ(moved.as<std::uint32_t>()[1], 7u);
    EXPECT_EQ(buffer.size(), 0u);
    EXPECT_EQ(buffer.handle(), VkBuffer{VK_NULL_HANDLE});
}

TEST(GpuBuffer, OfNoBytesCanStillBeViewed) {
    gpu::Buffer buffer = testDevice().createBuffer(0);
    EXPECT_EQ(buffer.size(), 0u);
    EXPECT_NE(buffer.texelView(VK_FORMAT_R32_SFLOAT), VkBufferView{VK_NULL_HANDLE});
}

TEST(GpuBuffer, BeyondTheDeviceFailsWithSizeAndLimit) {
    const std::uint64_t limit = testDevice().internals().maxAllocation;
    const std::string message = failureOf([&] { testDevice().createBuffer(limit + 1); });
    EXPECT_THAT(message, HasSubstr("MiB"));
    EXPECT_THAT(message, HasSubstr(testDevice().info().name));
    EXPECT_THROW(testDevice().createBuffer(limit + 1), RuntimeFailure);
}

TEST(GpuSubmit, ReportsTimeAndSurvivesFailedRecording) {
    gpu::Device& device = testDevice();
    EXPECT_THROW(device.submit([](VkCommandBuffer) { throw std::runtime_error("recording failed"); }),
                 std::runtime_error);
    gpu::Buffer buffer = device.createBuffer(64 << 20);
    const double ms = device.submit(
        [&](VkCommandBuffer commands) { vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, 0x01020304); });
    EXPECT_EQ(buffer.as<std::uint32_t>().back(), 0x01020304u);
    // 64 MiB at 1 TB/s take 0.07 ms; ten seconds would be 6.7 MB/s.
    EXPECT_GT(ms, 0.01);
    EXPECT_LT(ms, 1e4);
}

TEST(GpuValidation, ReportsMisuse) {
    gpu::Device& device = testDevice();
    ASSERT_TRUE(device.validationMessages().empty());
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    info.size = 0;  // VUID-VkBufferCreateInfo-size-00912: must be greater than 0
    VkBuffer buffer = VK_NULL_HANDLE;
    vkCreateBuffer(device.handle(), &info, nullptr, &buffer);
    EXPECT_FALSE(device.validationMessages().empty());
    const std::vector<std::string> messages = test::takeValidationMessages();
    if (buffer != VK_NULL_HANDLE) vkDestroyBuffer(device.handle(), buffer, nullptr);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_THAT(messages[0], HasSubstr("VUID-VkBufferCreateInfo-size-00912"));
    EXPECT_TRUE(device.validationMessages().empty());
}

TEST(GpuValidation, ReportsHazardBetweenUnsynchronisedWrites) {
    gpu::Device& device = testDevice();
    gpu::Buffer buffer = device.createBuffer(64);
    device.submit([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 1);
        vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 2);
    });
    const std::vector<std::string> messages = test::takeValidationMessages();
    ASSERT_FALSE(messages.empty());
    EXPECT_THAT(messages[0], HasSubstr("WRITE_AFTER_WRITE"));
}

TEST(GpuValidation, ReportsWhatIsLeftBehindWhenTheDeviceCloses) {
    std::vector<std::string> messages;
    {
        gpu::Device device({.validation = true,
                            .onValidationMessage = [&](const std::string& message) { messages.push_back(message); }});
        VkFenceCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        VkFence leaked = VK_NULL_HANDLE;
        ASSERT_EQ(vkCreateFence(device.handle(), &info, nullptr, &leaked), VK_SUCCESS);
        EXPECT_TRUE(messages.empty());
    }
    EXPECT_FALSE(messages.empty());
}

}  // namespace
}  // namespace parhelion
