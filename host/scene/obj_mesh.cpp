#include "scene/obj_mesh.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <array>
#include <map>
#include <sstream>

#include "base/files.h"
#include "scene/obj_text.h"
#include "scene/vertex_normals.h"

namespace parhelion {
namespace {

/// What tinyobjloader hands over line by line; indices counted from 0, -1 where there is none.
struct ObjLines {
    using Corner = std::array<int, 3>;  ///< position, texture coordinate, normal
    std::vector<glm::dvec3> positions, normals;
    std::vector<glm::dvec2> uvs;
    std::vector<std::vector<Corner>> faces;

    static int fromOne(int index, std::size_t count) { return index < 0 ? static_cast<int>(count) + index : index - 1; }

    void addFace(const tinyobj::index_t* indices, int count) {
        std::vector<Corner>& face = faces.emplace_back();
        for (int i = 0; i < count; ++i)
            face.push_back({fromOne(indices[i].vertex_index, positions.size()),
                            fromOne(indices[i].texcoord_index, uvs.size()),
                            fromOne(indices[i].normal_index, normals.size())});
    }
};

ObjLines parseLines(const std::string& geometry, const std::string& file) {
    tinyobj::callback_t callback;
    callback.vertex_cb = [](void* lines, float x, float y, float z, float) {
        static_cast<ObjLines*>(lines)->positions.emplace_back(x, y, z);
    };
    callback.normal_cb = [](void* lines, float x, float y, float z) {
        static_cast<ObjLines*>(lines)->normals.emplace_back(x, y, z);
    };
    callback.texcoord_cb = [](void* lines, float u, float v, float) {
        static_cast<ObjLines*>(lines)->uvs.emplace_back(u, v);
    };
    callback.index_cb = [](void* lines, tinyobj::index_t* indices, int count) {
        static_cast<ObjLines*>(lines)->addFace(indices, count);
    };
    ObjLines lines;
    std::istringstream stream(geometry);
    std::string warning, error;
    if (!tinyobj::LoadObjWithCallback(stream, callback, &lines, nullptr, &warning, &error) || !error.empty())
        throw InputError(SourceLocation{file}, fmt::format("malformed OBJ: {}", error));
    return lines;
}

/// Twice the vector area of a triangle.
glm::dvec3 areaVector(const std::vector<glm::dvec3>& p, const ObjLines::Corner& a, const ObjLines::Corner& b,
                      const ObjLines::Corner& c) {
    const auto at = [&p](const ObjLines::Corner& corner) { return p[static_cast<std::size_t>(corner[0])]; };
    return glm::cross(at(b) - at(a), at(c) - at(a));
}

/// A fan covers a polygon only if none of its triangles turns backwards.
void checkFan(const std::vector<glm::dvec3>& positions, const std::vector<ObjLines::Corner>& face,
              const SourceLocation& where) {
    glm::dvec3 whole(0.0);
    for (std::size_t i = 2; i < face.size(); ++i) whole += areaVector(positions, face[0], face[i - 1], face[i]);
    constexpr double kRounding = 1e-5;  // single precision corners on one line may turn back by this much
    for (std::size_t i = 2; i < face.size(); ++i)
        if (glm::dot(areaVector(positions, face[0], face[i - 1], face[i]), whole) < -kRounding * glm::dot(whole, whole))
            throw InputError(where,
                             fmt::format("this polygon of {} corners is concave: a fan about its first corner does "
                                         "not cover it; triangulate it",
                                         face.size()));
}

/// Joins corners into vertices.
class MeshBuilder {
public:
    MeshBuilder(const ObjLines& lines, const ObjOptions& options) : lines_(lines), options_(options) {}

