// Serial ports that are boards on USB, found by what they say of themselves.
#pragma once

#include <string>
#include <vector>

namespace cusp::stream {

struct UsbPort {
    std::string device;  // "/dev/ttyACM0"
    int vendor{0};
    int product{0};
    std::string name;    // the product's, "cusp skr2_f407"; may be empty
    std::string serial;  // the serial number; may be empty
};

// Boards that are plugged in now. Errors: InputError if the system does not tell.
std::vector<UsbPort> list_usb_ports();

// The device of the one port that `wanted` names: a part of its name, its serial number, or VID:PID in
// four hexadecimal digits each; empty: whatever is called "cusp ...".
//
// Errors: InputError if none is, or several are; it lists them.
std::string pick_usb_port(const std::vector<UsbPort>& ports, const std::string& wanted);

}  // namespace cusp::stream
