// Checks that contours bound a region: no crossings, and holes inside.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

enum class RegionFaultKind : std::uint8_t {
    kNoLength,       // an edge of contours[first] at `where` is shorter than 1e-7 mm
    kCrossesItself,  // contours[first] at `where`
    kCross,          // contours[first] and contours[second] at `where`
    kHoleOutside,    // contours[second] lies outside contours[first]
    kHoleInHole,     // contours[second] lies inside the hole contours[first]
};

struct RegionFault {
    RegionFaultKind kind;
    std::size_t first;
    std::size_t second;
    Vec2d where;
};

// The first fault of a region whose first contour is the outer one and all others are its holes.
// Contours may touch in a point.
std::optional<RegionFault> find_fault(const Region2d& region);

// The fault in words, the contour at fault first: "FIRST: crosses SECOND at WHERE".
//
//   first, second  names of the contours of the fault
//   where          the place of the fault
std::string fault_text(const RegionFault& fault,
                       const std::string& first,
                       const std::string& second,
                       const std::string& where);

}  // namespace cusp::offset
