#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <string>

#include "support/hand_scene.h"
#include "support/render_scene.h"
#include "support/temporary_folder.h"
#include "volume/volume_file.h"

// Pieces of scene files, for tests to put together.
namespace parhelion::test {

inline const std::string kFloor = R"(<shape type="rectangle">
    <transform name="to_world"><rotate x="1" angle="-90"/><scale value="4"/><translate y="-1"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.6, 0.4"/></bsdf>
</shape>)";
inline const std::string kSky = R"(<emitter type="constant"><rgb name="radiance" value="0.4, 0.5, 0.7"/></emitter>)";
inline const std::string kStars = R"(<float name="star_density" value="20"/><float name="star_size" value="3"/>
    <rgb name="star_radiance" value="20, 30, 40"/>)";
inline const std::string kSun = R"(<emitter type="directional"><vector name="direction" x="-0.6" y="-0.7" z="-0.3"/>
    <rgb name="irradiance" value="3, 2.7, 2.2"/></emitter>)";
inline const std::string kLamp = R"(<emitter type="point"><point name="position" x="1" y="1.6" z="1.5"/>
    <rgb name="intensity" value="4, 3, 2"/></emitter>)";
inline const std::string kQuadLight = R"(<shape type="rectangle">
    <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="90"/><translate x="0.3" y="1.7"/></transform>
    <emitter type="area"><rgb name="radiance" value="6, 5, 4"/></emitter>
</shape>)";
inline const std::string kSphereLight = R"(<shape type="sphere">
    <point name="center" x="-1.2" y="0.9" z="0.4"/><float name="radius" value="0.3"/>
    <emitter type="area"><rgb name="radiance" value="5, 6, 7"/></emitter>
</shape>)";

/// A tilted gradient with a kink above the horizon.
inline std::string gradientSky(const std::string& stars) {
    return R"(<emitter type="sky"><vector name="axis" x="0.2" y="1" z="0.3"/><float name="offset" value="-0.1"/>
    <float name="width" value="0.7"/><float name="power" value="1.5"/>
    <rgb name="bottom" value="0.7, 0.5, 0.3"/><rgb name="top" value="0.2, 0.4, 0.9"/>)" +
           stars + "</emitter>";
}
inline std::string environmentMap() {
    return "<emitter type=\"envmap\"><string name=\"filename\" value=\"" +
           (sceneFolder() / "environments/afternoon.hdr").string() +
           "\"/><transform name=\"to_world\"><rotate x=\"1\" z=\"0.4\" angle=\"70\"/></transform></emitter>";
}

/// Faces up, away from the floor.
inline const std::string kTwoSidedQuad = R"(<shape type="rectangle">
    <transform name="to_world"><scale value="0.5"/><rotate x="1" angle="-80"/><translate x="0.3" y="1.7"/></transform>
    <emitter type="area"><rgb name="radiance" value="6, 5, 4"/><boolean name="two_sided" value="true"/></emitter>
</shape>)";

/// A shape around a medium.
inline std::string around(const std::string& medium, const std::string& shape, const std::string& transform = "") {
    return fmt::format(R"(<shape type="{}"><transform name="to_world">{}</transform>
    <bsdf type="null"/><ref name="interior" id="{}"/></shape>)",
                       shape, transform, medium);
}

inline std::string homogeneous(const std::string& id, const std::string& sigma, double g) {
    return fmt::format(R"(<medium type="homogeneous" id="{}"><rgb name="sigma_t" value="{}"/>
    <rgb name="albedo" value="0.95, 0.9, 0.8"/><phase type="hg"><float name="g" value="{}"/></phase></medium>)",
                       id, sigma, g);
}

inline std::string fogScattering(const std::string& id, const std::string& phase) {
    return fmt::format(R"(<medium type="homogeneous" id="{}"><float name="sigma_t" value="2"/>
    <float name="albedo" value="0.95"/>{}</medium>)",
                       id, phase);
}

