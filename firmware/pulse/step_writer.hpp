// StepWriter: puts the steps of one axis into the edges of a frame, with their widths and set-up.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/base/assert.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "firmware/pulse/pulse_maker.hpp"

namespace cusp::pulse {

// The pulse tick nearest to a time in servo ticks.
inline std::int32_t to_pulse_tick(float time) noexcept
{
    return static_cast<std::int32_t>(time * static_cast<float>(kPulseTicksPerFrame) + 0.5F);
}

// Marks is an EdgeMarks of as many ticks as there are edges.
template <class Marks>
class StepWriter {
public:
    template <std::size_t N>
    StepWriter(std::array<std::uint16_t, N>& edges,
               Marks& marks,
               const StepSettings& settings,
               PulseLines line,
               std::int32_t last_rise) noexcept
        : edges_{edges.data()},
          marks_{&marks},
          pulse_{settings.pulse_us},
          delay_{settings.direction_setup_us},
          end_{static_cast<std::int32_t>(N) - pulse_},
          earliest_{last_rise + 2 * pulse_},
          raise_{line},
          lower_{static_cast<std::uint32_t>(line) << 8U}
    {
    }

    // The step that is due at `rise` comes a set-up time later, or when the last lets it.
    void add(std::int32_t rise) noexcept
    {
        rise = std::max(rise + delay_, earliest_);
        CUSP_ASSERT(rise < end_);
        edges_[rise] = static_cast<std::uint16_t>(edges_[rise] | raise_);
        edges_[rise + pulse_] = static_cast<std::uint16_t>(edges_[rise + pulse_] | lower_);
        marks_->mark(rise);
        marks_->mark(rise + pulse_);
        earliest_ = rise + 2 * pulse_;
    }
    std::int32_t last_rise() const noexcept { return earliest_ - 2 * pulse_; }

private:
    std::uint16_t* edges_;
    Marks* marks_;
    std::int32_t pulse_;
    std::int32_t delay_;
    std::int32_t end_;
    std::int32_t earliest_;
    std::uint32_t raise_;
    std::uint32_t lower_;
};

}  // namespace cusp::pulse
