// Checks of an operation by its keys, for the `check` of strategies' records.
#pragma once

#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::job {

// Runs the check of the strategy's record, then refuses islands outside the boundary. Throws InputError.
void check_operation(const Strategy& strategy, const Operation& operation, const Refuse& refuse);

// Refuses the key as missing where it is not there.
//
// what  that the strategy needs it for
void need(bool there,
          const char* key,
          const char* what,
          const Operation& operation,
          const Refuse& refuse);
// mm, from the tip of a vee or a taper to its full radius.
double flank_height(const toolpath::Tool& tool);

// A drill cuts straight down only.
void check_sideways(const Operation& operation, const Refuse& refuse);
// The depth is given, and a tool with vertical flanks.
void check_level(const Operation& operation, const Refuse& refuse);
// A ball, flat or bull end.
void check_end(const Operation& operation, const Refuse& refuse);
// The same or a taper: what finishes parts. A taper does not rough.
void check_finishing_end(const Operation& operation, const Refuse& refuse);
// Strategies that always finish: min_depth needs layers.
void check_least_depth(const Operation& operation, const Refuse& refuse);
// Pockets with walls: boundary, scallop, layers and roughing.
void check_pocket(const Operation& operation, const Refuse& refuse);
// Passes over surfaces that may rough first: adaptive clearing needs roughing.
void check_adaptive_roughing(const Operation& operation, const Refuse& refuse);

}  // namespace cusp::job
