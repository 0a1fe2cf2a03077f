// `LowestPositionSearch` with drops of the tool that passes are planned with. The position found is
// dropped exactly.
#include "host_tools/cam/finishing/reachable_height.hpp"

#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::finishing {

using drop_cutter::LowestPositionSearch;
using nurbs::Surface;
using part_model::EdgeGougeCheck;

namespace {

// Distances from the brink of a cliff.
constexpr double kLeastOffBrink = 5e-4;  // mm
constexpr double kMostOffBrink = 0.1;    // of the pitch
constexpr int kWays = 8;

constexpr std::size_t kMostShared = 300'000;  // drops: 26 MB, and those of one copy more

}  // namespace

ReachableHeight::ReachableHeight(const std::vector<Surface>& surfaces,
                                 const GougeFreePathFitter& path_fitter,
                                 double pitch,
                                 double accuracy)
    : surfaces_{surfaces},
      path_fitter_{path_fitter},
      accuracy_{accuracy},
      radius_{path_fitter.tool().radius},
      contact_radius_{radius_ + path_fitter.band().offset},
      search_{path_fitter.tool(), path_fitter.band().offset, pitch, 3 * accuracy,
              [this](double x, double y) {
                  return drop_at(x, y, Edges::kIgnored);
              }},
      search_clear_of_edges_{path_fitter.tool(), path_fitter.band().offset, pitch, 3 * accuracy,
                             [this](double x, double y) {
                                 return drop_at(x, y, Edges::kMovedClear);
                             }}
{
    use(std::make_shared<Drops>());
}

ReachableHeight::ReachableHeight(const ReachableHeight& other)
    : ReachableHeight{other.surfaces_, other.path_fitter_, other.search_.pitch(), other.accuracy_}
{
    shared_floor_ = other.shared_floor_;
    use(other.shared_drops_);
}

void ReachableHeight::use(std::shared_ptr<Drops> drops)
{
    shared_drops_ = std::move(drops);
    search_.use(&shared_drops_->any);
    search_clear_of_edges_.use(&shared_drops_->clear_of_edges);
}

void ReachableHeight::begin_with(Drops drops)
{
    search_.begin_with(std::move(drops.any));
    search_clear_of_edges_.begin_with(std::move(drops.clear_of_edges));
}

void ReachableHeight::share(Drops drops)
{
    if (shared_drops_->any.size() + shared_drops_->clear_of_edges.size() < kMostShared) {
        shared_drops_->any.merge(drops.any);
        shared_drops_->clear_of_edges.merge(drops.clear_of_edges);
    }
}

// An edge that the tool would gouge counts as one more contact.
LowestPositionSearch::DroppedTool ReachableHeight::drop_at(double x, double y, Edges edges)
{
    ++drops_made_;
    LowestPositionSearch::DroppedTool rest{{x, y, kInfinite}, {}};
    if (surfaces_.empty()) {
        if (const auto on_mesh = path_fitter_.model().drop_ball(x, y, contact_radius_)) {
            rest = {on_mesh->centre, on_mesh->point};
        }
    } else {
        if (!floor_) {
            std::call_once(shared_floor_->made, [&] {
                shared_floor_->cutter.emplace(surfaces_, path_fitter_.offset_tool(), accuracy_);
            });
            floor_ = shared_floor_->cutter->for_thread();
        }
        rest = drop_tool(*floor_, x, y);
    }
    if (edges == Edges::kMovedClear && std::isfinite(rest.centre.z)) {
        const Vec3d up{0, 0, radius_};
        const EdgeGougeCheck::RaisedTip raised =
            path_fitter_.raised_clear_of_edges(rest.centre - up);
        if (raised.barrier) {
            rest = {raised.tip + up, *raised.barrier};
        }
    }
    return rest;
}

std::optional<ReachableHeight::Position> ReachableHeight::lowest_over(Vec3d place,
                                                                      double exact_below)
{
    const std::optional<LowestPositionSearch::Position> best =
        search_.lowest_over(place, exact_below);
    if (best && best->height > exact_below) {
        return Position{best->centre - Vec3d{0, 0, radius_}, best->height};
    }
    return best ? exactly(*best, place, exact_below, Edges::kIgnored) : std::nullopt;
}

std::optional<ReachableHeight::Position> ReachableHeight::lowest_clear_of_edges(
    Vec3d place, const Position& near, double exact_below)
{
    const std::optional<LowestPositionSearch::Position> best = search_clear_of_edges_.lowest_over(
        place, exact_below, -kUnbounded, Vec2d{near.tip.x, near.tip.y});
    if (!best || best->height > exact_below) {
        return std::nullopt;
    }
    const std::optional<Position> exact = exactly(*best, place, exact_below, Edges::kMovedClear);
    return exact && exact->height <= exact_below ? exact : std::nullopt;
}

std::optional<ReachableHeight::Position> ReachableHeight::exactly(
    const LowestPositionSearch::Position& found, Vec3d place, double exact_below, Edges edges)
{
    const std::optional<Position> exact = exact_over(place, found.centre.x, found.centre.y, edges);
    if (exact && exact->height > exact_below) {
        const std::optional<Position> off_brink = beside(place, found.centre, exact_below, edges);
        return off_brink ? off_brink : exact;
    }
    return exact;
}

std::optional<ReachableHeight::Position> ReachableHeight::exact_over(Vec3d place,
                                                                     double x,
                                                                     double y,
                                                                     Edges edges) const
{
    ++drops_made_;
    std::optional<Vec3d> tip = path_fitter_.drop(x, y);
    if (!tip) {
        return std::nullopt;
    }
    if (edges == Edges::kMovedClear) {
        tip = path_fitter_.raised_clear_of_edges(*tip).tip;
    }
    return Position{*tip, search_.height_under(*tip + Vec3d{0, 0, radius_}, place)};
}

// The lowest position is often beside a cliff that the ball just misses; an exact drop there may
// land on top of the cliff. Slightly away from the cliff the position is hardly higher.
std::optional<ReachableHeight::Position> ReachableHeight::beside(Vec3d place,
                                                                 Vec3d brink,
                                                                 double exact_below,
                                                                 Edges edges)
{
    for (double distance = kLeastOffBrink; distance < kMostOffBrink * search_.pitch();
         distance *= 2) {
        std::optional<Position> best;
        for (int k = 0; k < kWays; ++k) {
            const double turn = 2 * kPi * k / kWays;
            const double x = brink.x + distance * elementary::cos(turn);
            const double y = brink.y + distance * elementary::sin(turn);
            if (search_.height_under(drop_at(x, y, edges).centre, place) > exact_below) {
                continue;
            }
            const std::optional<Position> there = exact_over(place, x, y, edges);
            if (there && there->height <= exact_below && (!best || there->height < best->height)) {
                best = there;
            }
        }
        if (best) {
            return best;
        }
    }
    return std::nullopt;
}

}  // namespace cusp::finishing
