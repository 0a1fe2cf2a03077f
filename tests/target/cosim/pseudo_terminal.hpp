// The chip's serial line as a pseudo-terminal of the host.
#pragma once

#include "tests/target/cosim/chip_under_test.hpp"

namespace cusp::cosim {

// Prints "terminal NAME", then runs at most this much of the chip's time, never faster than the
// host's; ends when the other end has been opened and is closed again.
void run_on_terminal(ChipUnderTest& chip, Picoseconds time);

}  // namespace cusp::cosim
