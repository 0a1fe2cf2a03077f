// Map of the stock left and of gouges for the page, and the worst points.
#pragma once

#include <string>
#include <vector>

#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/view/byte_text.hpp"

namespace cusp::view {

struct WorstPlace {
    std::string kind;  // "gouge", "left" or "uncut"
    double mm;         // depth of the gouge, or stock above the reachable height
    Vec3d at;
};

// At most ten, sorted by the ratio to their bound: the floor tolerance for gouges; for stock left
// the scallop, or the tolerance where there is no scallop. Points are not adjacent.
//
//   top  z of the uncut stock
std::vector<WorstPlace> worst_places(const verify::Verification& verification, double top);

// Format, on the grid: f64 low and high z of the part; z in steps of (high - low) / 65534 (u16,
// 65535: none); then the stock left in 0.1 um (i16; gouges negative; 32767: uncut, -32768: no
// floor); all low bytes, then all high bytes of each. Deflated except the two numbers.
Bytes left_map(const verify::Verification& verification, const verify::HeightGrid& grid);

}  // namespace cusp::view
