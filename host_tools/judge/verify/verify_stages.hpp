// The stages of a verification, in their order.
#pragma once

#include "host_tools/judge/verify/verifying.hpp"

namespace cusp::verify {

// Parts and walls of the job; the program's moves as runs of positions.
void read_positions(Verifying& work);

// The stock as earlier programs leave it, then as the program does: depths, rapids, contacts of the tool's body.
void cut_program(Verifying& work);

// The engagement, where it is wanted.
void measure_engagement(Verifying& work);

// Floors of surfaces and meshes, and their walls; fills the maps.
void judge_surfaces(Verifying& work);

// 2.5-D operations. In their regions surfaces of other operations do not limit the depth, so these figures of gouges
// replace those of the surfaces.
void judge_level_operations(Verifying& work);

// Screw threads: pitch, hand and depth of their helices. Their diameters are walls of 2.5-D operations.
void judge_threads(Verifying& work);

// Tools that touch a fixture.
void judge_fixtures(Verifying& work);

}  // namespace cusp::verify
