// Facets steeper than 87 degrees: the stock left over them and beside them, and passes along them.
#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"
#include "host_tools/geometry/part_model/facet_distance.hpp"

namespace cusp::finishing {

using part_model::Facet;

// True if the facet is so steep that nothing thicker than the scallop would fit between it and a
// vertical line if it were as high as the model. Less than that would not do: the facets under it
// lean out farther, and the tool passes at their foot.
bool MeshScallopCheck::is_upright(Vec3d normal) const
{
    const double height = path_fitter_.model().box_high().z - path_fitter_.model().box_low().z;
    return normal.z < kLevelFacet ||
           (normal.z < kUprightNormal && height * normal.z <= kPlaceShare * scallop_);
}

// On a steep wall rounding may raise the wall itself over the point.
bool MeshScallopCheck::is_hidden(const MeshPlace& at) const
{
    if (at.normal.z >= kUprightNormal) {
        return is_hidden(at.point);
    }
    const auto top = path_fitter_.model().height_at(at.point.x, at.point.y);
    return top && top->point.z > at.point.z + std::max(kHidden, kHiddenBeside / at.normal.z);
}

// A cell is proved by one move. If the stock is high but thin, its corners represent it.
MeshScallopCheck::Verdict MeshScallopCheck::judge_steep(const Cell& cell, double longest) const
{
    const Vec3d middle = raised(cell.middle(), cell.normal, scallop_, false);
    places_.swept().near_or_below(
        centre_under(middle, cell.normal, scallop_, path_fitter_.tool().radius), near_);
    for (const std::uint32_t move : near_) {
        if (std::all_of(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
                return places_.swept().removes(move, raised(corner, cell.normal, scallop_, false),
                                               path_off_);
            })) {
            return Verdict::kCovered;
        }
    }
    std::array<MeshPlace, 4> places;
    for (std::size_t k = 0; k < 3; ++k) {
        places[k] = {cell.corners[k], cell.normal};
    }
    places[3] = {cell.middle(), cell.normal};
    const auto hidden = [&](const MeshPlace& place) {
        return is_hidden(place);
    };
    if (longest >= kBlockedCell * step()) {
        return longest < step() && std::all_of(places.begin(), places.end(), hidden)
                   ? Verdict::kCovered
                   : Verdict::kHalve;
    }
    bool clear = true;
    bool covered = true;
    for (const MeshPlace& place : places) {
        if (!places_.is_wall_cut(place.point, place.normal, kPlaceShare) && !is_hidden(place)) {
            covered = false;
            clear = clear && path_fitter_.is_clear(places_.touching_tip(place.point, place.normal));
        }
    }
    if (covered) {
        return Verdict::kCovered;
    }
    if (clear) {
        return Verdict::kUncovered;
    }
    return may_be_uncovered(cell) ? Verdict::kBlocked : Verdict::kSettled;
}

// The missing tips along a wall at the height of a point on it, both ways. If the wall turns, the
// next point returns to that height.
Points MeshScallopCheck::trace_level(const MeshPlace& from) const
{
    const part_model::PartModel& model = path_fitter_.model();
    const auto on_wall = [&](std::optional<MeshPlace> at) {
        return at && at->normal.z < kUprightNormal ? at : std::nullopt;
    };
    return traced(
        from, [&](const MeshPlace& at) { return missing_tip(at); },
        [&](const MeshPlace& last, Vec3d /*tip*/, double way) {
            const std::optional<MeshPlace> at = on_wall(place_on_mesh(
                model, last.point + level_along(last.normal) * (way * kTraceStep * step())));
            if (!at) {
                return at;
            }
            const Vec3d n = at->normal;
            const double back = (at->point.z - from.point.z) * n.z / (n.x * n.x + n.y * n.y);
            return on_wall(place_on_mesh(model, at->point + Vec3d{n.x, n.y, 0} * back));
        });
}

std::vector<WallFacet> MeshScallopCheck::vertical_facets() const
{
    std::vector<WallFacet> out;
    for (const auto& corners : triangles_) {
        const Facet facet{corners};
        if (is_upright(facet.normal)) {
            out.push_back({{corners.begin(), corners.end()}, facet.normal});
        }
    }
    return out;
}

}  // namespace cusp::finishing
