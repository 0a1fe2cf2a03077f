// Chooses for each broken edge of a solid the vee of a one-line call that cuts it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/import/part_regions.hpp"
#include "host_tools/job/import/tool_text.hpp"

namespace cusp::import {

enum class ChamferFault : std::uint8_t {
    kNoVee,       // has the angle
    kTooNarrow,   // are those that have it
    kNoRoom,      // for the tip beside an edge
    kWouldGouge,  // the tool would, other ground of the part
    kStockBeside  // stands, where the flat end does not come
};

// The edges of one band.
struct SolidChamfer {
    EdgeBand band;                    // mm; the width is that of the tool's flank
    double angle;                     // degrees: between the flanks of a vee that fits
    std::optional<std::size_t> tool;  // place in the call; none: nothing cuts them
    ChamferFault fault;               // then
    offset::Region2d loops;
    offset::Region2d near;  // within the tool's reach, in plan
};

// A vee has the angle of the band, is wide enough, and gouges nothing (PartModel::drop_height() along its path).
//
// facets  of the whole part
// tools   of the call
// unit    mm, of its lengths
std::vector<SolidChamfer> solid_chamfers(const Triangles& facets,
                                         const std::vector<NamedTool>& tools,
                                         double unit);

// mm: the diameter of a vee that is wide enough.
double least_vee(const SolidChamfer& chamfer);

}  // namespace cusp::import
