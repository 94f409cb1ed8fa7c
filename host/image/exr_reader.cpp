#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <OpenEXRConfig.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/files.h"
#include "base/memory.h"
#include "image/image.h"

namespace parhelion {

namespace {

/// The pixels that the file holds, whatever part of its display window they cover.
glm::uvec2 sizeOf(const Imath::Box2i& window) {
    return {static_cast<unsigned>(window.max.x - window.min.x + 1),
            static_cast<unsigned>(window.max.y - window.min.y + 1)};
}

void requireFlatSinglePart(const Imf::MultiPartInputFile& input, const SourceLocation& where) {
    if (input.parts() != 1)
        throw InputError(where, fmt::format("an EXR file must have one part; got {}", input.parts()));
    const Imf::Header& header = input.header(0);
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw InputError(where, fmt::format("an EXR file must hold flat pixels; got part type '{}'", header.type()));
}

void requireReadableChannels(const Imf::Header& header, const SourceLocation& where) {
    std::size_t count = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel, ++count)
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            throw InputError(where,
                             fmt::format("EXR channels must be sampled at every pixel; got '{}' at every {} x {}",
                                         channel.name(), channel.channel().xSampling, channel.channel().ySampling));
    if (count == 0) throw InputError(where, "an EXR file must have at least one channel; got none");
    const glm::uvec2 size = sizeOf(header.dataWindow());
    const double bytes = double(size.x) * size.y * count * sizeof(float);
    // A damaged header can ask for anything; twice, because decoding needs buffers of its own.
    if (2 * bytes > static_cast<double>(physicalMemoryBytes()))
        throw InputError(where, fmt::format("an EXR file must fit into half of the memory ({} bytes); got {} x {} "
                                            "pixels of {} channels",
                                            physicalMemoryBytes(), size.x, size.y, count));
}

/// Every header has these; they describe the file, not the picture.
bool isStructural(std::string_view name) {
    constexpr std::array<std::string_view, 6> kNames{"pixelAspectRatio", "screenWindowWidth", "name", "type",
                                                     "version",          "chunkCount"};
    return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

std::map<std::string, Image::Attribute> readAttributes(const Imf::Header& header) {
    std::map<std::string, Image::Attribute> result;
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        if (isStructural(entry.name())) continue;
        const Imf::Attribute& attribute = entry.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
            result[entry.name()] = text->value();
        else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute))
            result[entry.name()] = std::int64_t{integer->value()};
        else if (const auto* wide = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
            result[entry.name()] = wide->value();
        else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
            result[entry.name()] = double{real->value()};
    }
    return result;
}

std::optional<Chromaticities> readChromaticities(const Imf::Header& header) {
    if (!Imf::hasChromaticities(header)) return std::nullopt;
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    return Chromaticities{{c.red.x, c.red.y}, {c.green.x, c.green.y}, {c.blue.x, c.blue.y}, {c.white.x, c.white.y}};
}

std::string readEnvironmentLayout(const Imf::Header& header) {
    if (!Imf::hasEnvmap(header)) return {};
    const Imf::Envmap layout = Imf::envmap(header);
    return layout == Imf::ENVMAP_LATLONG ? "latitude-longitude" : layout == Imf::ENVMAP_CUBE ? "cube" : "unknown";
}

/// What the header says of the pixels beyond their values.
std::vector<std::string> remarksOn(const Imf::Header& header) {
    std::vector<std::string> remarks;
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    if (data != display)
        remarks.push_back(
            fmt::format("the picture is the data window, ({}, {}) to ({}, {}); the display window, ({}, {}) "
                        "to ({}, {}), has no effect",
                        data.min.x, data.min.y, data.max.x, data.max.y, display.min.x, display.min.y, display.max.x,
                        display.max.y));
    if (header.pixelAspectRatio() != 1.0f)
        remarks.push_back(fmt::format("\"pixelAspectRatio\" {} has no effect", header.pixelAspectRatio()));
    return remarks;
}

Image readPart(Imf::MultiPartInputFile& input) {
    const Imf::Header& header = input.header(0);
    const Imath::Box2i window = header.dataWindow();
    Image image{.size = sizeOf(window),
                .channels = {},
                .attributes = readAttributes(header),
                .chromaticities = readChromaticities(header),
                .environmentLayout = readEnvironmentLayout(header),
                .remarks = remarksOn(header)};
    Imf::FrameBuffer target;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        std::vector<float>& values = image.channels[channel.name()];
        values.resize(std::size_t{image.size.x} * image.size.y);
        if (channel.channel().type == Imf::UINT) image.integerChannels.insert(channel.name());
        target.insert(channel.name(),
                      Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float), sizeof(float) * image.size.x));
    }
    Imf::InputPart part(input, 0);
    part.setFrameBuffer(target);
    part.readPixels(window.min.y, window.max.y);
    return image;
}

}  // namespace

Image readExr(const std::filesystem::path& file, unsigned maxSide) {
    readableFileSize(file);
    const SourceLocation where{file.string()};
    try {
        Imf::MultiPartInputFile input(file.c_str());
        requireFlatSinglePart(input, where);
        if (const glm::uvec2 size = sizeOf(input.header(0).dataWindow()); size.x > maxSide || size.y > maxSide)
            throw InputError(
                where, fmt::format("a bitmap may have at most {} texels a side; got {} x {}", maxSide, size.x, size.y));
        requireReadableChannels(input.header(0), where);
        return readPart(input);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(where,
                         fmt::format("must be an undamaged EXR file, compressed in a way that OpenEXR {}.{} knows; {}",
                                     OPENEXR_VERSION_MAJOR, OPENEXR_VERSION_MINOR, error.what()));
    }
}

}  // namespace parhelion
