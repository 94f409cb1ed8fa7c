// The documented properties of the Mitsuba 3.9.1 plugins that are read here: each is honoured, or noted to no effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "base/files.h"
#include "support/bad_text.h"
#include "volume/volume_file.h"

namespace parhelion::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string emitterOf(const std::string& type, const std::string& content) {
    return sceneOf("<emitter type=\"" + type + "\">" + content + "</emitter>");
}

std::string shapeOf(const std::string& type, const std::string& content) {
    return sceneOf("<shape type=\"" + type + "\">" + content + "</shape>");
}

std::string momentOf(const std::string& content) {
    return sceneOf("", "<integrator type=\"moment\">" + content + kIntegrator + "</integrator>" + kSensor);
}

/// A volume of 1 x 1 x 1 voxels of one half.
std::string smallVolume() {
    const TemporaryFolder folder;
    Volume volume;
    const float value = 0.5f;
    volume.density = DensityGrid::fromDense({1, 1, 1}, {&value, 1});
    writeVolume(folder.path() / "v.vol", volume);
    return readTextFile(folder.path() / "v.vol");
}

std::string floating(const std::string& name, const std::string& value) {
    return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
}
std::string integer(const std::string& name, const std::string& value) {
    return "<integer name=\"" + name + "\" value=\"" + value + "\"/>";
}
std::string boolean(const std::string& name, const std::string& value) {
    return "<boolean name=\"" + name + "\" value=\"" + value + "\"/>";
}
std::string text(const std::string& name, const std::string& value) {
    return "<string name=\"" + name + "\" value=\"" + value + "\"/>";
}

const std::string kMove = "<transform name=\"to_world\"><translate x=\"1\"/></transform>";
const std::string kSpin = "<transform name=\"to_world\"><rotate y=\"1\" angle=\"20\"/></transform>";
const std::string kDivision = integer("samples_per_pass", "1") + integer("block_size", "8") + floating("timeout", "5");

/// Scenes that give every documented property of one plugin.
struct Plugin {
    std::string name;
    std::string scene;

    friend void PrintTo(const Plugin& plugin, std::ostream* stream) { *stream << plugin.name; }
};

std::vector<Plugin> camerasAndFilms() {
    const std::string clipping = floating("near_clip", "1") + floating("far_clip", "9") + kMove +
                                 floating("focus_distance", "4") + floating("shutter_open", "0.25") +
                                 floating("shutter_close", "0.5") + floating("principal_point_offset_x", "0.1") +
                                 floating("principal_point_offset_y", "-0.1");
    const std::string filmText =
        integer("width", "8") + integer("height", "6") + integer("crop_offset_x", "1") + integer("crop_offset_y", "2") +
        integer("crop_width", "3") + integer("crop_height", "4") + text("file_format", "rgbe") +
        text("pixel_format", "xyza") + text("component_format", "uint32") + boolean("sample_border", "true") +
        boolean("compensate", "true") + boolean("banner", "false");
    std::vector<Plugin> plugins{
        {"PerspectiveByFov", cameraOf(clipping + floating("fov", "40") + text("fov_axis", "diagonal"))},
        {"PerspectiveByLens", cameraOf(clipping + text("focal_length", "35mm"))},
        {"FilmWithBox", filmOf(filmText + "<rfilter type=\"box\"/>")},
        {"FilmWithTent", filmOf(filmText + "<rfilter type=\"tent\">" + floating("radius", "2") + "</rfilter>")},
        {"FilmWithGaussian",
         filmOf(filmText + "<rfilter type=\"gaussian\">" + floating("stddev", "1") + "</rfilter>")}};
    for (const std::string& type :
         std::vector<std::string>{"independent", "stratified", "multijitter", "orthogonal", "ldsampler"}) {
        std::string content = integer("sample_count", "16") + integer("seed", "3");
        if (type != "independent" && type != "ldsampler") content += boolean("jitter", "false");
        if (type == "orthogonal") content += integer("strength", "3");
        plugins.push_back({"Sampler_" + type, cameraOf("<sampler type=\"" + type + "\">" + content + "</sampler>")});
    }
    return plugins;
}

std::vector<Plugin> integrators() {
    std::vector<Plugin> plugins{{"Moment", momentOf(kDivision + boolean("hide_emitters", "true"))}};
    for (const std::string& type : std::vector<std::string>{"path", "volpath", "volpathmis", "direct"}) {
        std::string content = kDivision + boolean("hide_emitters", "false");
        content += type == "direct" ? integer("emitter_samples", "2") + integer("bsdf_samples", "3")
                                    : integer("max_depth", "7") + integer("rr_depth", "3");
        if (type == "volpathmis") content += boolean("use_spectral_mis", "false");
        plugins.push_back({"Integrator_" + type,
                           sceneOf("", "<integrator type=\"" + type + "\">" + content + "</integrator>" + kSensor)});
    }
    return plugins;
}

