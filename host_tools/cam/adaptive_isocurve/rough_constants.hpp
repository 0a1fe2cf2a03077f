// Distances that all that roughs a part has in common.
#pragma once

namespace cusp::adaptive_isocurve {

inline constexpr double kFirst = 2e-3;    // mm from the edge of a slice to the outermost pass
inline constexpr double kRounded = 1e-3;  // mm: more than rounding in the program
inline constexpr double kFit = 1.5e-3;    // mm: tolerance of the edges of slices as lines and arcs
inline constexpr double kRoughChord = 1e-3;   // mm: tolerance of arcs written as lines
inline constexpr double kPitchOfRadius = 15;  // radius over the finest pitch of a lattice

}  // namespace cusp::adaptive_isocurve
