// ShaperFilter: the stages of an input shaper, in exact integers. All that goes in comes out, to
// the last unit, once the filter is drained.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/path_units.hpp"
#include "firmware/planner/input_shaper.hpp"

namespace cusp::interpolator {

// Context: servo tick, but for reset(): main loop.
class ShaperFilter {
public:
    explicit ShaperFilter(const planner::InputShaper& shaper) noexcept : shaper_{shaper} {}

    // The shaper has another form, or what is in it is discarded.
    // Precondition: its length is at most planner::kMostShaperTicks.
    void reset() noexcept
    {
        values_.fill({});
        stages_ = {};
        left_ = 0;
    }

    bool on() const noexcept { return shaper_.on(); }
    // True if nothing is in it: what comes out next is what goes in.
    bool drained() const noexcept { return left_ <= 1; }

    // The shaped value of this tick: each stage sums up its taps, the remainder of the
    // division kept for the next tick.
    // Never inline: without a shaper the tick does not pay for its registers.
    [[gnu::noinline]] PathOffset add(PathOffset value) noexcept;

private:
    static constexpr std::int32_t kHalf = 1 << (planner::kShaperBits - 1);
    struct Running {
        std::uint32_t next{0};  // place of the oldest value, n + 1 ticks ago
        PathOffset remainder{kHalf, kHalf, kHalf};
    };

    // The values of a stage lie from `begin` on: n + 1 of them, in a circle.
    PathOffset pass(const planner::ShaperStage& stage,
                    Running& running,
                    std::uint32_t begin,
                    PathOffset value) noexcept;

    const planner::InputShaper& shaper_;
    std::array<PathOffset, planner::kMostShaperTicks> values_{};
    std::array<Running, planner::kMostShaperStages> stages_{};
    std::uint32_t left_{0};  // ticks until drained, if only zeros follow
};

}  // namespace cusp::interpolator
