// A circle that touches a wall is open by twice the angle whose versine is the stock's thickness in radii; a pass looks
// at the half ahead.
#include "host_tools/cam/adaptive_clearing/wall_budget.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::adaptive_clearing {

namespace {

constexpr double kMostChords = 0.005;      // radii
constexpr double kMissedByDiscs = 0.0004;  // radii, of SweptArea
constexpr double kMostOpen = 0.03;         // radians
constexpr double kThinnest = 0.00045;      // radii: the versine of kMostOpen
constexpr double kOfSliver = 0.25;         // the most that is barely open
// Chords cost moves, but thin slivers cost passes.
constexpr double kChordsBeside = 0.3;  // of the room, where chords count twice

}  // namespace

double missed_beside(double chords, double radius) { return chords + kMissedByDiscs * radius; }

double barely_open(double sliver, double radius)
{
    return std::min(kMostOpen, std::sqrt(2 * kOfSliver * sliver / radius));
}

WallShares shares_of(double room, double radius, bool beside)
{
    const double most = std::min(kMostChords * radius, beside ? kChordsBeside * room : room);
    const double rest = beside ? room - most : room;
    const double sliver = std::min(missed_beside(kMostChords * radius, radius),
                                   std::max(rest - kThinnest * radius, rest / (1 + kOfSliver)));
    return {std::min(most, sliver - kMissedByDiscs * radius), sliver};
}

double least_sliver(const AdaptiveSettings& settings)
{
    constexpr double kOfRadius = 0.004;
    constexpr double kOfCorner = 0.5;
    return std::max({std::min(kOfRadius * settings.tool_radius, kOfCorner * settings.corner),
                     missed_beside(settings.tolerance, settings.tool_radius), settings.sliver});
}

double room_for(double chords, double radius)
{
    const double sliver = missed_beside(chords, radius);
    return sliver + std::min(kThinnest * radius, kOfSliver * sliver);
}

}  // namespace cusp::adaptive_clearing
