#include "gpu/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

#include "base/error.h"
#include "gpu/software_driver.h"
#include "gpu/vulkan_error.h"

namespace parhelion::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

/// Sets an environment variable for a scope, unless the user has set it.
class DefaultVariable {
public:
    DefaultVariable(const char* name, const char* value) : name_(name), ours_(std::getenv(name) == nullptr) {
        if (ours_) ::setenv(name, value, 0);
    }
    ~DefaultVariable() {
        if (ours_) ::unsetenv(name_);
    }
    DefaultVariable(const DefaultVariable&) = delete;
    DefaultVariable& operator=(const DefaultVariable&) = delete;

private:
    const char* name_;
    bool ours_;
};

VKAPI_ATTR VkBool32 VKAPI_CALL keepMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& log = *static_cast<ValidationLog*>(user);
    log.messages.emplace_back(data->pMessage);
    if (log.listener) log.listener(log.messages.back());
    return VK_FALSE;
}

/// GENERAL messages are left out: they are the loader's, about other drivers of the machine.
VkDebugUtilsMessengerCreateInfoEXT messengerReportingTo(ValidationLog* log) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = keepMessage;
    info.pUserData = log;
    return info;
}

void requireValidationLayer() {
    std::uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
    const bool present = std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, kValidationLayer) == 0;
    });
    if (!present)
        throw RuntimeFailure(
            fmt::format("validation was asked for, but {} is not installed; "
                        "the Debian package vulkan-validationlayers provides it",
                        kValidationLayer));
}

VkResult createInstance(ValidationLog* log, VkInstance& instance) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "parhelion";
    application.apiVersion = VK_API_VERSION_1_2;

    const VkDebugUtilsMessengerCreateInfoEXT messenger = messengerReportingTo(log);
    const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = &messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &enabled;
    const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};

    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (log) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
        info.ppEnabledExtensionNames = extensions.data();
    }
    return vkCreateInstance(&info, nullptr, &instance);
}

/// An extension's function. volk's pointers are those of the instance loaded last, which may lack the extension.
template <typename Function>
Function functionOf(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

const char* typeName(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return "cpu";
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return "discrete gpu";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return "integrated gpu";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return "virtual gpu";
        default:
            return "other";
    }
}

}  // namespace

Instance::Instance(Drivers drivers, ValidationLog* log) {
    if (volkInitialize() != VK_SUCCESS)
        throw RuntimeFailure(
            "no Vulkan loader (libvulkan.so.1) is installed; the Debian package libvulkan1 provides it");
    if (log) requireValidationLayer();
    bool found = false;
    if (drivers == Drivers::kSoftwareFirst) {
        // Other drivers stay unloaded: slow to start, and talkative on machines without their hardware.
        const DefaultVariable onlySoftware("VK_LOADER_DRIVERS_SELECT", "*lvp*");
        found = open(log);
    }
    if (!found) found = open(log);
    if (!found)
        throw RuntimeFailure(
            "no Vulkan device was found; the Debian package mesa-vulkan-drivers provides one that "
            "needs no graphics card");
}

Instance::~Instance() { close(); }

bool Instance::open(ValidationLog* log) {
    const VkResult result = createInstance(log, instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return false;
    check(result, "vkCreateInstance");
    volkLoadInstance(instance_);
    if (log) {
        const VkDebugUtilsMessengerCreateInfoEXT info = messengerReportingTo(log);
        const auto create = functionOf<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT");
        check(create(instance_, &info, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
    }
    std::uint32_t count = 0;
    VkResult listed = vkEnumeratePhysicalDevices(instance_, &count, nullptr);
    devices_.resize(count);
    if (listed == VK_SUCCESS) listed = vkEnumeratePhysicalDevices(instance_, &count, devices_.data());
    // VK_ERROR_INITIALIZATION_FAILED is the loader's word for "no driver has a device".
    if (listed != VK_ERROR_INITIALIZATION_FAILED) check(listed, "vkEnumeratePhysicalDevices");
    if (count == 0) close();
    return count != 0;
}

void Instance::close() {
    if (messenger_ != VK_NULL_HANDLE)
        functionOf<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
            instance_, messenger_, nullptr);
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
    messenger_ = VK_NULL_HANDLE;
    instance_ = VK_NULL_HANDLE;
}

DeviceInfo describe(VkPhysicalDevice device) {
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(device, &properties);
    const VkPhysicalDeviceProperties& core = properties.properties;
    return {.name = core.deviceName,
            .driver = fmt::format("{} {}", driver.driverName, driver.driverInfo),
            .type = typeName(core.deviceType),
            .software = core.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU};
}

VkPhysicalDevice selectDevice(const Instance& instance, const std::string& name) {
    const std::vector<VkPhysicalDevice>& devices = instance.devices();
    if (name.empty()) {
        const auto software =
            std::find_if(devices.begin(), devices.end(), [](VkPhysicalDevice d) { return describe(d).software; });
        return software != devices.end() ? *software : devices.front();
    }
    const bool isIndex =
        name.size() <= 4 && std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
    if (isIndex && std::stoul(name) < devices.size()) return devices[std::stoul(name)];
    std::string present;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const std::string deviceName = describe(devices[i]).name;
        if (!isIndex && lowered(deviceName).find(lowered(name)) != std::string::npos) return devices[i];
        present += fmt::format("\n  {}  {}", i, deviceName);
    }
    throw InputError(
        fmt::format("no device matches; expected an index or a part of a name of{}\ngot \"{}\"", present, name));
}

std::vector<DeviceInfo> listDevices() {
    configureSoftwareDriver(0);
    const Instance instance(Instance::Drivers::kAll, nullptr);
    std::vector<DeviceInfo> infos;
    for (const VkPhysicalDevice device : instance.devices()) infos.push_back(describe(device));
    return infos;
}

}  // namespace parhelion::gpu
