// What the virtual mill is like, given the settings of its controller.
#pragma once

#include <optional>

#include "firmware/machine/settings.hpp"
#include "hal/sim/simulated_mill.hpp"
#include "hal/sim/simulated_store.hpp"

namespace cusp::program_run {

// Where the tool stands at power-up: this part of each travel from the end that it homes to. A
// program that is run as fast as it goes homes at once; a sender's may go either way from there.
constexpr double kNearHome = 1.0 / 6.0;
constexpr double kAmidTravel = 0.4;

// A mill whose travel and steps are those of the settings.
//
//   probe_z         height of the probe plate over the place at power-up, mm; none: no plate
//   part_from_home  of each travel, 0 to 1
hal::MillGeometry mill_geometry(const machine::Settings& settings,
                                std::optional<double> probe_z,
                                double part_from_home);

// What the store holds; the defaults where it holds nothing good.
machine::Settings stored_settings(const hal::SimulatedStore& store);

// Puts settings into the store as the firmware does; offsets and texts in it stay. A store that is
// damaged is left to the firmware, which tells of it. Returns false where the store fails.
bool store_settings(const machine::Settings& settings, hal::SimulatedStore& store);

}  // namespace cusp::program_run
