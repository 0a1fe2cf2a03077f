// Bicubic cells are reduced to curves of v when a place of theirs is first asked for.
#include "host_tools/surface_offset/surface_cut.hpp"

#include <algorithm>

#include "host_tools/surface_offset/nearest_search.hpp"

namespace cusp::host {

SurfaceCut::SurfaceCut(const SurfaceModel& model,
                       const SurfaceModel::State& state,
                       int surface,
                       double u)
    : model_{model},
      state_{state},
      surface_{surface},
      u_{u},
      pieces_(state.grids[static_cast<std::size_t>(surface)].v.size(), Piece{nullptr, false, {}})
{
}

SurfacePoint SurfaceCut::at(double v)
{
    const BezierCell& cell = state_.cell_at(surface_, u_, v);
    Piece& piece = pieces_[state_.grids[static_cast<std::size_t>(surface_)].last_v];
    if (piece.cell == nullptr) {
        const double share = (u_ - cell.u_begin()) / (cell.u_end() - cell.u_begin());
        piece.cell = &cell;
        piece.bicubic = cell.cut_at(std::clamp(share, 0.0, 1.0), piece.cut);
    }
    if (!piece.bicubic) {
        return model_.tangents(surface_, u_, v);
    }
    const double width_v = cell.v_end() - cell.v_begin();
    SurfacePoint p =
        BezierCell::on_cut(piece.cut, std::clamp((v - cell.v_begin()) / width_v, 0.0, 1.0));
    p.du = p.du / (cell.u_end() - cell.u_begin());
    p.dv = p.dv / width_v;
    return p;
}

}  // namespace cusp::host
