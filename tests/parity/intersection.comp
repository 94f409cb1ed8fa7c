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
        case 1u: probeOutput(0u, vec4(boxEntry(probeInput(2u).xyz, probeInput(3u).xyz, a.xyz, finiteInverse(b.xyz), a.w, b.w))); break;
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
        case 4u:
            // A ray (x: slack, c.x: what it leaves) that has met `c.y` near, at t = c.z; the surface it left: normal, inward.
            Ray from = newRay(a.xyz, b.xyz, kInfinity, floatBitsToUint(c.x), kNone, kNone, a.w);
            Hit near = Hit(c.z, floatBitsToUint(c.y), vec2(1.0 / 3.0), false, true);
            Surface met = surfaceAt(from, near);
            probeOutput(0u, vec4(isFlatPrimitive(near.primitive), 0.0, 0.0, 0.0));
            if (isFlatPrimitive(near.primitive))
                probeOutput(0u, vec4(1.0, leavesAside(from, near, met, Start(probeInput(3u).xyz, vec3(0.0, 0.0, probeInput(3u).w), probeInput(4u).xyz)), 0.0, 0.0));
            break;
        case 5u:
            // The ray's memory, then a boundary of shape 0 crossed at c.z towards its inside or out.
            ray.idle = floatBitsToUint(a.x);
            ray.idleT = a.y;
            ray.passed = floatBitsToUint(a.z);
            Hit crossed = Hit(c.z, floatBitsToUint(b.w), vec2(0.0), false, false);
            ray.direction = vec3(0.0, 0.0, 1.0);
            crossBoundary(ray, crossed, floatBitsToUint(b.x), floatBitsToUint(b.y), vec3(0.0, 0.0, c.w));
            probeOutput(0u, vec4(uintBitsToFloat(ray.inside), uintBitsToFloat(ray.idle), ray.idleT, uintBitsToFloat(ray.passed)));
            probeOutput(1u, vec4(ray.tMin));
            break;
    }
}
