#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <limits>

#include "base/files.h"
#include "image/image.h"

namespace parhelion {

namespace {

void insertAttribute(Imf::Header& header, const std::string& name, const Image::Attribute& attribute) {
    if (const auto* text = std::get_if<std::string>(&attribute)) {
        header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* real = std::get_if<double>(&attribute)) {
        header.insert(name, Imf::DoubleAttribute(*real));
    } else {
        const std::int64_t integer = std::get<std::int64_t>(attribute);
        using Limits = std::numeric_limits<int>;
        if (integer >= Limits::min() && integer <= Limits::max())
            header.insert(name, Imf::IntAttribute(static_cast<int>(integer)));
        else
            header.insert(name, Imf::StringAttribute(std::to_string(integer)));
    }
}

void writePixels(const std::filesystem::path& file, const Image& image) {
    Imf::Header header(static_cast<int>(image.size.x), static_cast<int>(image.size.y));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer source;
    for (const auto& [name, values] : image.channels) {
        if (values.size() != std::size_t{image.size.x} * image.size.y)
            throw RuntimeFailure(fmt::format("channel '{}' must hold {} x {} values; got {}", name, image.size.x,
                                             image.size.y, values.size()));
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        source.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow(), sizeof(float),
                                             sizeof(float) * image.size.x));
    }
    for (const auto& [name, attribute] : image.attributes) insertAttribute(header, name, attribute);
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(source);
    output.writePixels(static_cast<int>(image.size.y));
}

}  // namespace

void writeExr(const std::filesystem::path& file, const Image& image) {
    AtomicFile output(file);
    try {
        writePixels(output.temporaryPath(), image);
    } catch (const std::exception& error) {
        throw RuntimeFailure(fmt::format("cannot write '{}': {}", file.string(), error.what()));
    }
    output.commit();
}

}  // namespace parhelion
