// The chip's serial line as a pseudo-terminal of the host.
#pragma once

#include <string>

#include "tests/target/cosim/chip_under_test.hpp"

namespace cusp::cosim {

// Makes a pseudo-terminal with a link to it, prints "terminal", then runs at most this much of the chip's time, never faster than the
// host's; ends when the other end has been opened and is closed again.
void run_on_terminal(ChipUnderTest& chip, const std::string& link, Picoseconds time);

}  // namespace cusp::cosim
