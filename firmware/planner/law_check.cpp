// The law's rows at the path's own places.
#include "firmware/planner/law_check.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/planner/law_rows.hpp"

namespace cusp::planner {
namespace {

constexpr int kCheckedPlaces = 8;  // of a cell

}  // namespace

float greatest_use(const TimeLaw& law,
                   const LawPath& path,
                   PathCursor& cursor,
                   const MachineLimits& limits) noexcept
{
    const LaneVec inverse_jerk = quotient(all_lanes(1.0F), to_lanes(limits.jerk));
    const LaneVec ratio = quotient(to_lanes(limits.jerk), to_lanes(limits.acceleration));
    float most = 0;
    for (std::uint32_t k = law.first_cell(); k < law.end_cell(); ++k) {
        const Station& station = law.station(k);
        const SquaredSpeed start = law.cell(k).start;
        KeptShares kept = station.kept;
        kept.bend = all_lanes(0.0F);
        kept.bend_acceleration = kept.bend;
        for (int i = 0; i < kCheckedPlaces; ++i) {
            const float part = (static_cast<float>(i) + 0.5F) / kCheckedPlaces;
            const std::int64_t at = station.begin + static_cast<std::int64_t>(
                                                        part * static_cast<float>(station.travel));
            path.seek(cursor, at);
            const LaneDerivatives place = path.derivatives(cursor, at);
            const LaneDerivatives q{product(place.first, inverse_jerk),
                                    product(place.second, inverse_jerk),
                                    product(place.third, inverse_jerk)};
            const SquaredSpeed x = advanced(start, part * station.length);
            const float root = std::sqrt(x.value);
            most = std::max(most, use(jerk_row(q, kept, x, root)));
            most = std::max(most, use(acceleration_row(q, kept, ratio, x, root)));
        }
    }
    return most;
}

}  // namespace cusp::planner