inline const std::string kTwoLobes =
    R"(<phase type="dual_hg"><float name="g1" value="0.85"/><float name="g2" value="-0.3"/>
    <float name="weight" value="0.7"/></phase>)";
inline const std::string kSmallParticles = R"(<phase type="rayleigh"/>)";
inline const std::string kPhaseTable =
    R"(<phase type="tabphase"><string name="values" value="2 0.5 0 0 1 1 4 20"/></phase>)";

/// The cumulus over [-1, 1]^3. The extinction of a grid is grey in the scene language; see makeChromatic.
inline std::string cloud(const std::string& id, const std::string& albedo, const std::string& phase) {
    return fmt::format(
        R"(<medium type="heterogeneous" id="{}"><float name="scale" value="12"/>
    <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>
    {}<phase type="{}"/></medium>)",
        id, (sceneFolder() / "cumulus.grid").string(), albedo, phase);
}

inline const std::string kWhite = R"(<rgb name="albedo" value="0.99, 0.98, 0.97"/>)";

/// A coloured albedo over [-1, 1]^3, different in each of 4 x 3 x 5 texels.
inline std::string albedoGrid(const TemporaryFolder& folder) {
    Volume volume;
    volume.channels = 3;
    volume.color.resolution = {4, 3, 5};
    for (int i = 0; i < 3 * 4 * 3 * 5; ++i) volume.color.values.push_back(0.5f + 0.5f * float(i * 37 % 60) / 60.0f);
    writeVolume(folder.path() / "albedo.vol", volume);
    return fmt::format(R"(<volume name="albedo" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>)",
                       (folder.path() / "albedo.vol").string());
}

/// The extinction of a coloured cloud over [-1, 1]^3, a value a channel in each of 11 x 9 x 7 voxels.
inline std::string colorCloud(const TemporaryFolder& folder) {
    Volume volume;
    volume.channels = 3;
    volume.color.resolution = {11, 9, 7};
    for (int i = 0; i < 3 * 11 * 9 * 7; ++i) volume.color.values.push_back(float(i * 37 % 101) / 100.0f);
    writeVolume(folder.path() / "color.vol", volume);
    return fmt::format(
        R"(<medium type="heterogeneous" id="cloud"><float name="scale" value="4"/>
    <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>
    <rgb name="albedo" value="0.99, 0.98, 0.97"/><phase type="hg"/></medium>)",
        (folder.path() / "color.vol").string());
}

/// A ball of 80 triangles of unit radius, with smooth vertex normals unless `flat`: their corners are shared.
inline std::string ball(const TemporaryFolder& folder, bool flat, const std::string& transform,
                        const std::string& content) {
    std::string text, faces;
    std::map<std::array<long, 3>, std::size_t> numbers;  // corners are the same if they agree to 1e-4
    const std::vector<glm::vec3> corners = icosphere(1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::vec3& v = corners[i];
        const auto [found, isNew] = numbers.try_emplace(
            {std::lround(1e4 * v.x), std::lround(1e4 * v.y), std::lround(1e4 * v.z)}, numbers.size() + 1);
        if (isNew) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
        faces += fmt::format("{} {}{}", i % 3 == 0 ? "f" : "", found->second, i % 3 == 2 ? "\n" : "");
    }
    text += faces;
    return fmt::format(R"(<shape type="obj"><string name="filename" value="{}"/>
    <boolean name="face_normals" value="{}"/><transform name="to_world">{}</transform>{}</shape>)",
                       folder.write("ball.obj", text).string(), flat, transform, content);
}

inline const std::string kTwoSided = R"(<bsdf type="twosided"><bsdf type="diffuse">
    <rgb name="reflectance" value="0.3, 0.6, 0.8"/></bsdf></bsdf>)";
inline const std::string kTwoSidedMesh =
    R"(<emitter type="area"><rgb name="radiance" value="7, 6, 5"/><boolean name="two_sided" value="true"/></emitter>)";
inline const std::string kMeshLight = R"(<emitter type="area"><rgb name="radiance" value="7, 6, 5"/></emitter>)";

}  // namespace parhelion::test
