// PathVertices: the vertices of the drawn path, as ticks, each with the coarsest level of detail that
// contains it.
//
// Douglas-Peucker splitting of position and speed, one stretch at a time. The deviation of a chord is
// the significance of the tick at which it is split.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/judge/view/byte_text.hpp"

namespace cusp::view {

class PathVertices {
public:
    // Deviation of chords from the path at level 0, mm; four times more at each further level.
    static constexpr double kFinest = 0.001;
    static constexpr unsigned kLevels = 10;

    // The set point of the next tick.
    //
    //   deviation  mm from the programmed path
    //   corner     a vertex of all levels: start or end of a rapid move, or a tool change
    void add(Position at, double deviation, bool corner);

    // Format: u32 vertices; then for each its distance in ticks from the previous one (varint);
    // levels, u8; the greatest deviation since the previous vertex in 10 nm, u16.
    Bytes finish();

private:
    struct Point {
        std::array<double, 4> at;  // mm; the speed is scaled so that 1 mm/s equals kFinest
    };
    struct Stretch {
        std::size_t begin;
        std::size_t end;
        double max_deviation;
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
