// The changes that an input shaper makes to the planner: see docs/numerics.md, "Input shaping".
#include <cmath>

#include "firmware/base/assert.hpp"
#include "firmware/planner/planner.hpp"

namespace cusp::planner {

// Duration of the response of axis filters and shaper to a jump, s.
float Planner::window_of(AxisFilter filter) const noexcept
{
    return static_cast<float>(filter.first + filter.second) * kServoTick + shaper_.length;
}

void Planner::set_shaper(const InputShaper& shaper) noexcept
{
    CUSP_ASSERT(empty() && shaper.ticks <= kMostShaperTicks);
    shaper_ = shaper;
    blender_.set_shaper(shaper.square, shaper.length);
}

// The shaper leaves a bend by what the tool travels around it, not only in it: what it may be passed
// at holds for one window on both sides of the end of the path so far.
void Planner::spread_bend(const Vec3f& curvature) noexcept
{
    const float bend = norm(curvature);
    if (shaper_.on() && bend > 0) {
        builder_.add_junction({std::sqrt(choice_.centripetal / bend), 0, 0, 0}, 0.0F);
    }
}

}  // namespace cusp::planner
