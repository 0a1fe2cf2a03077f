// `ReachSearch` over drops of the tool that passes are planned with; its answer is dropped exactly.
#include "host_tools/surface_passes/lowest_reach.hpp"

#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::host {
namespace {

// Away from the brink of a cliff.
constexpr double kLeastOffBrink = 5e-4;  // mm
constexpr double kMostOffBrink = 0.1;    // of the pitch
constexpr int kWays = 8;

}  // namespace

LowestReach::LowestReach(const std::vector<Surface>& surfaces,
                         const CertifiedPasses& certified,
                         double pitch,
                         double accuracy)
    : surfaces_{surfaces},
      certified_{certified},
      accuracy_{accuracy},
      radius_{certified.tool().radius},
      contact_radius_{radius_ + certified.band().lift},
      search_{certified.tool(), certified.band().lift, pitch, 3 * accuracy,
              [this](double x, double y) {
                  return dropped(x, y, Edges::kMet);
              }},
      kept_off_{certified.tool(), certified.band().lift, pitch, 3 * accuracy,
                [this](double x, double y) {
                    return dropped(x, y, Edges::kKeptOff);
                }}
{
}

// An edge that the tool keeps off is one more contact.
ReachSearch::Rest LowestReach::dropped(double x, double y, Edges edges)
{
    ReachSearch::Rest rest{{x, y, ReachSearch::kNowhere}, {}};
    if (surfaces_.empty()) {
        if (const auto on_mesh = certified_.model().rest_on_mesh(x, y, contact_radius_)) {
            rest = {on_mesh->centre, on_mesh->point};
        }
    } else {
        // Most models never ask.
        if (!floor_) {
            floor_.emplace(surfaces_, certified_.lifted_tool(), accuracy_);
        }
        rest = rest_on(*floor_, x, y);
    }
    if (edges == Edges::kKeptOff && std::isfinite(rest.centre.z)) {
        const Vec3d up{0, 0, radius_};
        const EdgeGuard::Raised raised = certified_.raised_off_edges(rest.centre - up);
        if (raised.barrier) {
            rest = {raised.tip + up, *raised.barrier};
        }
    }
    return rest;
}

std::optional<LowestReach::Answer> LowestReach::over(Vec3d place, double worth)
{
    const std::optional<ReachSearch::Answer> best = search_.over(place, worth);
    if (best && best->height > worth) {
        return Answer{best->centre - Vec3d{0, 0, radius_}, best->height};
    }
    return best ? exactly(*best, place, worth, Edges::kMet) : std::nullopt;
}

std::optional<LowestReach::Answer> LowestReach::kept_off_edges(Vec3d place,
                                                               const Answer& near,
                                                               double worth)
{
    const std::optional<ReachSearch::Answer> best =
        kept_off_.over(place, worth, -1e300, Vec2d{near.tip.x, near.tip.y});
    if (!best || best->height > worth) {
        return std::nullopt;
    }
    const std::optional<Answer> exact = exactly(*best, place, worth, Edges::kKeptOff);
    return exact && exact->height <= worth ? exact : std::nullopt;
}

std::optional<LowestReach::Answer> LowestReach::exactly(const ReachSearch::Answer& found,
                                                        Vec3d place,
                                                        double worth,
                                                        Edges edges)
{
    const std::optional<Answer> exact = exact_over(place, found.centre.x, found.centre.y, edges);
    if (exact && exact->height > worth) {
        const std::optional<Answer> off_brink = beside(place, found.centre, worth, edges);
        return off_brink ? off_brink : exact;
    }
    return exact;
}

std::optional<LowestReach::Answer> LowestReach::exact_over(Vec3d place,
                                                           double x,
                                                           double y,
                                                           Edges edges) const
{
    std::optional<Vec3d> tip = certified_.dropped(x, y);
    if (!tip) {
        return std::nullopt;
    }
    if (edges == Edges::kKeptOff) {
        tip = certified_.raised_off_edges(*tip).tip;
    }
    return Answer{*tip, search_.height_under(*tip + Vec3d{0, 0, radius_}, place)};
}

// The lowest position is often on the brink of a cliff that the ball just misses, and exactly
// dropped it stands on top. A little away it is hardly higher.
std::optional<LowestReach::Answer> LowestReach::beside(Vec3d place,
                                                       Vec3d brink,
                                                       double worth,
                                                       Edges edges)
{
    for (double off = kLeastOffBrink; off < kMostOffBrink * search_.pitch(); off *= 2) {
        std::optional<Answer> best;
        for (int k = 0; k < kWays; ++k) {
            const double turn = 2 * kPi * k / kWays;
            const double x = brink.x + off * std::cos(turn);
            const double y = brink.y + off * std::sin(turn);
            if (search_.height_under(dropped(x, y, edges).centre, place) > worth) {
                continue;
            }
            const std::optional<Answer> there = exact_over(place, x, y, edges);
            if (there && there->height <= worth && (!best || there->height < best->height)) {
                best = there;
            }
        }
        if (best) {
            return best;
        }
    }
    return std::nullopt;
}

}  // namespace cusp::host
