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
    // Second derivatives, too, as `SurfaceModel::evaluate`.
    SurfacePoint bends_at(double v);

private:
    struct Piece {
        const BezierCell* cell;  // null: not asked for yet
        bool bicubic;
        double per_u;  // of the cell's parameters
        double per_v;
        BezierCell::Curve4 cut;
    };
    Piece& piece_at(double v);

    const SurfaceModel& model_;
    const SurfaceModel::State& state_;
    int surface_;
    double u_;
    std::vector<Piece> pieces_;  // by spans of v
    std::size_t last_{0};        // the next place is mostly beside the last one
};

}  // namespace cusp::host
