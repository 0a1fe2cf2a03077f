// What a program leaves of its part, and cuts into it: a map for the page, and the worst places.
#pragma once

#include <string>
#include <vector>

#include "host_tools/verify/verify.hpp"
#include "host_tools/view/byte_text.hpp"

namespace cusp::view {

struct WorstPlace {
    std::string kind;  // "gouge", "left" or "uncut"
    double mm;         // into the part; over what the tools reach
    Vec3d at;
};

// At most ten, the worst by their bounds first: gouges by the tolerance of floors, metal left by the
// scallop (by the tolerance, where no scallop is promised). Places lie apart.
//
//   top  z of the uncut stock
std::vector<WorstPlace> worst_places(const verify::Verification& verification, double top);

// The bytes, on the grid: f64 low and high z of the part; z in steps of (high - low) / 65534 (u16,
// 65535: none); then what is left in 0.1 um (i16; gouges below 0; 32767: uncut, -32768: no floor);
// all low bytes, then all high bytes of each. Deflated but for the two numbers.
Bytes left_map(const verify::Verification& verification, const verify::HeightGrid& grid);

}  // namespace cusp::view
