// One tick of an input shaper. Apart from the tick without one, which is not to pay for it.
#include "firmware/interpolator/shaper_filter.hpp"

namespace cusp::interpolator {

PathOffset ShaperFilter::add(PathOffset value) noexcept
{
    if (value == PathOffset{}) {
        left_ -= left_ > 0 ? 1U : 0U;
        if (left_ == 0) {
            return {};
        }
    } else {
        left_ = shaper_.ticks + 1;
    }
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < shaper_.stages.size(); ++i) {
        value = pass(shaper_.stages[i], stages_[i], begin, value);
        begin += shaper_.stages[i].ticks + 1;
    }
    return value;
}

PathOffset ShaperFilter::pass(const planner::ShaperStage& stage,
                              Running& running,
                              std::uint32_t begin,
                              PathOffset value) noexcept
{
    const std::uint32_t after = running.next == stage.ticks ? 0 : running.next + 1;
    PathOffset& oldest = values_[begin + running.next];
    const PathOffset later = values_[begin + after];
    PathOffset shaped;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const std::int64_t sum = std::int64_t{stage.now} * value[i] +
                                 std::int64_t{stage.later} * later[i] +
                                 std::int64_t{stage.last} * oldest[i] + running.remainder[i];
        shaped[i] = static_cast<std::int32_t>(sum >> planner::kShaperBits);
        constexpr std::int64_t kRest = (std::int64_t{1} << planner::kShaperBits) - 1;
        running.remainder[i] = static_cast<std::int32_t>(sum & kRest);
    }
    oldest = value;
    running.next = after;
    return shaped;
}

}  // namespace cusp::interpolator
