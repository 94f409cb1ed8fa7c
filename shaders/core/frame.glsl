// Orthonormal frames about a unit vector.
#ifndef CORE_FRAME_GLSL
#define CORE_FRAME_GLSL

struct Frame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited": orthonormal to 5e-7 for every unit
// normal, -z included.
Frame frameFromNormal(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return Frame(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

vec3 toWorld(Frame f, vec3 v) { return f.tangent * v.x + f.bitangent * v.y + f.normal * v.z; }

#endif
