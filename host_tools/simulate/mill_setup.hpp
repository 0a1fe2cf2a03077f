// What the virtual mill is like, given the settings of its controller.
#pragma once

#include <optional>

#include "firmware/machine/settings.hpp"
#include "hal/sim/simulated_mill.hpp"
#include "hal/sim/simulated_store.hpp"

namespace cusp::host {

// A mill whose travel and steps are those of the settings. At power-up the tool stands a sixth of
// each travel from the end that it homes to.
//
//   probe_z  height of the probe plate over that place, mm; none: no plate
hal::MillGeometry mill_geometry(const machine::Settings& settings, std::optional<double> probe_z);

// What the store holds; the defaults where it holds nothing good.
machine::Settings stored_settings(const hal::SimulatedStore& store);

// Puts settings into the store as the firmware does; offsets and texts in it stay. A store that is
// damaged is left to the firmware, which tells of it. Returns false where the store fails.
bool store_settings(const machine::Settings& settings, hal::SimulatedStore& store);

}  // namespace cusp::host
