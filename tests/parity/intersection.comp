#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "../support/probe.glsl"
#include "geometry/intersection.glsl"

void probeItem() {
    loadScene();
    vec4 a = probeInput(0u), b = probeInput(1u), c = probeInput(2u);  // origin, tMin; direction, tMax; last, inside, target
    Ray ray = newRay(a.xyz, b.xyz, b.w, floatBitsToUint(c.x), floatBitsToUint(c.z), floatBitsToUint(c.y), -1.0);
    ray.tMin = a.w;
    bool ok = true;
    uint tests = 0u;
    switch (probeFunction) {
        case 0u:
            Hit hit = closestHit(ray, true, tests, ok);
            Surface surface = surfaceAt(ray, hit);
            if (hit.primitive != kNone)
                crossBoundary(ray, hit, surface.shape, shapeAt(surface.shape).exterior, surface.geometricNormal);
            probeOutput(0u, vec4(hit.t, uintBitsToFloat(hit.primitive), hit.uv));
            probeOutput(1u, vec4(surface.position, uintBitsToFloat(surface.shape)));
            probeOutput(2u, vec4(surface.geometricNormal, uintBitsToFloat(ray.inside)));
            probeOutput(3u, vec4(surface.shadingNormal, hit.exits));
            probeOutput(4u, vec4(surface.offset, 0.0, 0.0, ok));
            break;
        case 1u: probeOutput(0u, vec4(boxEntry(probeInput(2u).xyz, probeInput(3u).xyz, a.xyz - 0.25, a.xyz + 0.25, finiteInverse(b.xyz), a.w, b.w))); break;
        case 2u:
            probeOutput(0u, vec4(boxNormal(scene.boxes[0], a.xyz), 0.0));
            probeOutput(1u, vec4(boxSurface(scene.boxes[0], a.xyz).geometricNormal, 0.0));
            probeOutput(2u, vec4(sphereSurface(scene.spheres[0], a.xyz).geometricNormal, 0.0));
            break;
        case 3u:
            Shape shape = shapeAt(ray.last);
            probeOutput(0u, vec4(shape.reflectance, uintBitsToFloat(shape.flags)));
            probeOutput(1u, uintBitsToFloat(uvec4(shape.interior, shape.exterior, shape.light, interiorOf(ray.last))));
            probeOutput(2u, vec4(surrounds(ray.last, ray.inside)));
            break;
    }
}
