#include "scene/nori_scene.h"

#include "scene/nori_camera.h"
#include "scene/nori_emitters.h"
#include "scene/nori_integrator.h"
#include "scene/nori_media.h"
#include "scene/nori_meshes.h"
#include "scene/only_element.h"

namespace parhelion {
namespace {

void readObjects(ReadContext& context, const XmlElement& root) {
    OnlyElement integrator("integrator"), camera("camera"), sampler("sampler");
    context.scene.sampleCount = 1;  // Nori's default
    for (const XmlElement& element : root.children) {
        if (element.tag == "integrator")
            integrator.set(element);
        else if (element.tag == "camera")
            camera.set(element);
        else if (element.tag == "sampler")
            sampler.set(element), readNoriSampler(context, element);
        else if (element.tag == "emitter")
            readNoriEmitter(context, element);
        else if (element.tag == "medium")
            readNoriMediumInItsBounds(context, element);
        else
            readNoriMesh(context, element);
    }
    readNoriIntegrator(context, integrator.get(root));
    readNoriCamera(context, camera.get(root));
}

}  // namespace

SceneDescription readNoriScene(const std::filesystem::path& file, XmlElement root, const SceneReadOptions& options) {
    prepareNoriScene(root);
    if (!options.defines.empty())
        throw InputError(fmt::format("-D {}: a scene in Nori's dialect has no $names", options.defines.begin()->first));
    const SceneTree tree = SceneTree::ofNori(file, std::move(root));
    SceneDescription scene;
    scene.file = file;
    ReadContext context{tree, options, scene, {}, {}};
    readObjects(context, tree.root());
    scene.files = tree.files();
    return scene;
}

}  // namespace parhelion
