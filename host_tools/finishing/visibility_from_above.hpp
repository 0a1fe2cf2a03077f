// Which places of a model no tool can come near from above, since other surfaces lie over them.
#pragma once

#include <array>
#include <vector>

#include "host_tools/finishing/gouge_free_path.hpp"
#include "host_tools/finishing/silhouette_map.hpp"

namespace cusp::finishing {

// A map of heights tells most; beside the model's outlines, where there may be gaps narrower than
// its squares, the model itself is asked.
class VisibilityFromAbove {
public:
    // pitch  mm, of the map
    VisibilityFromAbove(const std::vector<nurbs::Surface>& surfaces,
                        const GougeFreePathFitter& path_fitter,
                        double pitch);

    // Whether the place lies under some surface, as far as that is found. Gaps narrower than 0.02
    // mm count as closed.
    //
    //   normal  of the model there, unit, upward
    bool is_hidden(Vec3d place, Vec3d normal) const;

    // The same by more than two squares of the map are wide, but for gaps narrower than three.
    bool under_others(Vec3d place) const;

    // Whether the surface that the place belongs to is found to lie over it, too.
    bool under_itself(Vec3d place, int surface) const;

    // Whether outlines of the model run over a part of a surface, given by its corners, well above
    // it: what is hidden at all its corners may be seen between them.
    bool silhouette_above(const std::array<Vec3d, 4>& corners) const;

private:
    double roof_over(double z) const;

    const GougeFreePathFitter& path_fitter_;
    SilhouetteMap tops_;
};

}  // namespace cusp::finishing
