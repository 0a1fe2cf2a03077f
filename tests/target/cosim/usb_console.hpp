// Commands about USB, of the co-simulation's input.
#pragma once

#include <istream>

#include "tests/target/cosim/chip_under_test.hpp"

namespace cusp::cosim {

//   usb plug | unplug | suspend | resume
//   usb open | close             bytes of the serial port move, or wait
//   usb address N                of the tokens that follow
//   usb control SETUP [DATA]     in hexadecimal; answers "stage ack|stall|late|none DATA"
//   usb begin SETUP              the SETUP packet alone
//   usb give ENDPOINT DATA | fetch ENDPOINT   one packet, "stage ack|late|stall|none DATA"
void command_usb(ChipUnderTest& chip, std::istream& words);

}  // namespace cusp::cosim
