// Points and normals of a face at nine places of a cell of its domain.
#pragma once

#include <array>
#include <optional>

#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::finishing {

// The face at the corners of a cell, at the middles of its sides and at its middle; row by row.
struct FaceSamples {
    std::array<Vec3d, 9> points;
    std::array<Vec3d, 9> normals;  // to one side of the face
    double turn{};                 // how much they differ
    double low{};                  // of their z
    double high{};
    bool turns_along_u{};       // more than along v
    bool lines_bend_along_u{};  // the same, lines of equal z
};

// None where the face has no normal in most places.
std::optional<FaceSamples> sample_face(const part_model::PartModel& model,
                                       int surface,
                                       Vec2d low,
                                       Vec2d high);

}  // namespace cusp::finishing
