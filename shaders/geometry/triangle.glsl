// Watertight ray-triangle intersection.
#ifndef GEOMETRY_TRIANGLE_GLSL
#define GEOMETRY_TRIANGLE_GLSL

// The shear that turns a direction into +z along its largest axis; one a ray.
struct RayShear {
    ivec3 axes;  // x, y and z of the sheared space
    vec3 shear;  // s.x = d.x / d.z, s.y = d.y / d.z, s.z = 1 / d.z
};

// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".
RayShear rayShear(vec3 d) {
    vec3 a = abs(d);
    int z = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
    int x = z == 2 ? 0 : z + 1;
    int y = x == 2 ? 0 : x + 1;
    if (d[z] < 0.0) {
        int swap = x;
        x = y;
        y = swap;
    }
    return RayShear(ivec3(x, y, z), vec3(d[x] / d[z], d[y] / d[z], 1.0 / d[z]));
}

// Bound of the error of t where no coordinate of the vertices, sheared and seen from the origin, is above that of `size`,
// no edge function above `largest`, and the origin itself is uncertain by `slack` (PBR4 6.8.7; infinite where the sum of
// the edge functions may be 0).
float distanceError(vec3 size, float largest, float determinant, float scaleZ, float slack) {
    const float e = 5.9604645e-8;  // 2^-24
    vec2 lateral = 5.0 * e * (size.xy + size.z) + 2.0 * slack;
    float edge = 2.0 * (2.0 * e * size.x * size.y + lateral.y * size.x + lateral.x * size.y);
    float least = max(abs(determinant) - 3.0 * edge, 0.0);
    return 3.0 * (size.z * edge + largest * (6.0 * e * size.z + slack)) * abs(scaleZ) / least;
}

// (t, b1, b2, error of t) of the hit, barycentrics of the second and third vertex; t < 0 without error where there is
// none. Both sides count. Edges belong to both of their triangles: no ray slips between them (H47).
vec4 intersectTriangle(vec3 origin, RayShear s, vec3 v0, vec3 v1, vec3 v2, float slack) {
    vec3 a = v0 - origin, b = v1 - origin, c = v2 - origin;
    float ax = a[s.axes.x] - s.shear.x * a[s.axes.z], ay = a[s.axes.y] - s.shear.y * a[s.axes.z];
    float bx = b[s.axes.x] - s.shear.x * b[s.axes.z], by = b[s.axes.y] - s.shear.y * b[s.axes.z];
    float cx = c[s.axes.x] - s.shear.x * c[s.axes.z], cy = c[s.axes.y] - s.shear.y * c[s.axes.z];
    precise float u = cx * by - cy * bx;
    precise float v = ax * cy - ay * cx;
    precise float w = bx * ay - by * ax;
    bool outside = min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0;
    float determinant = u + v + w;
    float t = s.shear.z * (u * a[s.axes.z] + v * b[s.axes.z] + w * c[s.axes.z]) / determinant;
    vec3 size = max(abs(vec3(ax, ay, a[s.axes.z])), max(abs(vec3(bx, by, b[s.axes.z])), abs(vec3(cx, cy, c[s.axes.z]))));
    float error = distanceError(size, max(abs(u), max(abs(v), abs(w))), determinant, s.shear.z, slack);
    return outside || determinant == 0.0 ? vec4(-1.0, -1.0, -1.0, 0.0) : vec4(t, v / determinant, w / determinant, error);
}

#endif
