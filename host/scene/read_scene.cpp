#include <algorithm>

#include "scene/attribute_values.h"
#include "scene/nori_scene.h"
#include "scene/only_element.h"
#include "scene/read_bsdf.h"
#include "scene/read_emitters.h"
#include "scene/read_integrator.h"
#include "scene/read_media.h"
#include "scene/read_phase.h"
#include "scene/read_sensor.h"
#include "scene/read_shapes.h"
#include "scene/read_textures.h"
#include "scene/read_volumes.h"
#include "scene/scene_description.h"
#include "scene/scene_grammar.h"
#include "scene/scene_tree.h"
#include "scene/suggestions.h"

namespace parhelion {
namespace {

[[noreturn]] void rejectAtSceneLevel(const XmlElement& element) {
    throw InputError(element.where,
                     fmt::format("<{}> must be nested: film and sampler in <sensor>, rfilter in <film>", element.tag));
}

/// Checks the media that only emitters name.
void checkNamedMedia(ReadContext& context, const std::vector<const XmlElement*>& elements) {
    std::set<const XmlElement*> checked(elements.begin(), elements.end());
    for (const XmlElement* medium : context.namedMedia)
        if (!context.mediumIndices.contains(medium) && checked.insert(medium).second) readMedium(context, *medium);
}

/// Reads the objects at scene level that have no effect by themselves. What shapes refer to is read there; the rest is
/// checked all the same, so that no mistake goes unnoticed. Media come before volumes, which they refer to, and
/// surfaces before textures.
void checkSharedObjects(ReadContext& context, const std::vector<const XmlElement*>& elements) {
    for (const XmlElement* element : elements) {
        if (element->tag == "bsdf") {
            readBsdf(context, *element);
        } else if (element->tag == "phase") {
            readPhase(context, *element);
        } else if (element->tag == "medium") {
            if (context.mediumIndices.contains(element)) continue;
            readMedium(context, *element);
            context.note(element->where, "the medium is used by no shape");
        } else if (element->tag != "volume" && element->tag != "texture") {
            rejectAtSceneLevel(*element);
        }
    }
    checkNamedMedia(context, elements);
    for (const XmlElement* element : elements) {
        if (element->tag == "texture" && !context.textureIndices.contains(element)) {
            textureIndex(context, *element);
            context.note(element->where, "the texture is used by nothing");
        }
        if (element->tag == "volume" && !context.volumesRead.contains(element))
            context.note(element->where, "the volume is used by no medium, and was not read");
    }
}

/// Accepts what the scene itself says on how Mitsuba intersects rays with it.
void readSceneProperty(ReadContext& context, const XmlElement& element) {
    const std::vector<std::string> known{"embree_use_robust_intersections", "allow_thread_reordering"};
    const XmlAttribute& name = element.require("name");
    if (std::ranges::find(known, name.value) == known.end())
        throw InputError(element.where,
                         fmt::format("the scene has no property \"{}\"{}", name.value, suggest(name.value, known)));
    parseBoolean(element.require("value"));
    context.note(element.where, fmt::format("\"{}\" has no effect", name.value));
}

void readObjects(ReadContext& context, const XmlElement& root) {
    OnlyElement integrator("integrator"), sensor("sensor");
    std::vector<const XmlElement*> shared;
    for (const XmlElement& element : root.children) {
        if (element.tag == "integrator")
            integrator.set(element);
        else if (element.tag == "sensor")
            sensor.set(element);
        else if (element.tag == "emitter")
            readEmitter(context, element);
        else if (element.tag == "shape")
            readShape(context, element);
        else if (isPropertyTag(element.tag))
            readSceneProperty(context, element);
        else
            shared.push_back(&element);
    }
    checkSharedObjects(context, shared);
    readIntegrator(context, integrator.get(root));
    readSensor(context, sensor.get(root));
}

}  // namespace

SceneDescription readScene(const std::filesystem::path& file, const SceneReadOptions& options) {
    XmlElement source = readXml(file);
    if (isNoriScene(source)) return readNoriScene(file, std::move(source), options);
    const SceneTree tree = SceneTree::load(file, std::move(source), options.defines);
    SceneDescription scene;
    scene.file = file;
    ReadContext context{tree, options, scene, {}, {}};
    readObjects(context, tree.root());
    scene.files = tree.files();
    return scene;
}

}  // namespace parhelion
