// The changes that an input shaper makes to the planner: see docs/numerics.md, "Input shaping".
#include "firmware/base/assert.hpp"
#include "firmware/planner/planner.hpp"

namespace cusp::planner {

void Planner::set_shaper(const InputShaper& shaper) noexcept
{
    CUSP_ASSERT(empty() && shaper.ticks <= kMostShaperTicks);
    shaper_ = shaper;
    law_.set_shaper(shaper);
    blender_.set_shaper(shaper.square, shaper.length);
}

}  // namespace cusp::planner
