// Regions of a part as drawings, for 2.5-D operations: `boundary = "bracket.step#above:-4"`.
//
// FILE is a STEP, IGES or BREP model, or a mesh; Z a height in the units of the job, as the part is placed.
//
//   FILE#outline    the whole part, seen from above
//   FILE#above:Z    what stands above Z: a profile around it finishes the walls down to there
//   FILE#below:Z    what the part's box has beside that: a pocket of it clears the part down to Z
//   FILE#level:Z    the level ground at Z
//   FILE#edges:Z:Z:WIDTH  broken edges: of what stands above the first Z the loops beside which the ground rises evenly
//                         to the second within WIDTH, seen from above; a chamfer with that `width` cuts them
//
// After Z may follow ":no_holes": round holes of a model that begin above Z are filled in. Holes themselves, for what
// drills and bores, are chosen by
//
//   FILE#holes:Z:Z  those whose walls begin between both heights
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/import/drawing.hpp"
#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::import {

// mm: loops are no farther from the part's facets, of which those of a model are kFacetsOff from it.
inline constexpr double kRegionFit = 1e-3;

// A band of even slope beside an edge. mm
struct EdgeBand {
    double low;  // z of its lower edge
    double high;
    double width;  // seen from above
};

// True if a "#" follows the name of a model or of a mesh.
bool names_part_region(const std::string& name);

// True if the region has no round holes.
bool names_filled_region(const std::string& name);

// The least and the greatest z, mm, at which the wanted holes of a model begin; none: the name wants all of them.
//
// Errors: InputError: the name is that of another region, or a height is no number.
std::optional<std::array<double, 2>> hole_tops(const std::string& name, double millimetres);

// The band of the broken edges that the name wants; none: it is that of another region.
//
// Errors: InputError: not three numbers.
std::optional<EdgeBand> edge_band(const std::string& name, double millimetres);

// The region's loops, of lines and arcs, not nested; of broken edges all of what stands above the band's foot.
//
// name         FILE#REGION, for messages too
// millimetres  of one unit of Z
// facets       of the whole part, placed
// filled       holes, placed, that it shall not have: empty where names_filled_region() is false
//
// Errors: InputError: no such region, Z is no number, nothing is there, with the heights that there are.
DrawnPaths part_region(const std::string& name,
                       double millimetres,
                       const std::vector<std::array<Vec3d, 3>>& facets,
                       const std::vector<job::Hole>& filled);

offset::Region2d hole_disc(const job::Hole& hole);

// The region and the discs of the holes that begin above z.
offset::Region2d with_holes_filled(const offset::Region2d& region,
                                   const std::vector<job::Hole>& holes,
                                   double z);

// The rectangle of the box.
offset::Region2d box_region(const PartExtent& box);

// A line or an arc as a curve.
nurbs::Curve drawn_curve(const offset::Edge& edge);

// Lines and arcs as closed curves.
DrawnPaths drawn_region(const offset::Region2d& region);

}  // namespace cusp::import
