// Sides of an open line.
//
//     const LineSide line{points};
//     line.left(3, 4);  // mm on its left, < 0: on its right; nothing beyond its ends
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::verify {

class LineSide {
public:
    // points  at least two
    explicit LineSide(std::vector<Vec2d> points) : points_{std::move(points)} {}

    // By brute force over the points.
    std::optional<double> left(double x, double y) const;

private:
    std::vector<Vec2d> points_;
};

}  // namespace cusp::verify
