// Geometry of 2.5-D operations: loops, curves or holes in plan, cut straight down from a level.
//
//     job::Prismatic cut;
//     cut.top = 0.0;
//     cut.depth = 6.0;                 // down to z = -6
//     cut.loops = {{outline, "plate.dxf#outline", false}};
//     cut.side = job::ProfileSide::kOutside;
//     cut.tabs = {4, {}, 6.0, 1.5, true};
//
// All lengths are in mm. docs/job_file.md explains the keys of the file; each has a member here.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::job {

// A chain of curves, in order; closed or open.
using Chain = std::vector<nurbs::Curve>;

enum class ProfileSide : std::uint8_t { kOutside, kInside, kOn };

// A closed loop of a drawing, counter-clockwise.
struct NestedLoop {
    Chain loop;
    std::string name;  // of its file, and its place where the file holds several
    bool hole{};       // inside an odd number of others: material is outside it
};

// Bridges that hold a part while it is cut free.
struct Tabs {
    int count{};                // evenly along each loop; 0: at `places`
    std::vector<Vec2d> places;  // each on the nearest loop
    double width{};             // along the loop, at full height
    double height{};            // over the bottom of the cut
    bool ramped{};              // slopes at both sides, else vertical ends
};

// A place to drill.
struct Hole {
    Vec2d at;
    double diameter{};  // of the circle drawn, or of the cylinder; 0: a point
    // Holes of models, z; a blind one ends at `bottom`, the tip of its cone.
    struct Span {
        double top;
        double bottom;
        bool through;
        double tip{};  // mm: height of a cone or a ball at the bottom
    };
    std::optional<Span> span{};
};

struct Prismatic {
    double top{};    // z at which the cut begins
    double depth{};  // below `top`
    std::optional<double> given_top;
    bool given_depth{};  // by the job; else that of a vee's flank
    // pocket, profile, v_carve, chamfer; face: what is faced, none: the stock
    std::vector<NestedLoop> loops;
    std::vector<Chain> chains;         // engrave
    std::vector<Hole> holes;           // drill
    std::vector<Hole> narrower_holes;  // than the drill: left out with a warning
    std::string file;                  // that they come from
    // profile
    ProfileSide side{ProfileSide::kOutside};
    std::optional<Tabs> tabs;
    std::optional<double> lead_in;   // radius of the arc; 0: none
    std::optional<double> lead_out;  // likewise
    // drill
    std::optional<std::array<double, 2>>
        diameters;  // of the circles to drill; none: all, and points
    std::optional<double> peck;
    std::optional<double> countersink;  // mm: how wide the tip's cone cuts at `top`
    // face
    std::optional<double> overhang;  // of the tool's edge over the stock's
    // chamfer
    double width{};  // in plan
};

}  // namespace cusp::job
