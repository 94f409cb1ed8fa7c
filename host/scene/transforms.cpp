#include "scene/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/attribute_values.h"

namespace parhelion {
namespace {

bool isFinite(const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

glm::dmat4 readRotation(const XmlElement& step) {
    const glm::dvec3 axis = parseXyz(step, 0.0);
    if (axis == glm::dvec3(0.0)) throw InputError(step.where, "rotation axis must not be zero");
    return rotationMatrix(axis, parseNumber(step.require("angle")));
}

glm::dmat4 readLookAt(const XmlElement& step) {
    const glm::dvec3 origin = parseTriple(step.require("origin")), target = parseTriple(step.require("target"));
    const XmlAttribute* given = step.find("up");
    glm::dvec3 up = given && !given->value.empty() ? parseTriple(*given) : glm::dvec3(0.0);
    if (up == glm::dvec3(0.0)) up = anyUp(glm::normalize(target - origin));
    const glm::dmat4 matrix = lookAtMatrix(origin, target, up);
    if (!isFinite(matrix))
        throw InputError(step.where,
                         "lookat needs an origin and a target that differ, and an up that is not parallel "
                         "to their difference");
    return matrix;
}

glm::dmat4 readMatrix(const XmlAttribute& value) {
    const std::vector<double> numbers = parseNumbers(value);
    if (numbers.size() != 9 && numbers.size() != 16)
        throw InputError(value.where,
                         fmt::format("matrix must have 16 or 9 numbers, row by row; got {}", numbers.size()));
    const std::size_t size = numbers.size() == 9 ? 3 : 4;
    glm::dmat4 matrix(1.0);
    for (std::size_t row = 0; row < size; ++row)
        for (std::size_t column = 0; column < size; ++column)
            matrix[static_cast<int>(column)][static_cast<int>(row)] = numbers[row * size + column];
    const glm::dvec4 lastRow(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
    if (lastRow.x != 0 || lastRow.y != 0 || lastRow.z != 0 || lastRow.w == 0)
        throw InputError(value.where, "matrix must be affine: its last row 0 0 0 1");
    return matrix / lastRow.w;
}

glm::dmat4 readStep(const XmlElement& step) {
    const glm::dmat4 identity(1.0);
    if (step.tag == "translate") return glm::translate(identity, parseXyz(step, 0.0));
    if (step.tag == "scale") return glm::scale(identity, parseXyz(step, 1.0));
    if (step.tag == "rotate") return readRotation(step);
    if (step.tag == "lookat") return readLookAt(step);
    return readMatrix(step.require("value"));
}

void checkInvertible(const glm::dmat4& matrix, const SourceLocation& where) {
    // Volume of the image of the unit cube, relative to that of a box with the same edges: 1 for a rotation.
    constexpr double kFlattest = 1e-12;
    const glm::dmat3 linear(matrix);
    const double edges = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    if (!(std::abs(glm::determinant(linear)) > kFlattest * edges))
        throw InputError(where, "transform is singular: it flattens space and cannot be inverted (a scale of zero?)");
}

}  // namespace

glm::dmat4 rotationMatrix(glm::dvec3 axis, double angleDegrees) {
    return glm::rotate(glm::dmat4(1.0), glm::radians(angleDegrees), axis);
}

glm::dvec3 anyUp(glm::dvec3 direction) {
    const double sign = std::copysign(1.0, direction.z);
    const double a = -1.0 / (sign + direction.z);
    return {1.0 + sign * direction.x * direction.x * a, sign * direction.x * direction.y * a, -sign * direction.x};
}

glm::dmat4 lookAtMatrix(glm::dvec3 origin, glm::dvec3 target, glm::dvec3 up) {
    const glm::dvec3 direction = glm::normalize(target - origin);
    const glm::dvec3 left = glm::normalize(glm::cross(up, direction));
    const glm::dvec3 newUp = glm::cross(direction, left);
    return {glm::dvec4(left, 0.0), glm::dvec4(newUp, 0.0), glm::dvec4(direction, 0.0), glm::dvec4(origin, 1.0)};
}

glm::dmat4 readFlatTransform(const XmlElement& transform) {
    glm::dmat4 product(1.0);
    for (const XmlElement& step : transform.children) product = readStep(step) * product;
    if (!isFinite(product)) throw InputError(transform.where, "transform overflows: its product is not finite");
    return product;
}

glm::dmat4 readTransform(const XmlElement& transform) {
    const glm::dmat4 product = readFlatTransform(transform);
    checkInvertible(product, transform.where);
    return product;
}

Similarity similarityOf(const glm::dmat4& matrix) {
    constexpr double kTolerance = 1e-4;  // six-digit matrices of exporters must pass
    const glm::dmat3 linear(matrix);
    const glm::dmat3 gram = glm::transpose(linear) * linear;
    const double square = (gram[0][0] + gram[1][1] + gram[2][2]) / 3.0;
    bool holds = true;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            holds = holds && std::abs(gram[i][j] - (i == j ? square : 0.0)) <= kTolerance * square;
    return {holds, std::sqrt(square)};
}

}  // namespace parhelion
