// Hermite quintics over a chord.
#include "firmware/planner/quintic.hpp"

#include <algorithm>

namespace cusp::planner {
path::Quintic hermite(AxisVecf chord, const PathEnd& from, const PathEnd& to, float length) noexcept
{
    // The part that the ends add to a straight line: computed by itself, so that nothing cancels.
    const AxisVecf e0 = from.tangent * length - chord;
    const AxisVecf e1 = to.tangent * length - chord;
    const AxisVecf w0 = from.curvature * (0.5F * length * length);
    const AxisVecf w1 = to.curvature * (0.5F * length * length);
    const AxisVecf a3 = e0 * -6.0F - e1 * 4.0F - w0 * 3.0F + w1;
    const AxisVecf a4 = e0 * 8.0F + e1 * 7.0F + w0 * 3.0F - w1 * 2.0F;
    const AxisVecf a5 = (e0 + e1) * -3.0F - w0 + w1;
    const AxisVecf q3 = -a5;
    const AxisVecf q2 = q3 - a4;
    const AxisVecf q1 = q2 - a3;
    return {{{e0, q1, q2, q3}}, length, false};
}

bool make_quintic(AxisVecf chord,
                  const PathEnd& from,
                  const PathEnd& to,
                  float error,
                  path::Quintic& piece) noexcept
{
    constexpr unsigned kTries = 3;
    float length = norm(chord);
    for (unsigned i = 0; i < kTries; ++i) {
        piece = hermite(chord, from, to, length);
        const LaneQuintic lanes = lane_quintic(piece.bulge, chord);
        const float a = norm(slope_at(lanes, 0.25F));
        const float m = norm(slope_at(lanes, 0.5F));
        const float b = norm(slope_at(lanes, 0.75F));
        const float fastest = std::max({a, m, b});
        const float slowest = std::min({a, m, b});
        if (fastest <= (1.0F + error) * length && slowest >= (1.0F - error) * length) {
            return true;
        }
        // Boole's rule.
        length = (14.0F * length + 32.0F * (a + b) + 12.0F * m) / 90.0F;
    }
    return false;
}

}  // namespace cusp::planner
