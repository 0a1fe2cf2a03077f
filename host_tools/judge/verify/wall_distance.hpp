// Signed distance in plan of a point from the wall along a loop.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/job/job/job.hpp"

namespace cusp::verify {

inline constexpr double kWallChord = 1e-4;  // mm: of a wall's curves

class WallDistance {
public:
    // outer  true: a boundary, the tool stays inside; false: an island, it stays outside
    // cap    mm: distances beyond it may be inexact
    WallDistance(const job::Loop& loop, bool outer, double cap);

    // Negative on the wrong side of the wall; within [-cap, cap]. Accuracy 1e-4 mm, that of the
    // loop's chords.
    double at(double x, double y) const;

private:
    struct Segment {
        Vec2d a, b;
    };
    const std::vector<std::size_t>& bucket(std::size_t i, std::size_t j) const
    {
        return buckets_[i * ny_ + j];
    }
    bool encloses(double x, double y) const;

    std::vector<Segment> segments_;
    bool outer_;
    double cap_;
    double x0_, y0_;
    std::size_t nx_, ny_;
    // squares of side cap_: segments that touch them
    std::vector<std::vector<std::size_t>> buckets_;
    std::vector<std::vector<std::size_t>> levels_;  // strips of y: segments that cross them
    double level_height_;
};

}  // namespace cusp::verify
