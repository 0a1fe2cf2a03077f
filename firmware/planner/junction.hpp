// Junctions of two blocks: the speed at which jumps of direction and curvature may be passed.
#pragma once

#include "firmware/planner/block.hpp"

namespace cusp::planner {

// The jumps at a junction, per axis.
struct Junction {
    Vec3f direction;  // |change of dP/ds|
    Vec3f curvature;  // change of d2P/ds2, 1/mm
    Vec3f second;     // largest |d2P/ds2| of the path around it, 1/mm
    Vec3f third;      // and |d3P/ds3|, 1/mm^2
    float turn;       // length of the change of direction: about the angle, radians
};

// around: bounds over the path that one window of the axis filters may hold with the junction.
Junction make_junction(const EndGeometry& before,
                       const EndGeometry& after,
                       const PathDerivatives& around) noexcept;

// Consecutive junctions that one window of the axis filters may hold.
struct JunctionRun {
    explicit JunctionRun(const Junction& last) noexcept
        : all{last},
          net{last.curvature},
          greatest{magnitude(last.curvature)},
          total{magnitude(last.curvature)}
    {
    }
    // Takes in the junction before them.
    void add(const Junction& earlier) noexcept;

    Junction all;    // sums of direction and turn, the largest second and third
    Vec3f net;       // change of d2P/ds2 over all of them, 1/mm
    Vec3f greatest;  // largest |change| from one of them to the last, 1/mm
    Vec3f total;     // sum of the |changes|, 1/mm
};

// The share of the axes' limits, after the path around it, that a junction uses.
struct JunctionShare {
    float speed;         // mm/s, greatest that it may be passed at
    float acceleration;  // share taken at that speed, in [0, 1)
    float jerk_at_rest;  // share taken is at most a line over the squared speed: at rest,
    float jerk;          // and at that speed, in [0, 1)
    bool caps{true};     // whether the speed is no more than this around it, too
};

// The deviation from the path.
struct Blur {
    float deviation;     // mm, > 0: how far the filters may leave it
    float mean_time{0};  // s, of the input shaper: mean of |t| under its kernel
    // s^2: deviation of a bend over its centripetal acceleration, shaper included; 0 without one.
    float square{0};
};

// The limits used by a run of junctions. The axis filters turn a jump of direction into acceleration of at
// most v jump/t1 and jerk of at most v jump/(t1 t2), and a jump of acceleration into jerk of at most
// jump/t1. Jumps of acceleration to and fro cancel, but for what the speed changes between them.
//
//   max_share  greatest share of acceleration and jerk that the junction may take.
//   max_speed  mm/s, of the path around it.
//   blur       how far the corner may be left.
//
// Returns the greatest speed, at most max_speed, and the shares taken.
// Source: docs/numerics.md, "Junctions".
JunctionShare junction_share(const JunctionRun& run,
                             const MachineLimits& limits,
                             AxisFilter filter,
                             float max_share,
                             float max_speed,
                             const Blur& blur) noexcept;

}  // namespace cusp::planner