std::vector<Plugin> emittersAndShapes() {
    const std::string weight = floating("sampling_weight", "2");
    const std::string every = kMove + boolean("flip_normals", "true") + floating("silhouette_sampling_weight", "0");
    const std::string flat = every + boolean("face_normals", "true");
    const std::string light =
        "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1, 2, 3\"/>" + weight + "</emitter>";
    return {{"Constant", emitterOf("constant", "<rgb name=\"radiance\" value=\"1\"/>" + kSpin + weight)},
            {"Envmap", emitterOf("envmap", text("filename", "map.hdr") + floating("scale", "2") + kSpin +
                                               boolean("mis_compensation", "true") + weight)},
            {"Directional", emitterOf("directional",
                                      "<rgb name=\"irradiance\" value=\"1\"/><vector name=\"direction\" "
                                      "x=\"1\" y=\"0\" z=\"0\"/>" +
                                          weight)},
            {"DirectionalTurned", emitterOf("directional", kSpin)},
            {"Point", emitterOf("point", "<rgb name=\"intensity\" value=\"1\"/><point name=\"position\" value=\"1\"/>" +
                                             weight)},
            {"PointMoved", emitterOf("point", kMove)},
            {"Rectangle", shapeOf("rectangle", flat + light)},
            {"Cube", shapeOf("cube", flat)},
            {"Sphere", shapeOf("sphere", every + "<point name=\"center\" value=\"1\"/>" + floating("radius", "2"))},
            {"Obj", shapeOf("obj", flat + text("filename", "m.obj") + boolean("flip_tex_coords", "false"))}};
}

std::vector<Plugin> surfacesAndMedia() {
    const std::string bitmap = "<texture type=\"bitmap\" name=\"reflectance\">" + text("filename", "map.hdr") +
                               text("filter_type", "nearest") + text("wrap_mode", "mirror") + boolean("raw", "true") +
                               boolean("accel", "false") + text("format", "fp16") +
                               "<transform name=\"to_uv\"><scale value=\"2\"/></transform></texture>";
    const std::string checkers =
        "<texture type=\"checkerboard\" name=\"reflectance\"><rgb name=\"color0\" value=\"0.1\"/><rgb name=\"color1\" "
        "value=\"0.2\"/><transform name=\"to_uv\"><scale value=\"2\"/></transform></texture>";
    const std::string both = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.25\"/></bsdf>";
    const std::string steering =
        floating("scale", "2") + boolean("sample_emitters", "false") + boolean("has_spectral_extinction", "false");
    const std::string grid = "<volume name=\"sigma_t\" type=\"gridvolume\">" + text("filename", "v.vol") +
                             text("filter_type", "trilinear") + text("wrap_mode", "mirror") + boolean("raw", "true") +
                             boolean("accel", "false") + boolean("use_grid_bbox", "false") + kMove +
                             floating("max_value", "3") + "</volume>";
    const std::string constant =
        "<volume name=\"albedo\" type=\"constvolume\"><rgb name=\"value\" value=\"0.1, 0.2, 0.3\"/>" + kMove +
        "</volume>";
    return {{"Bitmap", diffuseOf(bitmap)},
            {"Checkerboard", diffuseOf(checkers)},
            {"TwoSided",
             sphereOf("<bsdf type=\"twosided\">" + boolean("allow_transmission", "true") + both + both + "</bsdf>")},
            {"Homogeneous",
             mediumOf("<rgb name=\"sigma_t\" value=\"0.5\"/><rgb name=\"albedo\" value=\"0.5\"/>" + steering)},
            {"Heterogeneous", mediumOf(grid + constant + steering, "heterogeneous")},
            {"HenyeyGreenstein", mediumOf("<phase type=\"hg\">" + floating("g", "0.5") + "</phase>")},
            {"Tabulated", mediumOf("<phase type=\"tabphase\">" + text("values", "1, 2, 3") + "</phase>")},
            {"Blend", mediumOf("<phase type=\"blendphase\"><phase type=\"hg\"/><phase type=\"isotropic\"/>" +
                               floating("weight", "0.25") + "</phase>")},
            {"Scene", sceneOf(boolean("embree_use_robust_intersections", "true") +
                              boolean("allow_thread_reordering", "false"))}};
}

