// Roots of the tick's cubic by Newton steps inside a bracket.
#include "firmware/pulse/step_times.hpp"

namespace cusp::pulse {

float crossing_time(TickCubic cubic, float level, float from, bool rising) noexcept
{
    constexpr unsigned kMostSteps = 24;
    constexpr float kCloseLevel = 1e-6F;
    float low = from;
    float high = 1.0F;
    float t = from;
    for (unsigned i = 0; i < kMostSteps; ++i) {
        const float error = cubic.at(t) - level;
        const float slope = cubic.slope_at(t);
        ((error > 0) == rising ? high : low) = t;
        const float step = slope != 0.0F ? -error / slope : 2.0F;
        if (std::fabs(error) < kCloseLevel) {
            return t;
        }
        const float next = t + step;
        if (next <= low || next >= high) {
            t = 0.5F * (low + high);
        } else {
            t = next;
            if (std::fabs(step) < kCloseTime) {
                return t;
            }
        }
        if (high - low < kCloseTime) {
            return t;
        }
    }
    return t;
}

}  // namespace cusp::pulse
