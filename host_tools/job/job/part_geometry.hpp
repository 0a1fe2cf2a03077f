// Content of a part file: loops of a drawing, faces of a model or facets of a mesh. `import` reads it
// (part_geometry_reader.hpp), `part_info` describes it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::job {

// In plan, mm.
struct ClosedLoop {
    std::vector<nurbs::Curve> curves;  // in order
    std::vector<Vec2d> outline;        // chords within 1e-3 mm; the last point is the first again
    double length{};
    double area{};                  // above 0, or 0
    bool counter_clockwise{};       // as drawn
    int parent{-1};                 // index of the smallest loop around it; -1: none
    int depth{};                    // loops around it: even encloses material, odd is a hole
    std::optional<Vec2d> crossing;  // where it crosses itself
};

struct OpenChain {
    std::vector<Vec2d> outline;
    std::size_t curves{};
    double length{};
    Vec2d begin, end;
    // From one of its ends to the nearest end of any chain, this one's other end included.
    double gap{};
    Vec2d gap_from, gap_to;
    std::vector<nurbs::Curve> pieces;  // in order
};

struct LoopNesting {
    std::size_t curves{};
    std::size_t repeated{};         // drawn a second time over another one; left out
    std::vector<ClosedLoop> loops;  // the largest first
    std::vector<OpenChain> open;
    std::size_t bridged{};          // gaps over 1e-3 mm that were joined
    double widest_gap{};            // mm, of those
    std::optional<Vec2d> crossing;  // where two loops cross: their nesting is undefined
    // The first place where more than two ends of loose curves meet, and how many.
    std::optional<Vec2d> junction;
    std::size_t junction_ends{};
};

struct PartUnit {
    std::string name;      // "mm", "inch", or as the file has it
    double millimetres{};  // of one; 0: unknown (STEP and IGES are converted on reading)
    bool assumed{};        // the file names none
};

struct PartLayer {
    std::string name;  // "" where the file has no layers
    bool hidden{};     // switched off or frozen: left out unless it is requested
    std::string problem;
    LoopNesting loops;
};

// Box of a mesh, seen from above, mm.
struct OpenHole {
    Vec3d middle;
    Vec3d size;
};

// Level ground that is seen from above; of the highest it is the top.
struct PartLevel {
    double z{};     // mm
    double area{};  // mm^2
};

// A connected piece of level ground with walls beside it, mm.
struct PartPocket {
    double z{};
    Vec2d middle;  // of its box
    Vec2d size;
    double area{};  // mm^2
    bool open{};    // the part does not stand all around it
};

// A recess over a hole: level, or a cone.
struct HoleMouth {
    double diameter{};  // mm, the widest
    double depth{};     // mm
    double angle{};     // degrees between the flanks; 0: level
};

// Round holes of one kind, open above, vertical.
struct PartHoles {
    double diameter{};  // mm
    double top{};       // z, mm: where the cylinder begins
    double depth{};     // mm of the cylinder
    double tip{};       // mm: of a cone or a ball below it; 0: level
    bool through{};
    std::optional<HoleMouth> mouth;
    std::vector<Vec2d> places;  // by x, then y
};

// Upright concave walls of one radius that are no holes: the corners of pockets, ends of slots.
struct PartCorners {
    double radius{};  // mm
    std::size_t count{};
};

// Rounds of one radius between faces that they touch without an edge, and that are no inner corners.
struct PartFillets {
    double radius{};  // mm
    bool concave{};
    std::size_t count{};
    double length{};  // mm, along the middle of them
};

// Features by which a tool from above is chosen.
struct PartFeatures {
    std::vector<PartLevel> levels;     // the highest first
    std::vector<PartPocket> pockets;   // the highest first, the largest of a level first
    std::vector<PartHoles> holes;      // the narrowest first
    std::size_t closed_above{};        // holes that begin below
    std::vector<PartCorners> corners;  // the smallest radius first
    std::vector<PartFillets> fillets;  // the concave first, the smallest radius first
};

// One of `layers`, `surfaces` and `triangles` is filled.
struct PartGeometry {
    std::string file;    // as given, "#layer" included
    std::string format;  // as "STEP", "JSON surfaces"
    PartUnit unit;
    Vec3d box_low, box_high;  // mm

    // Drawings and curves.
    std::vector<PartLayer> layers;

    std::vector<nurbs::Surface> surfaces;
    // One value for each surface: +1 if du x dv points out of its solid, -1 if into it; 0: of no solid. Empty
    // where the file has no solids.
    std::vector<double> outwards;
    std::size_t solids{};            // STEP, IGES and BREP
    std::size_t unread_faces{};      // that face down and have broken edges
    std::vector<std::string> notes;  // on what was wrong in the file and was mended

    std::vector<std::array<Vec3d, 3>> triangles;
    std::size_t degenerate{};           // facets without area, left out
    std::vector<OpenHole> holes_above;  // that planners close; the largest first

    std::optional<PartFeatures> features;  // of models and meshes
};

}  // namespace cusp::job
