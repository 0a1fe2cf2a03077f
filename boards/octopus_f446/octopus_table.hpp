// OctopusTable: BIGTREETECH's Octopus with an STM32F446. Its lines lie on ports F and G. README.md is
// the wiring table.
#pragma once

#include <cstdint>

#include "boards/mill3/panel_pins.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/drive_bus.hpp"
#include "hal/stm32f4/drive_wire.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/spindle_wire.hpp"
#include "hal/stm32f4/step_ports.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"

namespace cusp::boards {

struct OctopusTable {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'F', 13}, {'G', 0}, {'F', 11}, {'F', 12}, {'G', 1}, {'G', 3}, {'F', 9}, {'F', 10}}};
    static constexpr PanelPins kPanelPins = [] {
        PanelPins pins;
        pins.limit_x = {'G', 6};
        pins.limit_y = {'G', 9};
        pins.limit_z = {'G', 10};
        pins.probe = {'B', 7};
        pins.door = {'G', 14};
        pins.hold = {'E', 8};
        pins.start = {'E', 7};
        pins.reset = {'G', 15};
        pins.emergency_stop = {'G', 12};
        pins.motor_fault = {'G', 13};
        pins.second_limit = {'G', 11};
        pins.drives_off = {{{'F', 14}, {'F', 15}, {'G', 5}, {'G', 2}}};
        pins.flood = {'A', 2};
        pins.mist = {'A', 3};
        pins.spindle_on = {'A', 8};
        pins.spindle_reverse = {'E', 5};
        pins.spindle_pulses = {{'B', 1}, 4};
        return pins;
    }();

    // Of TMC2209 modules of the maker.
    static constexpr hal::stm32f4::DrivePins kDriveWires{{{'C', 4}, {'D', 11}, {'C', 6}, {'F', 2}}};
    static constexpr float kSenseMilliohms = 110;
    // And TMC5160.
    static constexpr hal::stm32f4::DriveBusPins kDriveBus{{'A', 5}, {'A', 7}, {'A', 6}};
    static constexpr float kBusSenseMilliohms = 75;

    // RS-485, to a spindle's drive: the WIFI header.
    static constexpr hal::stm32f4::SpindleWirePins kSpindleWire{{'D', 8}, {'D', 9}, {'D', 7}};
    template <class Chip>
    using SpindlePort = hal::stm32f4::Usart3Port<Chip>;

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart1Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{12000000, 168000000, 5, 2, 4, 3};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp octopus_f446"};
    static constexpr auto kUsbSession = hal::stm32f4::UsbSession::kOverridden;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
