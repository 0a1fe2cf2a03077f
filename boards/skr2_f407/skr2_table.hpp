// Skr2Table: BIGTREETECH's SKR 2 with an STM32F407. Its lines lie on ports E, D and A. README.md is
// the wiring table.
#pragma once

#include <cstdint>

#include "boards/mill3/panel_pins.hpp"
#include "hal/stm32f4/clock_tree.hpp"
#include "hal/stm32f4/drive_bus.hpp"
#include "hal/stm32f4/drive_wire.hpp"
#include "hal/stm32f4/pace.hpp"
#include "hal/stm32f4/serial_ports.hpp"
#include "hal/stm32f4/step_ports.hpp"
#include "hal/stm32f4/usb_endpoints.hpp"

namespace cusp::boards {

struct Skr2Table {
    static constexpr hal::stm32f4::LinePins kLines{
        {{'E', 2}, {'D', 5}, {'A', 15}, {'E', 1}, {'D', 4}, {'A', 8}, {'D', 15}, {'D', 14}}};
    static constexpr PanelPins kPanelPins = [] {
        PanelPins pins;
        pins.limit_x = {'C', 1};
        pins.limit_y = {'C', 3};
        pins.limit_z = {'C', 0};
        pins.probe = {'E', 4};
        pins.door = {'A', 7};
        pins.hold = {'A', 5};
        pins.start = {'A', 6};
        pins.reset = {'A', 4};
        pins.emergency_stop = {'C', 2};
        pins.motor_fault = {'A', 0};
        pins.second_limit = {'E', 7};
        pins.drives_off = {{{'E', 3}, {'D', 6}, {'D', 1}, {'C', 7}}};
        pins.flood = {'B', 3};
        pins.mist = {'B', 4};
        pins.spindle_on = {'B', 6};
        pins.spindle_reverse = {'B', 5};
        pins.spindle_pulses = {{'B', 0}, 3};
        pins.power = {'C', 13};
        return pins;
    }();

    // Of TMC2209 modules of the maker.
    static constexpr hal::stm32f4::DrivePins kDriveWires{{{'E', 0}, {'D', 3}, {'D', 0}, {'C', 6}}};
    static constexpr float kSenseMilliohms = 110;
    // And TMC5160. They answer on the debugger's clock.
    static constexpr hal::stm32f4::DriveBusPins kDriveBus{{'E', 15}, {'E', 14}, {'A', 14}};
    static constexpr float kBusSenseMilliohms = 75;

    template <class Chip>
    using Pace = hal::stm32f4::Timer8Pace<Chip>;
    template <class Chip>
    using SerialPort = hal::stm32f4::Usart1Port<Chip>;
    static constexpr hal::stm32f4::ClockPlan kClocks{8000000, 168000000, 5, 2, 4, 1};
    static constexpr std::uint32_t kBaud = 115200;
    static constexpr hal::stm32f4::UsbIdentity kUsb{0x1209, 0x0001, "cusp skr2_f407"};
    static constexpr auto kUsbSession = hal::stm32f4::UsbSession::kNotSensed;
    static constexpr std::uint32_t kMostStepsPerSecond = 250000;
};

}  // namespace cusp::boards
