// How high the model reaches, seen from above, square by square: what lies under it can't be seen.
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
    // Height of the tip of a ball that rests on the samples.
    double drop(double x, double y, double radius) const;
    double pitch() const { return pitch_; }

private:
    double pitch_;
    double x0_;
    double y0_;
    std::size_t nx_;
    std::size_t ny_;
    std::vector<double> top_;
};

}  // namespace cusp::host
