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
    struct Box {
        Vec2d low, high;
    };
    void add_boxes();
    void approach(Vec2d p, std::size_t level, std::size_t box, double& square) const;
    bool encloses(double x, double y) const;

    std::vector<Segment> segments_;
    // round some segments behind each other, then round as many of these boxes, up to one round all
    std::vector<std::vector<Box>> boxes_;
    bool outer_;
    double cap_;
    std::vector<std::vector<std::size_t>> levels_;  // strips of y: segments that cross them
    double y0_;                                     // of the first
    double level_height_;
};

}  // namespace cusp::verify
