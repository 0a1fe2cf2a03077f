// PathVertices: the ticks at which a drawn path has its corners, each with the coarsest drawing that
// still needs it.
//
// Douglas and Peucker's splitting over position and speed, a stretch at a time: what a chord misses by
// is the significance of the tick that it is split at.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/view/byte_text.hpp"

namespace cusp::view {

class PathVertices {
public:
    // Chords of level 0 miss the path by this, mm; those of each further level by four times more.
    static constexpr double kFinest = 0.001;
    static constexpr unsigned kLevels = 10;

    // The set point of the next tick.
    //
    //   deviation  mm from the programmed path
    //   corner     of all levels: here a rapid move begins or ends, or another tool
    void add(Position at, double deviation, bool corner);

    // The bytes: u32 vertices; then for each its distance in ticks from the one before (varint);
    // levels, u8; the greatest deviation since the vertex before in 10 nm, u16.
    Bytes finish();

private:
    struct Point {
        std::array<double, 4> at;  // mm; speed so that 1 mm/s counts as kFinest
    };
    struct Stretch {
        std::size_t begin;
        std::size_t end;
        double most;
    };
    void end_stretch();
    void split(Stretch whole);
    void put(std::size_t tick_of_stretch, unsigned level);

    std::vector<Point> points_;
    std::vector<double> deviations_;
    std::vector<std::uint8_t> levels_;  // of points; kNone: no vertex
    std::vector<Stretch> open_;
    std::uint64_t first_tick_{0};  // of the stretch
    std::uint64_t last_vertex_{0};
    std::uint64_t count_{0};
    Bytes ticks_;
    Bytes level_bytes_;
    Bytes deviation_bytes_;
};

}  // namespace cusp::view
