// A scene means the same in either dialect: what Nori's names compile to, Mitsuba's do as well.
#include <gtest/gtest.h>

#include "reference/reference_renderer.h"
#include "support/nori_text.h"
#include "support/paths.h"
#include "support/render_scene.h"

namespace parhelion::test {
namespace {

constexpr glm::uvec2 kSize{12, 10};

const std::string kGrid = test::projectFolder() + "/scenes/cumulus.grid";

std::string inNori() {
    return R"(<scene>
<integrator type="path_mis_vol"><integer name="maxDepth" value="6"/></integrator>
<camera type="perspective"><float name="fov" value="40"/><integer name="width" value="12"/>
    <integer name="height" value="10"/><rfilter type="tent"/>
    <transform name="toWorld"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></camera>
<mesh type="obj"><string name="filename" value="t.obj"/><bsdf type="diffuse"><color name="albedo" value="0.7 0.6 0.4"/></bsdf>
    <transform name="toWorld"><translate value="-0.3 -0.3 0"/><scale value="9 9 1"/><translate value="0 0 -1.2"/></transform></mesh>
<mesh type="sphere"><float name="radius" value="0.3"/><point name="center" value="0.4 1.3 0.6"/>
    <bsdf type="diffuse"><color name="albedo" value="0 0 0"/></bsdf>
    <emitter type="area"><color name="radiance" value="9 8 7"/></emitter></mesh>
<mesh type="sphere"><float name="radius" value="0.4"/><point name="center" value="1.6 -1 0"/>
    <medium type="homogeneous"><color name="sigma_t" value="4 2 1"/><float name="albedo" value="0.8"/></medium></mesh>
<emitter type="directional"><vector name="direction" value="-1 -1 -1"/><color name="radiance" value="1 2 3"/></emitter>
<medium type="heterogeneous"><string name="filename" value=")" +
           kGrid + R"("/>
    <point name="boundsMin" value="-1 -1 -1"/><point name="boundsMax" value="1 1 1"/>
    <color name="sigma_a" value="1.5 1.5 1.5"/><color name="sigma_s" value="10.5 10.5 10.5"/>
    <phase type="hg"><float name="g" value="0.6"/></phase></medium>
</scene>)";
}

std::string inMitsuba() {
    return R"(<scene version="3.0.0">
<integrator type="volpath"><integer name="max_depth" value="6"/></integrator>
<sensor type="perspective"><float name="fov" value="40"/><film type="hdrfilm"><integer name="width" value="12"/>
    <integer name="height" value="10"/><rfilter type="tent"/></film>
    <transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
<shape type="obj"><string name="filename" value="t.obj"/><boolean name="face_normals" value="true"/>
    <boolean name="flip_tex_coords" value="false"/>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.7 0.6 0.4"/></bsdf>
    <transform name="to_world"><translate x="-0.3" y="-0.3"/><scale x="9" y="9"/><translate z="-1.2"/></transform></shape>
<shape type="sphere"><float name="radius" value="0.3"/><point name="center" value="0.4 1.3 0.6"/>
    <emitter type="area"><rgb name="radiance" value="9 8 7"/><boolean name="two_sided" value="true"/></emitter></shape>
<shape type="sphere"><float name="radius" value="0.4"/><point name="center" value="1.6 -1 0"/><bsdf type="null"/>
    <medium name="interior" type="homogeneous"><rgb name="sigma_t" value="4 2 1"/><float name="albedo" value="0.8"/></medium></shape>
<emitter type="directional"><vector name="direction" value="-1 -1 -1"/><rgb name="irradiance" value="1 2 3"/></emitter>
<medium id="cloud" type="heterogeneous">
    <volume name="sigma_t" type="gridvolume"><string name="filename" value=")" +
           kGrid + R"("/><transform name="to_world"><translate value="-0.5"/><scale value="2"/></transform></volume>
    <float name="scale" value="12"/><float name="albedo" value="0.875"/>
    <phase type="hg"><float name="g" value="0.6"/></phase></medium>
<shape type="cube"><bsdf type="null"/><ref id="cloud" name="interior"/></shape>
</scene>)";
}

Film renderText(const std::string& text) {
    const CompiledScene scene = compileScene(readText(text, {}, {{"t.obj", kTriangleObj}}));
    RenderSettings settings;
    settings.sampleCount = 16;
    settings.featureSamples = 0;
    return reference::render<float>(scene, settings);
}

TEST(NoriDialect, RendersTheFilmOfTheSameSceneInMitsubas) {
    const Film nori = renderText(inNori()), mitsuba = renderText(inMitsuba());
    ASSERT_EQ(nori.pixels.size(), std::size_t(kSize.x * kSize.y));
    EXPECT_EQ(countDifferentPixels(nori, mitsuba), 0u);
    // A scene without its two-sided light differs: the comparison sees something.
    std::string dimmer = inNori();
    dimmer.replace(dimmer.find("9 8 7"), 5, "9 8 6");
    EXPECT_GT(countDifferentPixels(nori, renderText(dimmer)), 0u);
}

}  // namespace
}  // namespace parhelion::test
