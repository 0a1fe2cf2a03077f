// Numbers the corners of facets, so that facets with bitwise equal corners share them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

// STL writers repeat corners bit by bit, so equality is sufficient. -0 is 0.
class CornerTable {
public:
    // max_corners  that will be asked for; corners with equal coordinates count each
    // corners      receives each new corner; its place is its number
    CornerTable(std::size_t max_corners, std::vector<Vec3d>& corners);

    std::uint32_t number_of(Vec3d p);

private:
    std::vector<Vec3d>& corners_;
    std::vector<std::uint32_t> table_;
};

}  // namespace cusp::part_model
