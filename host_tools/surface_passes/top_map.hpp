// How high the model reaches, seen from above, square by square, and where its outlines run: what
// lies under it can't be seen, but through gaps between those.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/surface_offset/surface_model.hpp"

namespace cusp::host {

// Highest samples, two a square each way; a square that no sample falls into counts as open.
class TopMap {
public:
    // pitch  mm, side of the squares; made larger for parts of more than some million squares
    TopMap(const std::vector<Surface>& surfaces, const SurfaceModel& model, double pitch);

    // The least of the square and its eight neighbours.
    double least_around(double x, double y) const;
    // The highest outline in the squares of a box, and in those beside it: borders, edges of trims,
    // and where a surface turns from facing up to facing down. None: -infinity.
    double highest_outline(Vec2d low, Vec2d high) const;
    // Height of the tip of a ball that rests on the samples.
    double drop(double x, double y, double radius) const;
    double pitch() const { return pitch_; }

private:
    void sample(const Surface& whole,
                int surface,
                const BezierPatch& patch,
                const SurfaceModel& model);
    std::size_t square_of(Vec3d p) const;

    double pitch_;
    double x0_;
    double y0_;
    std::size_t nx_;
    std::size_t ny_;
    std::vector<double> top_;
    std::vector<double> outline_;
};

}  // namespace cusp::host
