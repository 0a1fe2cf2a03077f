// Stepover: how far apart two passes of a ball may be for a bound on the scallop between them.
#pragma once

namespace cusp::toolpath {

// Distance between the contacts of two passes of a ball, mm, at which the scallop between them has
// a given height.
//
//   radius          mm > 0, of the ball
//   scallop_height  mm > 0, square to the surface; at most the radius counts
//   curvature       1/mm, of the surface across the passes, > 0 where it bends away from the tool
//                   (convex). A ball hardly fits below -0.98 / radius: no less than that counts.
//   widest          radii: no more is returned, since curvature seldom stays so for so far.
//                   Infinite returns infinity where no scallop gets that high.
//
// The ball's centre lies radius over the contact: centres are (1 + radius * curvature) times as far
// apart.
//
//     const double apart = stepover(6.0, 0.4, 0.0);         // 4.308: chord of the ball on a plane
//     const double on_hill = stepover(6.0, 0.4, 1.0 / 20);  // 3.737
//
// Source: Suh & Lee 1990, equation (16) as it should read (docs/papers.md), with the square root
// factored so that nothing cancels where the surface is flat. Held by stepover_test.
double stepover(double radius, double scallop_height, double curvature, double widest = 1.8);

}  // namespace cusp::toolpath
