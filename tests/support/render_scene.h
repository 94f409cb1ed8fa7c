#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/film.h"
#include "compile/compile_scene.h"
#include "compile/render_settings.h"

namespace parhelion::test {

/// The folder scenes/ of the project, and the scene files in it, sorted.
std::filesystem::path sceneFolder();
std::vector<std::filesystem::path> sceneFiles();

/// The film of the scenes that tests write; a camera at `origin` looks at the world's origin.
struct SceneFrame {
    std::string origin = "0, 0.5, 5";
    std::string integrator = R"(<integrator type="volpath"><integer name="rr_depth" value="6"/></integrator>)";
    std::string filter = "box";
};

/// A Mitsuba scene of the given media, shapes and emitters.
std::string sceneXml(const std::string& body, const SceneFrame& frame = {});

/// Reads and compiles a scene, for a film of `size` pixels.
CompiledScene compileFile(const std::filesystem::path& file, glm::uvec2 size,
                          const std::map<std::string, std::string>& defines = {}, CompileOptions options = {});
CompiledScene compileText(const std::string& text, glm::uvec2 size, CompileOptions options = {});

/// What to render of a scene: its own effects, default quality, one camera ray a pixel for the features.
RenderSettings settingsFor(const CompiledScene& scene, std::uint64_t samples, std::uint32_t seed = 0);

/// Renders on testDevice().
Film renderVulkan(const CompiledScene& scene, const RenderSettings& settings);

/// Sum of a pixel's samples, and of their squares.
glm::dvec3 sampleSum(const shared::FilmPixel& pixel);
glm::dvec3 squareSum(const shared::FilmPixel& pixel);

/// Pixels, or feature pixels, that are not the same to the bit; all of them when the sizes differ.
std::size_t countDifferentPixels(const Film& a, const Film& b);
std::size_t countDifferentFeatures(const Film& a, const Film& b);

}  // namespace parhelion::test
