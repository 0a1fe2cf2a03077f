// Which points of a model are hidden from above by surfaces over them, so that no tool reaches
// them.
#pragma once

#include <array>
#include <vector>

#include "host_tools/cam/finishing/gouge_free_path.hpp"
#include "host_tools/cam/finishing/silhouette_map.hpp"

namespace cusp::finishing {

// A map of heights decides most points. If it only seems to cover a point, in steep grooves and in
// gaps narrower than its squares, the model itself decides.
class VisibilityFromAbove {
public:
    // pitch  mm, of the map
    VisibilityFromAbove(const std::vector<nurbs::Surface>& surfaces,
                        const GougeFreePathFitter& path_fitter,
                        double pitch);

    // True if the point lies under some surface. Gaps narrower than 0.02 mm count as closed. True
    // is certain but for these; some hidden points are missed.
    //
    // normal  of the model there, a unit vector, upward
    bool is_hidden(Vec3d place, Vec3d normal) const;

    // True if some surface lies over the point, and by more than two squares of the map over all points
    // around. Gaps narrower than three squares count as closed.
    bool under_others(Vec3d place) const;

    // True if the surface of the point is found to lie over it as well.
    bool under_itself(Vec3d place, int surface) const;

    // True if silhouettes cross a part of a surface, given by its corners, well above it: then it
    // may be visible between hidden corners.
    bool silhouette_above(const std::array<Vec3d, 4>& corners) const;

private:
    bool may_be_under_others(Vec3d place) const;
    double hiding_height(double z) const;

    const GougeFreePathFitter& path_fitter_;
    SilhouetteMap tops_;
};

}  // namespace cusp::finishing
