// How high the model reaches, seen from above, square by square, and where its outlines run: what
// lies under it can't be seen, but through gaps between those.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/part_model/part_model.hpp"

namespace cusp::finishing {

// Highest samples, two a square each way; a square that no sample falls into counts as open.
//
// The model must outlive it.
class SilhouetteMap {
public:
    // pitch  mm, side of the squares; made larger for parts of more than some million squares
    SilhouetteMap(const std::vector<nurbs::Surface>& surfaces,
                  const part_model::PartModel& model,
                  double pitch);

    // The least of the square and its eight neighbours.
    double least_around(double x, double y) const;
    // The highest outline in the squares of a box, and in those beside it: borders, edges of trims,
    // and where a surface turns from facing up to facing down. None: -infinity.
    double highest_silhouette(Vec2d low, Vec2d high) const;
    // Whether a place of the model straight over this one, higher by more than `by` (mm, at least
    // 0), is found from the samples around it. Never where there is none.
    //
    // surface  that it has to belong to; -1: any
    bool finds_over(Vec3d place, double by, int surface = -1) const;
    double pitch() const { return pitch_; }

private:
    void sample(const nurbs::Surface& whole,
                int surface,
                const nurbs::BezierPatch& patch,
                const part_model::PartModel& model);
    std::size_t square_of(Vec3d p) const;

    // Where the highest sample of a square is.
    struct Place {
        float u, v;
        int surface;
    };

    const part_model::PartModel& model_;
    double pitch_;
    double x0_;
    double y0_;
    std::size_t nx_;
    std::size_t ny_;
    std::vector<double> top_;
    std::vector<Place> places_;
    std::vector<double> silhouette_;
};

}  // namespace cusp::finishing
