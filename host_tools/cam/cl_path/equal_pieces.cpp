// The number of pieces of an edge grows until all of them are within the band.
#include "host_tools/cam/cl_path/equal_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::cl_path {

using offset::Edge;

namespace {

// Corners of chords that leave the tangent by less than this become so blunt that no machine stops
// at them.
constexpr double kOffTangent = 0.03;     // mm
constexpr double kBlunt = 0.45;          // degrees
constexpr double kBluntest = 2.0;        // degrees: where pieces would be too short
constexpr double kShortestPiece = 0.05;  // mm: many shorter ones in a tick slow a machine
constexpr double kMostPieces = 4096;     // of one edge
constexpr double kDegree = kPi / 180.0;

class EdgePieces {
public:
    EdgePieces(const Edge& edge, const PathFloor& floor, const EqualPieces& settings)
        : edge_{edge}, floor_{floor}, settings_{settings}
    {
    }

    double band_middle(Vec2d at) const { return lowest(at) + settings_.band.middle(); }

    int least_count() const
    {
        if (edge_.turn == 0 || settings_.arcs) {
            return 1;
        }
        const double share = std::min(1.0, settings_.band.plan_tolerance / edge_.radius);
        double angle = 2.0 * elementary::acos(1.0 - share);
        if (0.5 * edge_.radius * angle * angle < kOffTangent) {
            const double blunt =
                std::clamp(kShortestPiece / edge_.radius, kBlunt * kDegree, kBluntest * kDegree);
            angle = std::min(angle, blunt);
        }
        const double count = std::ceil(sweep(edge_) / angle);
        return static_cast<int>(std::clamp(count, 1.0, kMostPieces));
    }

    // True if every station of every piece is within its band.
    bool fits(int count) const
    {
        for (int i = 0; i < count; ++i) {
            const double a = band_middle(end(i, count));
            const double b = band_middle(end(i + 1, count));
            const int looks = 1 + static_cast<int>(length(edge_) / (count * settings_.spacing));
            for (int k = 1; k < looks; ++k) {
                const double share = static_cast<double>(k) / looks;
                const double over =
                    a + (b - a) * share - lowest(point_on(edge_, (i + share) / count));
                if (over < settings_.band.low || over > settings_.band.high) {
                    return false;
                }
            }
        }
        return true;
    }

    Vec2d end(int i, int count) const
    {
        return i == 0       ? edge_.start
               : i == count ? edge_.end
                            : point_on(edge_, static_cast<double>(i) / count);
    }

private:
    double lowest(Vec2d at) const
    {
        const auto tip = floor_.drop(at);
        return std::max(tip ? tip->z + settings_.allowance : -kUnbounded, settings_.min_z);
    }

    const Edge& edge_;
    const PathFloor& floor_;
    const EqualPieces& settings_;
};

}  // namespace

Chain equal_pieces_chain(const std::vector<Edge>& plan,
                         const PathFloor& floor,
                         const EqualPieces& settings)
{
    Chain chain;
    const Vec2d first = plan.front().start;
    chain.start = {first.x, first.y, EdgePieces{plan.front(), floor, settings}.band_middle(first)};
    for (const Edge& edge : plan) {
        const EdgePieces pieces{edge, floor, settings};
        const int max_count = 1 + static_cast<int>(length(edge) / settings.spacing);
        int count = pieces.least_count();
        while (count < max_count && !pieces.fits(count)) {
            count += 1 + count / 4;
        }
        for (int i = 1; i <= count; ++i) {
            const Vec2d at = pieces.end(i, count);
            ClMove move{{at.x, at.y, pieces.band_middle(at)}};
            if (settings.arcs && edge.turn != 0) {
                move.centre = edge.centre;
                move.turn = edge.turn;
            }
            chain.moves.push_back(move);
        }
    }
    return chain;
}

}  // namespace cusp::cl_path
