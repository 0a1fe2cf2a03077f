// A surface at one u: quick evaluation at many v.
#pragma once

#include <vector>

#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::part_model {

// Refers to cells of the model: invalid after PartModel::forget_cells().
class SurfaceCut {
public:
    SurfaceCut(const PartModel& model, const PartModel::State& state, int surface, double u);

    // Point and first derivatives by u and v, as `PartModel::tangents`.
    nurbs::SurfacePoint at(double v);
    // Second derivatives as well, as `PartModel::evaluate`.
    nurbs::SurfacePoint bends_at(double v);

private:
    struct Piece {
        const BezierCell* cell;  // null: not queried yet
        bool bicubic;
        double per_u;  // of the cell's parameters
        double per_v;
        BezierCell::Curve4 cut;
    };
    Piece& piece_at(double v);

    const PartModel& model_;
    const PartModel::State& state_;
    int surface_;
    double u_;
    std::vector<Piece> pieces_;  // by spans of v
    std::size_t last_{0};        // the piece of the last query
};

}  // namespace cusp::part_model
