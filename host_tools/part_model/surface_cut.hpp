// A surface over one u: places of the same u follow each other quickly.
#pragma once

#include <vector>

#include "host_tools/part_model/bezier_cell.hpp"
#include "host_tools/part_model/part_model.hpp"

namespace cusp::part_model {

class SurfaceCut {
public:
    SurfaceCut(const PartModel& model, const PartModel::State& state, int surface, double u);

    // Point and first derivatives by u and v, as `PartModel::tangents`.
    nurbs::SurfacePoint at(double v);
    // Second derivatives, too, as `PartModel::evaluate`.
    nurbs::SurfacePoint bends_at(double v);

private:
    struct Piece {
        const BezierCell* cell;  // null: not asked for yet
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
    std::size_t last_{0};        // the next place is mostly beside the last one
};

}  // namespace cusp::part_model
