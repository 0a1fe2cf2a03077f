// Bounds of what a plan takes of the axes, for the tick to slow its time down.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/planner/station.hpp"

namespace cusp::planner {

// Bounds as a plan keeps them: each is no less than what it stands for, within a part in 100.
struct PackedBounds {
    PackedBounds() noexcept = default;
    explicit PackedBounds(const WarpBounds& bounds) noexcept;
    WarpBounds unpacked() const noexcept;

private:
    PerAxis<std::uint16_t> speed_{};  // the upper half of a float
    std::uint16_t time_{0};           // the same
    PerAxis<std::int8_t> braking_{};  // parts of a plan's share
    PerAxis<std::int8_t> speeding_{};
    PerAxis<std::int16_t> falling_{};  // parts of 2^14: what is left may be little
    PerAxis<std::int16_t> rising_{};
    PerAxis<std::int16_t> joint_{};
};

// Over a cell that begins in a state.
//
//   ratio  jerk over acceleration of each axis, 1/s.
WarpBounds bounds_of_cell(const Station& station,
                          const SquaredSpeed& start,
                          const LaneVec& ratio) noexcept;

// Over an element from or to rest at its inner end.
//
//   place    of the station at the inner end: its number there.
//   squared  speed at the inner end.
WarpBounds bounds_of_element(const Station& station,
                             unsigned place,
                             float squared,
                             const StopElement& element,
                             bool starts,
                             const LaneVec& ratio) noexcept;

// Over the way from a crawl to rest, of a time.
WarpBounds bounds_of_crawl(float squared, float time, const LaneVec& inverse_acceleration) noexcept;

}  // namespace cusp::planner
