// `ReachSearch` over drops of the tool that passes are planned with; its answer is dropped exactly.
#include "host_tools/surface_passes/lowest_reach.hpp"

#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/surface_offset/pattern_search.hpp"

namespace cusp::host {
namespace {

constexpr double kFinest = 1e-3;  // of the pitch
// Away from the brink of a cliff.
constexpr double kLeastOffBrink = 5e-4;  // mm
constexpr double kMostOffBrink = 0.1;    // of the pitch
constexpr int kWays = 8;

double square(double a) { return a * a; }

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
                  return dropped(x, y);
              }}
{
}

ReachSearch::Rest LowestReach::dropped(double x, double y)
{
    if (surfaces_.empty()) {
        const auto rest = certified_.model().rest_on_mesh(x, y, contact_radius_);
        return rest ? ReachSearch::Rest{rest->centre, rest->point}
                    : ReachSearch::Rest{{x, y, ReachSearch::kNowhere}, {}};
    }
    // Most models never ask.
    if (!floor_) {
        floor_.emplace(surfaces_, certified_.lifted_tool(), accuracy_);
    }
    return rest_on(*floor_, x, y);
}

std::optional<LowestReach::Answer> LowestReach::over(Vec3d place, double worth)
{
    const std::optional<ReachSearch::Answer> best = search_.over(place, worth);
    if (!best) {
        return std::nullopt;
    }
    if (best->height > worth) {
        return Answer{best->centre - Vec3d{0, 0, radius_}, best->height};
    }
    const std::optional<Answer> exact = exact_over(place, best->centre.x, best->centre.y);
    if (exact && exact->height > worth) {
        const std::optional<Answer> off_brink = beside(place, best->centre, worth);
        return off_brink ? off_brink : exact;
    }
    return exact;
}

std::optional<LowestReach::Answer> LowestReach::exact_over(Vec3d place, double x, double y) const
{
    const std::optional<Vec3d> tip = certified_.dropped(x, y);
    if (!tip) {
        return std::nullopt;
    }
    return Answer{*tip, search_.height_under(*tip + Vec3d{0, 0, radius_}, place)};
}

// The lowest position is often on the brink of a cliff that the ball just misses, and exactly
// dropped it stands on top. A little away it is hardly higher.
std::optional<LowestReach::Answer> LowestReach::beside(Vec3d place, Vec3d brink, double worth)
{
    for (double off = kLeastOffBrink; off < kMostOffBrink * search_.pitch(); off *= 2) {
        std::optional<Answer> best;
        for (int k = 0; k < kWays; ++k) {
            const double turn = 2 * kPi * k / kWays;
            const double x = brink.x + off * std::cos(turn);
            const double y = brink.y + off * std::sin(turn);
            if (search_.height_under(dropped(x, y).centre, place) > worth) {
                continue;
            }
            const std::optional<Answer> there = exact_over(place, x, y);
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

// What the tool leaves where it stands on the model and off its guarded edges.
std::optional<LowestReach::Answer> LowestReach::raised_over(Vec3d place,
                                                            double x,
                                                            double y,
                                                            bool exact)
{
    const double under = square(radius_) - square(x - place.x) - square(y - place.y);
    if (under < 0) {
        return std::nullopt;
    }
    Vec3d tip;
    if (exact) {
        const std::optional<Vec3d> on_model = certified_.dropped(x, y);
        if (!on_model) {
            return std::nullopt;
        }
        tip = *on_model;
    } else {
        tip = dropped(x, y).centre - Vec3d{0, 0, radius_};
        if (!std::isfinite(tip.z)) {
            return std::nullopt;
        }
    }
    tip = certified_.raised_off_edges(tip);
    return Answer{tip, tip.z + radius_ - std::sqrt(under)};
}

void LowestReach::improve_raised(Vec3d place, Answer& best)
{
    const auto lower = [&](Vec2d to) {
        const std::optional<Answer> other = raised_over(place, to.x, to.y, false);
        const bool found = other && other->height < best.height;
        best = found ? *other : best;
        return found;
    };
    pattern_search({best.tip.x, best.tip.y}, search_.pitch(), kFinest * search_.pitch(), lower);
}

// Contacts say nothing of how far an edge keeps the tool off: here each step is a drop.
std::optional<LowestReach::Answer> LowestReach::kept_off_edges(Vec3d place,
                                                               const Answer& from,
                                                               double worth)
{
    std::vector<ReachSearch::Answer> starts = search_.starts_over(place);
    starts.push_back({from.tip, from.height});
    std::optional<Answer> best;
    for (const ReachSearch::Answer& start : starts) {
        std::optional<Answer> here = raised_over(place, start.centre.x, start.centre.y, false);
        if (!here) {
            continue;
        }
        improve_raised(place, *here);
        if (!best || here->height < best->height) {
            best = here;
        }
    }
    if (!best || best->height > worth) {
        return std::nullopt;
    }
    best = raised_over(place, best->tip.x, best->tip.y, true);
    return best && best->height <= worth ? best : std::nullopt;
}

}  // namespace cusp::host
