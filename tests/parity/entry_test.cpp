#include <gtest/gtest.h>

#include "reference/geometry/intersection.h"
#include "support/hand_scene.h"
#include "support/parity_report.h"
#include "support/scene_probe.h"
#include "support/stress.h"

// shaders/geometry/intersection.glsl, noticeEntry, against double precision.
namespace parhelion {
namespace {

using shared::kNone;
using test::Parity;
using test::Stress;

// From within a null mesh and from outside; from a surface, a medium and a boundary.
TEST(EntryParity, MeshesEnteredUnnoticedAreTheSame) {
    test::HandScene mesh;
    mesh.addTriangles(test::icosphere(1), mesh.addNull(mesh.addHomogeneous(1, glm::vec3(1))));
    mesh.scene.constants.shapes[0] = mesh.scene.shapes[0];
    const reference::SceneView<double> view(mesh.scene);
    Stress stress(40);
    std::vector<glm::vec4> inputs;
    for (unsigned i = 0; i < 4'000; ++i) {
        inputs.emplace_back(stress.point(1.5f), i % 5 == 0 ? 0.01f : 0.0f);
        inputs.emplace_back(stress.direction(), 0);
        inputs.push_back(glm::uintBitsToFloat(glm::uvec4(i % 3 == 0 ? kNone : 700, i % 7 == 0 ? 0 : kNone, 0, 0)));
    }
    Parity parity("geometry/intersection", "noticeEntry", 0);
    const auto outputs = test::SceneProbe(mesh.scene).run("parity/entry.comp", 0, inputs, 3, 1);
    unsigned noticed = 0;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const glm::uvec4 ids = glm::floatBitsToUint(inputs[3 * i + 2]), words = glm::floatBitsToUint(outputs[i]);
        reference::Ray<double> ray;
        ray.origin = inputs[3 * i];
        ray.tMin = inputs[3 * i].w;
        ray.direction = inputs[3 * i + 1];
        ray.last = ids.x;
        ray.inside = ids.y;
        const auto hit = reference::closestHit(view, ray);
        if (hit.primitive != words.x) continue;  // past an edge, within rounding
        reference::noticeEntry(view, hit, ray);
        EXPECT_TRUE(parity.equal(words.y, ray.inside)) << i;
        noticed += ray.inside != ids.y;
    }
    EXPECT_GT(noticed, 100u) << "nothing was tested";
}

}  // namespace
}  // namespace parhelion
