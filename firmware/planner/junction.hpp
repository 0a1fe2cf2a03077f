// Where two blocks meet: how fast the jumps of direction and curvature may be passed.
#pragma once

#include "firmware/planner/block.hpp"

namespace cusp::planner {

// The jumps at a junction, per axis.
struct Junction {
    Vec3f direction;  // |change of dP/ds|
    Vec3f curvature;  // |change of d2P/ds2|, 1/mm
    Vec3f second;     // largest |d2P/ds2| of the path around it, 1/mm
    Vec3f third;      // and |d3P/ds3|, 1/mm^2
    float turn;       // length of the change of direction: about the angle, radians
};

// around: bounds over the path that one window of the axis filters may hold with the junction.
Junction make_junction(const EndGeometry& before,
                       const EndGeometry& after,
                       const PathDerivatives& around) noexcept;

// A sum of junctions that one window of the axis filters may hold.
Junction combined(const Junction& a, const Junction& b) noexcept;

// What a junction takes of what the path around it leaves of the axes' limits.
struct JunctionShare {
    float speed;         // mm/s, greatest that it may be passed at
    float acceleration;  // share taken at that speed, in [0, 1)
    float jerk_at_rest;  // share taken is at most a line over the squared speed: at rest,
    float jerk;          // and at that speed, in [0, 1)
};

// The axis filters turn a jump of direction into acceleration of at most v jump/t1 and jerk of at
// most v jump/(t1 t2), and a jump of acceleration into jerk of at most jump/t1.
//
//   max_share  greatest share of acceleration and jerk that the junction may take.
//   max_speed  mm/s, of the path around it.
//   deviation  mm, > 0: how far the filters may leave the corner.
//
// Returns the greatest speed, at most max_speed, and the shares taken.
// Source: docs/numerics.md, "Junctions".
JunctionShare junction_share(const Junction& junction,
                             const MachineLimits& limits,
                             AxisFilter filter,
                             float max_share,
                             float max_speed,
                             float deviation) noexcept;

}  // namespace cusp::planner
