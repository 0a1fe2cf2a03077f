// Enumerations: `$ES`, `$EG`, `$EE` and `$EA` tell a sender what settings, errors and alarms there are, in
// grblHAL's words, so that it need not know them. Source: ioSender's and gSender's readers of these lines.
#pragma once

#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

// Each writes line `index`. Returns false, and writes nothing, behind the last. `axes`: of the machine, X first;
// nothing is written for others.
bool write_setting_description(unsigned index, unsigned axes, protocol::ReplyQueue& out) noexcept;
bool write_setting_group(unsigned index, unsigned axes, protocol::ReplyQueue& out) noexcept;
bool write_error_code(unsigned index, protocol::ReplyQueue& out) noexcept;
bool write_alarm_code(unsigned index, protocol::ReplyQueue& out) noexcept;

}  // namespace cusp::machine
