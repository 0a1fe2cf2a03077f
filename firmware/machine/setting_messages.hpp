// Messages that say why a setting is refused.
#pragma once

#include <cstdint>

#include "firmware/machine/settings.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

// The range of a setting that Grbl does not have, and so no sender knows; nothing of another.
void tell_range(std::uint32_t number, float value, protocol::ReplyQueue& out) noexcept;

// Both settings of the fault by number and value, and what they come to.
void tell_fault(const SettingFault& fault, protocol::ReplyQueue& out) noexcept;

}  // namespace cusp::machine
