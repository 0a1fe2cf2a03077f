// Map of the model's height and of its silhouettes from above, square by square: what is hidden
// below the model, gaps between silhouettes aside.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::finishing {

// The highest of samples half a square apart; a square without a sample counts as open. The model
// must outlive the map.
class SilhouetteMap {
public:
    // pitch  mm, side of the squares; larger for parts of more than 4 million squares
    SilhouetteMap(const std::vector<nurbs::Surface>& surfaces,
                  const part_model::PartModel& model,
                  double pitch);

    // The least height of the square and its eight neighbours; -kInfinite where one is open.
    double least_around(double x, double y) const;
    // The highest silhouette in the squares of a box and their neighbours; -kInfinite if none.
    // Silhouettes are borders, edges of trims, and lines where a surface turns from up to down.
    double highest_silhouette(Vec2d low, Vec2d high) const;
    // True if a point of the model straight above, by more than `by` (mm, >= 0), is found from the
    // samples around. True is certain, false is not.
    //
    // surface  the one it has to belong to; -1: any
    bool finds_over(Vec3d place, double by, int surface = -1) const;
    double pitch() const { return pitch_; }

private:
    void sample(const nurbs::Surface& whole,
                int surface,
                const nurbs::BezierPatch& patch,
                const part_model::PartModel& model);
    std::size_t square_of(Vec3d p) const;

    // The highest sample of a square.
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
