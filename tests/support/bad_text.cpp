#include "support/bad_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace parhelion::test {
namespace {

/// Takes the mark out of a text; returns "line:column" of where it was, or nothing.
std::string takeMark(std::string& text) {
    const std::size_t mark = text.find("@@");
    if (mark == std::string::npos) return {};
    text.erase(mark, 2);
    const std::string_view before = std::string_view(text).substr(0, mark);
    const std::size_t lineStart = before.rfind('\n') + 1;  // npos + 1 is 0: the first line
    return fmt::format("{}:{}", 1 + std::count(before.begin(), before.end(), '\n'), mark - lineStart + 1);
}

}  // namespace

void expectRefused(BadText bad) {
    const TemporaryFolder folder;
    const auto placeIn = [&folder](const std::string& name, std::string& text) {
        const std::string mark = takeMark(text);
        return mark.empty() ? "" : fmt::format("{}:{}: ", (folder.path() / name).string(), mark);
    };
    std::string place = placeIn("scene.xml", bad.text);
    for (auto& [name, content] : bad.files) {
        place += placeIn(name, content);
        folder.write(name, content);
    }
    if (place.empty()) place = (folder.path() / bad.files.begin()->first).string() + ": ";
    try {
        readScene(folder.write("scene.xml", bad.text));
        FAIL() << "accepted:\n" << bad.text;
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.substr(0, place.size()), place) << message;
        for (const std::string& mention : bad.mentions) EXPECT_NE(message.find(mention), std::string::npos) << message;
    }
}

std::string sphereOf(const std::string& content) { return sceneOf("<shape type=\"sphere\">\n" + content + "</shape>"); }

std::string diffuseOf(const std::string& content) { return sphereOf("<bsdf type=\"diffuse\">" + content + "</bsdf>"); }

std::string mediumOf(const std::string& content, const std::string& type) {
    return sphereOf("<bsdf type=\"null\"/><medium name=\"interior\" type=\"" + type + "\">" + content + "</medium>");
}

std::string gridOf(const std::string& content) {
    return mediumOf("<volume name=\"sigma_t\" type=\"gridvolume\">" + content + "</volume>", "heterogeneous");
}

std::string cameraOf(const std::string& content) {
    return sceneOf("", kIntegrator + "\n<sensor type=\"perspective\">" + content + "</sensor>");
}

std::string filmOf(const std::string& content) { return cameraOf("<film type=\"hdrfilm\">" + content + "</film>"); }

std::string integratorOf(const std::string& content) {
    return sceneOf("", "<integrator type=\"path\">" + content + "</integrator>" + kSensor);
}

}  // namespace parhelion::test