    Mesh build(const ObjText& text) {
        const bool keepNormals = hasNormals(text);
        for (std::size_t i = 0; i < lines_.faces.size(); ++i) {
            const std::vector<ObjLines::Corner>& face = lines_.faces[i];
            if (face.size() > 3) checkFan(lines_.positions, face, text.whereOfFace(i));
            for (std::size_t corner = 2; corner < face.size(); ++corner)
                mesh_.triangles.push_back({vertex(face[0]), vertex(face[corner - 1]), vertex(face[corner])});
        }
        if (!everyCornerHas(1)) mesh_.uvs.clear();
        if (!keepNormals) mesh_.normals.clear();
        return std::move(mesh_);
    }

private:
    bool everyCornerHas(std::size_t kind) const {
        for (const auto& face : lines_.faces)
            for (const ObjLines::Corner& corner : face)
                if (corner[kind] < 0) return false;
        return true;
    }

    /// Whether the file's normals are to be used: all corners have one, or none has.
    bool hasNormals(const ObjText& text) const {
        if (options_.faceNormals || lines_.normals.empty()) return false;
        const bool first = lines_.faces[0][0][2] >= 0;
        for (std::size_t i = 0; i < lines_.faces.size(); ++i)
            for (const ObjLines::Corner& corner : lines_.faces[i]) {
                if ((corner[2] >= 0) != first)
                    throw InputError(text.whereOfFace(i),
                                     "either all corners of the file have a normal or none; set "
                                     "\"face_normals\" to ignore them");
                if (first && lines_.normals[static_cast<std::size_t>(corner[2])] == glm::dvec3(0.0))
                    throw InputError(text.whereOfFace(i), "a normal (vn) of this face has length zero");
            }
        return first;
    }

    unsigned vertex(const ObjLines::Corner& corner) {
        const auto [entry, added] = vertices_.try_emplace(corner, static_cast<unsigned>(mesh_.positions.size()));
        if (!added) return entry->second;
        const auto pick = [](const auto& values, int index) {
            return index < 0 ? typename std::decay_t<decltype(values)>::value_type(0.0)
                             : values[static_cast<std::size_t>(index)];
        };
        glm::dvec2 uv = pick(lines_.uvs, corner[1]);
        if (options_.flipTexCoords) uv.y = 1.0 - uv.y;
        mesh_.positions.push_back(pick(lines_.positions, corner[0]));
        mesh_.uvs.push_back(uv);
        mesh_.normals.push_back(corner[2] < 0 ? glm::dvec3(0.0) : glm::normalize(pick(lines_.normals, corner[2])));
        return entry->second;
    }

    const ObjLines& lines_;
    const ObjOptions& options_;
    std::map<ObjLines::Corner, unsigned> vertices_;
    Mesh mesh_;
};

void addSmoothNormals(Mesh& mesh, const glm::dmat4& toWorld, const std::string& file) {
    std::vector<glm::dvec3> world;
    for (const glm::dvec3& p : mesh.positions) world.emplace_back(toWorld * glm::dvec4(p, 1.0));
    std::size_t undefined = 0;
    auto normals = smoothNormals(world, mesh.triangles, undefined);
    if (!normals) {
        const glm::dvec3& p = mesh.positions[undefined];
        throw InputError(SourceLocation{file},
                         fmt::format("the normals of the faces around vertex ({}, {}, {}) cancel out; give normals in "
                                     "the file or set \"face_normals\"",
                                     p.x, p.y, p.z));
    }
    const glm::dmat3 fromWorld = glm::transpose(glm::dmat3(toWorld));
    for (glm::dvec3& normal : *normals) normal = glm::normalize(fromWorld * normal);
    mesh.normals = std::move(*normals);
}

}  // namespace

Mesh readObjMesh(const std::filesystem::path& file, const SourceLocation& where, const ObjOptions& options) {
    const ObjText text = checkObjText(readTextFile(file, where), file.string());
    const ObjLines lines = parseLines(text.geometry, file.string());
    Mesh mesh = MeshBuilder(lines, options).build(text);
    mesh.notes = text.notes;
    if (mesh.normals.empty() && options.smooth && !options.faceNormals)
        addSmoothNormals(mesh, options.toWorld, file.string());
    return mesh;
}

}  // namespace parhelion
