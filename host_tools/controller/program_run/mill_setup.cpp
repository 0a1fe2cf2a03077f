// Geometry and stored settings of the virtual mill.
#include "host_tools/controller/program_run/mill_setup.hpp"

#include <utility>

#include "firmware/machine/settings_log.hpp"
#include "firmware/machine/stored_state.hpp"

namespace cusp::program_run {

using machine::Setting;

hal::MillGeometry mill_geometry(const machine::Settings& settings,
                                std::optional<double> probe_z,
                                double part_from_home)
{
    hal::MillGeometry geometry;
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        const double travel = static_cast<double>(settings.value(Setting::kTravel, axis));
        const bool homes_to_minus = (settings.whole(Setting::kHomingDirection) >> axis & 1U) != 0;
        geometry.steps_per_mm[axis] =
            static_cast<double>(settings.value(Setting::kStepsPerMillimetre, axis));
        geometry.travel[axis] = travel;
        geometry.start[axis] =
            homes_to_minus ? travel * (part_from_home - 1.0) : -travel * part_from_home;
    }
    geometry.plate_above_start = probe_z;
    geometry.second_motor = settings.second_motor_axis();
    if (settings.has_rotary()) {
        constexpr double kStart = -30.0;
        geometry.rotary = hal::MillGeometry::RotaryTable{
            static_cast<double>(settings.value(Setting::kStepsPerMillimetre, kLinearAxes)), kStart};
    }
    return geometry;
}

machine::Settings stored_settings(const hal::SimulatedStore& store)
{
    hal::SimulatedStore copy = store;
    machine::StoredState state{};
    machine::SettingsLog<hal::SimulatedStore> log{copy};
    (void)machine::load_state(log, state);
    return state.settings;
}

bool store_settings(const machine::Settings& settings, hal::SimulatedStore& store)
{
    machine::StoredState state{};
    machine::SettingsLog<hal::SimulatedStore> log{store};
    const machine::LogState found = machine::load_state(log, state);
    if (found == machine::LogState::kDamaged || found == machine::LogState::kLost) {
        return true;
    }
    state.settings = settings;
    return log.append(std::as_const(state).bytes());
}

}  // namespace cusp::program_run
