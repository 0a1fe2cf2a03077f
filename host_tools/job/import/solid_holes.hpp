// Chooses for each round hole of a solid the tool of a one-line call that makes it: the table of features and
// operations of one-line jobs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/job/import/cad_holes.hpp"
#include "host_tools/job/import/tool_text.hpp"

namespace cusp::import {

enum class HoleWay : std::uint8_t { kLeft, kDrilled, kBored };

// Holes of one diameter that one operation makes, or that nothing makes.
struct SolidHoles {
    double diameter;   // mm
    double begins;     // z, mm: of what stands around them
    double least_top;  // z, mm: of their walls
    double greatest_top;
    bool alone;  // no other hole has the diameter
    HoleWay way;
    std::size_t tool;  // place in the call; of `kLeft` 0
    std::vector<job::Hole> holes;
};

// z, mm, of what stands around a hole while it is made, which begins at a height of the part.
using GroundAround = std::function<double(const job::Hole& hole, double top)>;

// A drill of its diameter makes a hole. A flat end of its diameter drills it too, and else the widest that has room in it
// bores it. The step of a counterbore is level: no drill makes it.
//
// tools  of the call
// unit   mm, of its lengths
//
// In the order of their making: steps before what begins on them, all of flat ends before those of drills.
std::vector<SolidHoles> solid_holes(const CadHoles& found,
                                    const std::vector<NamedTool>& tools,
                                    double unit,
                                    const GroundAround& ground);

}  // namespace cusp::import
