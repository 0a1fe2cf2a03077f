// Units of settings and reports, as Grbl has them: mm/min, and inches where asked for.
#pragma once

#include "firmware/base/inch.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

inline constexpr float kSecondsPerMinute = 60.0F;
inline constexpr float kMillimetresPerInch = static_cast<float>(cusp::kMillimetresPerInch);

// How `settings` want places told.
inline protocol::PlaceForm place_form(const Settings& settings) noexcept
{
    return {settings.on(Setting::kReportInches), settings.axes()};
}

}  // namespace cusp::machine
