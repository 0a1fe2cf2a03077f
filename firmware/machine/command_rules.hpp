// Which '$' commands a state allows, as in Grbl.
#pragma once

#include "firmware/machine/machine_state.hpp"
#include "firmware/protocol/system_command.hpp"

namespace cusp::machine {

bool allows(State state, protocol::SystemCommandKind kind) noexcept;

}  // namespace cusp::machine
