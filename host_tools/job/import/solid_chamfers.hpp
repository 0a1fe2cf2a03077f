// Chooses for each broken edge of a solid the vee of a one-line call that cuts it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/import/cad_holes.hpp"
#include "host_tools/job/import/part_regions.hpp"
#include "host_tools/job/import/solid_edges.hpp"
#include "host_tools/job/import/solid_ground.hpp"
#include "host_tools/job/import/tool_text.hpp"

namespace cusp::import {

enum class ChamferFault : std::uint8_t {
    kNoVee,       // has the angle
    kTooNarrow,   // are those that have it
    kNoRoom,      // for the tip beside any part of an edge
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
    std::optional<EdgeWays>
        ways;  // of the tool where it can't break all of the edges; none: it goes along the loops
    SolidEdges::Survey all;  // edges of the band
    offset::Region2d near;   // within the tool's reach, in plan
    double beside;           // mm: from edges() to the band

    // A tool whose cone cuts all of the edges if it goes down in the middle of each, as they are round mouths.
    struct Sink {
        std::size_t tool;  // place in the call
        std::vector<Vec2d> centres;
        double width;           // mm: of the mouths
        offset::Region2d near;  // within the mouths, in plan
    };
    std::optional<Sink> sink;  // none: no tool can, or `tool` breaks all of the edges

    // Edges along which the tool goes.
    std::vector<offset::Edge> edges() const;
    // mm: of the tip below the band's upper edge.
    double depth() const;
};

// A vee has the angle of the band, is wide enough, and gouges nothing (PartModel::drop_height() along its path). Where it
// would, or has no room, or where the ground rises beside parts of the loops alone, it breaks what it can.
//
// facets  of the whole part
// tools   of the call
// unit    mm, of its lengths
std::vector<SolidChamfer> solid_chamfers(const Triangles& facets,
                                         const std::vector<NamedTool>& tools,
                                         double unit);

// True for the facets of the chamfers that a tool makes.
IsCutApart cut_by_vees(const std::vector<SolidChamfer>& chamfers);

// In words: why it is left out, and the tool that would cut it.
//
// inch  whether lengths of tools need their unit
std::string words_of(const SolidChamfer& chamfer, ChamferFault fault, bool inch);

// mm: diameters of the holes whose mouths the sink is for, and of the mouths. None: other holes of their diameter begin at
// the band's foot, which a job can't tell from them.
struct SunkHoles {
    double diameter;
    double mouth;
};
std::optional<SunkHoles> sunk_holes(const SolidChamfer& chamfer, const CadHoles& found);

}  // namespace cusp::import
