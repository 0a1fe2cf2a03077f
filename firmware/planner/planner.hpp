// The planner: moves become blocks with geometry, speed limits and an always feasible way to stop.
//
// Main loop side: push() a Move when has_room(); close() when no further move is at hand. The
// interpolator reads the blocks from the servo tick; only raising of speeds happens under its eyes.
#pragma once

#include "firmware/base/machine_limits.hpp"
#include "firmware/path/move.hpp"

namespace cusp::planner {

class Planner;

// What machine/ relies on; defined in this module:
//
//   class Planner {
//       explicit Planner(const MachineLimits&);
//       void set_limits(const MachineLimits&);   // precondition: empty()
//       void reset(Position at);                 // forgets all moves; the next starts at `at`
//       bool has_room() const;                   // push() takes one more move of any kind
//       void push(const Move&);                  // precondition: has_room(), move.start == tail()
//       void close();                            // plan what is held back for blending
//       bool empty() const;                      // every move is played to its end
//       Position tail() const;                   // where the last pushed move ends
//       std::uint32_t free_blocks() const;       // for Bf:
//   };
//
// and in firmware/interpolator/interpolator.hpp:
//
//   class Interpolator {
//       explicit Interpolator(Planner&);
//       Position tick();                         // next set point, machine nm; servo tick
//       bool at_rest() const;                    // filters empty, nothing moves now
//       void reset(Position at);                 // at rest at `at`
//       void hold(); void resume(); bool holding() const;   // at_rest() tells when a hold is
//       complete void set_feed_override(unsigned percent); void set_rapid_override(unsigned
//       percent); std::uint32_t executing_line() const; float speed() const;                     //
//       mm/s along the path, now Position position() const;               // last set point
//   };
//
// and in firmware/pulse/pulse_maker.hpp:
//
//   struct StepSettings { Vec3f steps_per_mm; std::uint16_t pulse_us, low_us, direction_setup_us;
//   }; class PulseMaker {
//       explicit PulseMaker(const StepSettings&);
//       void make_frame(Position set_point, PulseFrame& frame);   // one servo tick
//       bool idle() const;                       // all lines low, nothing pending
//       PerAxis<std::int32_t> position_steps() const;
//   };

}  // namespace cusp::planner