std::vector<Plugin> allPlugins() {
    std::vector<Plugin> all;
    for (const auto& some : {camerasAndFilms(), integrators(), emittersAndShapes(), surfacesAndMedia()})
        all.insert(all.end(), some.begin(), some.end());
    return all;
}

const std::map<std::string, std::string> kFiles{
    {"m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    {"map.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80")},
    {"v.vol", smallVolume()}};

class MitsubaProperties : public testing::TestWithParam<Plugin> {};

TEST_P(MitsubaProperties, AllThatAreDocumentedAreAccepted) {
    EXPECT_NO_THROW(readText(GetParam().scene, {}, kFiles)) << GetParam().scene;
}

INSTANTIATE_TEST_SUITE_P(Plugins, MitsubaProperties, testing::ValuesIn(allPlugins()),
                         [](const auto& info) { return info.param.name; });

/// A property and the scene that gives it, to no effect.
struct Idle {
    std::string name;
    std::string scene;

    friend void PrintTo(const Idle& idle, std::ostream* stream) { *stream << idle.name; }
};

class MitsubaIdleProperties : public testing::TestWithParam<Idle> {};

TEST_P(MitsubaIdleProperties, AreNotedWhereTheyStand) {
    const auto& [name, scene] = GetParam();
    const std::vector<std::string> notes = readText(scene, {}, kFiles).notes;
    EXPECT_THAT(notes,
                ElementsAre(AllOf(HasSubstr("\"" + name + "\""), HasSubstr("no effect"), HasSubstr("scene.xml:"))));
}

INSTANTIATE_TEST_SUITE_P(
    Properties, MitsubaIdleProperties,
    testing::Values(
        Idle{"focus_distance", cameraOf(floating("focus_distance", "1000"))},
        Idle{"near_clip", cameraOf(floating("near_clip", "2"))}, Idle{"far_clip", cameraOf(integer("far_clip", "2"))},
        Idle{"timeout", integratorOf(floating("timeout", "10"))},
        Idle{"block_size", momentOf(integer("block_size", "16"))},
        Idle{"hide_emitters", momentOf(boolean("hide_emitters", "true"))},
        Idle{"face_normals", shapeOf("cube", boolean("face_normals", "true"))},
        Idle{"silhouette_sampling_weight", shapeOf("sphere", floating("silhouette_sampling_weight", "2"))},
        Idle{"to_world", emitterOf("constant", kMove)},
        Idle{"allow_transmission", sphereOf("<bsdf type=\"twosided\">" + boolean("allow_transmission", "false") +
                                            "<bsdf type=\"diffuse\"/></bsdf>")},
        Idle{"wrap_mode", gridOf(text("filename", "v.vol") + text("wrap_mode", "mirror"))},
        Idle{"embree_use_robust_intersections", sceneOf(boolean("embree_use_robust_intersections", "true"))}),
    [](const auto& info) { return info.param.name; });

TEST(MitsubaPropertyNotes, NoneForATimeoutThatNeverComes) {
    EXPECT_THAT(readText(integratorOf(floating("timeout", "-1"))).notes, ElementsAre());
}

TEST(MitsubaPropertyValues, ConstantVolumeIsAWeight) {
    const auto weightOf = [](const std::string& weight) {  // of the second function
        const std::string blend = "<phase type=\"blendphase\"><phase type=\"hg\"/><phase type=\"isotropic\"/>";
        return 1.0 - readText(mediumOf(blend + weight + "</phase>")).media[0].phase.lobeWeight;
    };
    const std::string volume = "<volume name=\"weight\" type=\"constvolume\">", end = "</volume>";
    EXPECT_EQ(weightOf(floating("weight", "0.25")), 0.25);
    EXPECT_EQ(weightOf(volume + floating("value", "0.25") + end), 0.25);
    EXPECT_EQ(weightOf(volume + "<rgb name=\"value\" value=\"0.25\"/>" + end), 0.25);
    EXPECT_EQ(weightOf(volume + end), 1.0);
    EXPECT_THROW(weightOf(volume + "<rgb name=\"value\" value=\"0.25 0.5 0.5\"/>" + end), InputError);
}

TEST(MitsubaPropertyValues, OlderNameOfTheBorderIsRead) {
    EXPECT_TRUE(readText(filmOf(boolean("high_quality_edges", "true"))).film.samplesBorder);
    EXPECT_FALSE(readText(filmOf(boolean("high_quality_edges", "false"))).film.samplesBorder);
}

TEST(MitsubaPropertyValues, EqualSidesAreOneSurface) {
    const std::string side = "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.25\"/></bsdf>";
    const BsdfDescription bsdf =
        readText(sphereOf("<bsdf type=\"twosided\">" + side + side + "</bsdf>")).shapes[0].bsdf;
    EXPECT_TRUE(bsdf.twoSided);
    EXPECT_EQ(bsdf.reflectance, glm::dvec3(0.25));
}

/// The Cornell box that Mitsuba builds by itself, whose walls and boxes are `white` but for two.
std::string cornellBox(const std::string& white) {
    const auto wall = [](const std::string& type, const std::string& id, const std::string& transform,
                         const std::string& content = "") {
        return "<shape type=\"" + type + "\"><transform name=\"to_world\">" + transform + "</transform><ref id=\"" +
               id + "\"/>" + content + "</shape>\n";
    };
    return "<scene version=\"3.0.0\"><integrator type=\"path\">" + integer("max_depth", "8") + "</integrator>\n" +
           "<sensor type=\"perspective\"><string name=\"fov_axis\" value=\"smaller\"/>" +
           floating("near_clip", "0.001") + floating("far_clip", "100") + floating("focus_distance", "1000") +
           floating("fov", "39.3077") +
           "<transform name=\"to_world\"><lookat origin=\"0, 0, 3.9\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>" +
           "<sampler type=\"independent\">" + integer("sample_count", "64") + "</sampler><film type=\"hdrfilm\">" +
           integer("width", "256") + integer("height", "256") + "<rfilter type=\"gaussian\"/>" +
           text("pixel_format", "rgb") + text("component_format", "float32") + "</film></sensor>\n" + white +
           "<bsdf type=\"diffuse\" id=\"green\"><rgb name=\"reflectance\" value=\"0.105421, 0.37798, "
           "0.076425\"/></bsdf>" +
           "<bsdf type=\"diffuse\" id=\"red\"><rgb name=\"reflectance\" value=\"0.570068, 0.0430135, "
           "0.0443706\"/></bsdf>" +
           wall("rectangle", "white",
                "<scale x=\"0.23\" y=\"0.19\" z=\"0.19\"/><rotate x=\"1\" angle=\"90\"/><translate y=\"0.99\" "
                "z=\"0.01\"/>",
                "<emitter type=\"area\"><rgb name=\"radiance\" value=\"18.387, 13.9873, 6.75357\"/></emitter>") +
           wall("rectangle", "white", "<rotate x=\"1\" angle=\"-90\"/><translate y=\"-1\"/>") +
           wall("rectangle", "white", "<rotate x=\"1\" angle=\"90\"/><translate y=\"1\"/>") +
           wall("rectangle", "white", "<translate z=\"-1\"/>") +
           wall("rectangle", "green", "<rotate y=\"1\" angle=\"-90\"/><translate x=\"1\"/>") +
           wall("rectangle", "red", "<rotate y=\"1\" angle=\"90\"/><translate x=\"-1\"/>") +
           wall("cube", "white",
                "<scale value=\"0.3\"/><rotate y=\"1\" angle=\"-17\"/><translate x=\"0.335\" y=\"-0.7\" z=\"0.38\"/>") +
           wall("cube", "white",
                "<scale x=\"0.3\" y=\"0.61\" z=\"0.3\"/><rotate y=\"1\" angle=\"18.25\"/><translate x=\"-0.33\" "
                "y=\"-0.4\" "
                "z=\"-0.28\"/>") +
           "</scene>\n";
}

TEST(MitsubaCornellBox, LoadsWithNotesOnItsCameraAlone) {
    const SceneDescription scene = readText(cornellBox(
        "<bsdf type=\"diffuse\" id=\"white\"><rgb name=\"reflectance\" value=\"0.885809, 0.698859, 0.666422\"/>"
        "</bsdf>"));
    EXPECT_EQ(scene.shapes.size(), 8u);
    EXPECT_EQ(scene.integrator.maxDepth, 8);
    EXPECT_THAT(scene.notes, ElementsAre(HasSubstr("near_clip"), HasSubstr("far_clip"), HasSubstr("focus_distance")));
}

TEST(MitsubaCornellBox, SurfaceThatIsNotSupportedIsNamedAtItsPlace) {
    expectRefused(
        {"", cornellBox("<bsdf id=\"white\" type=\"@@dielectric\"/>"), {"dielectric", "diffuse, null, twosided"}});
}

}  // namespace
}  // namespace parhelion::test
