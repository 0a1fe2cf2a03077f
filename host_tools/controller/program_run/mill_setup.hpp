// The virtual mill that matches the settings of its controller.
#pragma once

#include <optional>

#include "firmware/machine/settings.hpp"
#include "hal/sim/simulated_mill.hpp"
#include "hal/sim/simulated_store.hpp"

namespace cusp::program_run {

// Tool position at power-up: this fraction of each travel from the end to which it homes. `cusp sim` homes at once; a
// sender may move in either direction from there.
constexpr double kNearHome = 1.0 / 6.0;
constexpr double kAmidTravel = 0.4;

// A mill whose travel and steps are those of the settings.
//
//   probe_z         height of the probe plate above the position at power-up, mm; no value: no plate
//   part_from_home  fraction of each travel, 0 to 1
hal::MillGeometry mill_geometry(const machine::Settings& settings,
                                std::optional<double> probe_z,
                                double part_from_home);

// The stored settings; the defaults where there are none or the store is damaged.
machine::Settings stored_settings(const hal::SimulatedStore& store);

// Writes settings to the store as the firmware does; offsets and texts in it are kept. A damaged store is left to the
// firmware, which reports it. Returns false where the store fails.
bool store_settings(const machine::Settings& settings, hal::SimulatedStore& store);

}  // namespace cusp::program_run
