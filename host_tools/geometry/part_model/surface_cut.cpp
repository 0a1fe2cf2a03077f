// Bicubic cells are reduced to curves of v when first queried.
#include "host_tools/geometry/part_model/surface_cut.hpp"

#include <algorithm>

#include "host_tools/geometry/part_model/nearest_search.hpp"

namespace cusp::part_model {

using nurbs::SurfacePoint;

SurfaceCut::SurfaceCut(const PartModel& model, const PartModel::State& state, int surface, double u)
    : model_{model},
      state_{state},
      surface_{surface},
      u_{u},
      pieces_(state.grids[static_cast<std::size_t>(surface)].v.size(),
              Piece{nullptr, false, 0, 0, {}})
{
}

SurfaceCut::Piece& SurfaceCut::piece_at(double v)
{
    const BezierCell* beside = pieces_[last_].cell;
    if (beside != nullptr && v >= beside->v_begin() && v <= beside->v_end()) {
        return pieces_[last_];
    }
    const BezierCell& cell = state_.cell_at(surface_, u_, v);
    last_ = state_.history().last_v;
    Piece& piece = pieces_[last_];
    if (piece.cell == nullptr) {
        piece.cell = &cell;
        piece.per_u = 1 / (cell.u_end() - cell.u_begin());
        piece.per_v = 1 / (cell.v_end() - cell.v_begin());
        piece.bicubic =
            cell.cut_at(std::clamp((u_ - cell.u_begin()) * piece.per_u, 0.0, 1.0), piece.cut);
    }
    return piece;
}

SurfacePoint SurfaceCut::at(double v)
{
    const Piece& piece = piece_at(v);
    if (!piece.bicubic) {
        return model_.tangents(surface_, u_, v);
    }
    const double share = (v - piece.cell->v_begin()) * piece.per_v;
    SurfacePoint p = BezierCell::on_cut(piece.cut, std::clamp(share, 0.0, 1.0));
    p.du = p.du * piece.per_u;
    p.dv = p.dv * piece.per_v;
    return p;
}

SurfacePoint SurfaceCut::bends_at(double v)
{
    const Piece& piece = piece_at(v);
    if (!piece.bicubic) {
        return model_.evaluate(surface_, u_, v);
    }
    const double share = (v - piece.cell->v_begin()) * piece.per_v;
    SurfacePoint p = BezierCell::bends_on_cut(piece.cut, std::clamp(share, 0.0, 1.0));
    p.du = p.du * piece.per_u;
    p.dv = p.dv * piece.per_v;
    p.duu = p.duu * (piece.per_u * piece.per_u);
    p.duv = p.duv * (piece.per_u * piece.per_v);
    p.dvv = p.dvv * (piece.per_v * piece.per_v);
    return p;
}

}  // namespace cusp::part_model
