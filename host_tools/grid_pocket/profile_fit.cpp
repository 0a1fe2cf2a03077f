// The slopes that keep a line from the chord's start inside the band narrow with every place.
#include "host_tools/grid_pocket/profile_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace cusp::host {
namespace {

// Signed curvature of the circle through a, p and b; > 0 where it bends to the left from a to b.
double curvature_through(ProfilePoint a, ProfilePoint p, ProfilePoint b)
{
    const double turn = (p.s - a.s) * (b.z - a.z) - (p.z - a.z) * (b.s - a.s);
    return 2 * turn /
           (std::hypot(p.s - a.s, p.z - a.z) * std::hypot(b.s - p.s, b.z - p.z) *
            std::hypot(b.s - a.s, b.z - a.z));
}

ProfilePoint centre_of(ProfilePoint a, ProfilePoint b, double curvature)
{
    const double chord = std::hypot(b.s - a.s, b.z - a.z);
    const double half = chord / 2;
    const double radius = 1 / std::abs(curvature);
    const double height =
        std::sqrt(std::max(0.0, radius * radius - half * half)) * (curvature > 0 ? 1 : -1);
    return {(a.s + b.s) / 2 - (b.z - a.z) / chord * height,
            (a.z + b.z) / 2 + (b.s - a.s) / chord * height};
}

// One piece from a fixed start over places of a band.
class PieceFit {
public:
    PieceFit(const std::vector<BandPoint>& band, double max_radius)
        : band_{band}, least_curvature_{1 / max_radius}
    {
    }

    // The piece from `a`, the place `first`, to the place `last`.
    std::optional<ProfilePiece> piece(ProfilePoint a, std::size_t first, std::size_t last) const
    {
        const ProfilePoint b{band_[last].s, (band_[last].low + band_[last].high) / 2};
        // Arcs of less than a third of a turn: heights on them grow with the curvature, downwards.
        double least = -kMostBend / std::hypot(b.s - a.s, b.z - a.z);
        double most = -least;
        for (std::size_t i = first + 1; i < last; ++i) {
            least = std::max(least, curvature_through(a, {band_[i].s, band_[i].high}, b));
            most = std::min(most, curvature_through(a, {band_[i].s, band_[i].low}, b));
            if (least > most) {
                return std::nullopt;
            }
        }
        if (least <= 0 && most >= 0) {
            return ProfilePiece{b, 0, {}};
        }
        double curvature = (least + most) / 2;
        if (std::abs(curvature) < least_curvature_) {
            curvature = curvature > 0 ? most : least;
        }
        if (std::abs(curvature) < least_curvature_) {
            return std::nullopt;
        }
        return ProfilePiece{b, curvature, centre_of(a, b, curvature)};
    }

private:
    static constexpr double kMostBend = 1.7;
    const std::vector<BandPoint>& band_;
    double least_curvature_;
};

}  // namespace

std::vector<ProfilePoint> fit_chords(const std::vector<BandPoint>& band, double z)
{
    std::vector<ProfilePoint> out{{band.front().s, z}};
    for (std::size_t start = 0; start + 1 < band.size();) {
        const ProfilePoint from = out.back();
        double least = -1e300;
        double most = 1e300;
        std::size_t reached = start;
        double slope = 0;
        for (std::size_t i = start + 1; i < band.size(); ++i) {
            const double way = band[i].s - from.s;
            const double lowest = std::max(least, (band[i].low - from.z) / way);
            const double highest = std::min(most, (band[i].high - from.z) / way);
            if (lowest > highest) {
                break;
            }
            least = lowest;
            most = highest;
            const double middle = ((band[i].low + band[i].high) / 2 - from.z) / way;
            slope = std::clamp(middle, least, most);
            reached = i;
        }
        out.push_back({band[reached].s, from.z + slope * (band[reached].s - from.s)});
        start = reached;
    }
    return out;
}

std::vector<ProfilePiece> fit_arcs(const std::vector<BandPoint>& band, double z, double max_radius)
{
    const PieceFit fit{band, max_radius};
    std::vector<ProfilePiece> out;
    ProfilePoint from{band.front().s, z};
    for (std::size_t first = 0; first + 1 < band.size();) {
        // Two places are always reached; then the reach doubles until it fails and is narrowed
        // down.
        std::size_t reached = first + 1;
        ProfilePiece best = *fit.piece(from, first, reached);
        std::size_t failed = band.size();
        for (std::size_t step = 1; reached + 1 < failed;) {
            const std::size_t next = std::min(reached + step, failed - 1);
            if (const auto piece = fit.piece(from, first, next)) {
                best = *piece;
                reached = next;
                step *= 2;
            } else {
                failed = next;
                step = std::max<std::size_t>(1, (failed - reached) / 2);
            }
        }
        out.push_back(best);
        from = best.end;
        first = reached;
    }
    return out;
}

}  // namespace cusp::host
