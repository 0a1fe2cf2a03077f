// The pins and rates of a Pico 2 on a breakout board with a screw terminal for each pin.
#pragma once

#include <cstdint>

#include "boards/mill3/pico_pin_rules.hpp"
#include "hal/rp2350/pulse_program.hpp"
#include "hal/usb_serial/usb_descriptors.hpp"

namespace cusp::boards {

using hal::rp2350::GP;

struct Pico2Table {
    static constexpr hal::rp2350::LinePins kLines{
        {GP(2), GP(3), GP(4), GP(5), GP(6), GP(7), GP(8), GP(9)}};

    static constexpr PicoPanelPins kPanelPins = [] {
        PicoPanelPins pins;
        pins.limit_x = GP(16);
        pins.limit_y = GP(17);
        pins.limit_z = GP(18);
        pins.probe = GP(19);
        pins.door = GP(20);
        pins.hold = GP(21);
        pins.start = GP(22);
        pins.reset = GP(26);
        pins.emergency_stop = GP(27);
        pins.motor_fault = GP(28);
        pins.drives_off[0] = GP(15);
        pins.flood = GP(13);
        pins.mist = GP(14);
        pins.spindle_on = GP(11);
        pins.spindle_reverse = GP(12);
        pins.spindle_pulses = {GP(10)};
        return pins;
    }();

    static constexpr std::uint32_t kBaud = 115200;
    static constexpr hal::usb_serial::UsbIdentity kUsb{0x1209, 0x0001, "cusp pico2_terminals"};
    static constexpr std::uint32_t kFlashBytes = 4 * 1024 * 1024;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
