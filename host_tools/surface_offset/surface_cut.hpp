// A surface over one u: places of the same u follow each other quickly.
#pragma once

#include <vector>

#include "host_tools/surface_offset/bezier_cell.hpp"
#include "host_tools/surface_offset/surface_model.hpp"

namespace cusp::host {

class SurfaceCut {
public:
    SurfaceCut(const SurfaceModel& model, const SurfaceModel::State& state, int surface, double u);

    // Point and first derivatives by u and v, as `SurfaceModel::tangents`.
    SurfacePoint at(double v);

private:
    struct Piece {
        const BezierCell* cell;  // null: not asked for yet
        bool bicubic;
        BezierCell::Curve4 cut;
    };

    const SurfaceModel& model_;
    const SurfaceModel::State& state_;
    int surface_;
    double u_;
    std::vector<Piece> pieces_;  // by spans of v
};

}  // namespace cusp::host
