// Run starts are looked up by x.
#include "host_tools/geometry/offset/edge_runs.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::offset {

double share_of_chord(const Edge& edge, Vec2d point)
{
    const Vec2d chord = edge.end - edge.start;
    return dot(point - edge.start, chord) / dot(chord, chord);
}

namespace {

Vec2d start_of(const Run& run) { return run.edges.front().start; }

// The unused run that starts at the end of `last` with the sharpest left turn, if any.
//
// by_x  the open runs, by x of their starts
std::optional<std::size_t> next_run(const std::vector<Run>& runs,
                                    const std::vector<std::size_t>& by_x,
                                    const std::vector<bool>& used,
                                    const Edge& last)
{
    auto at = std::lower_bound(by_x.begin(), by_x.end(), last.end.x - kSameVertex,
                               [&](std::size_t i, double x) { return start_of(runs[i]).x < x; });
    std::optional<std::size_t> best;
    double best_turn = -kUnbounded;
    const Vec2d arriving = tangent_at_end(last);
    for (; at != by_x.end() && start_of(runs[*at]).x <= last.end.x + kSameVertex; ++at) {
        if (used[*at] || std::abs(start_of(runs[*at]).y - last.end.y) > kSameVertex) {
            continue;
        }
        const Vec2d leaving = tangent_at_start(runs[*at].edges.front());
        const double turn = elementary::atan2(cross(arriving, leaving), dot(arriving, leaving));
        if (turn > best_turn) {
            best = *at;
            best_turn = turn;
        }
    }
    return best;
}

}  // namespace

std::optional<Region2d> joined(std::vector<Run>& runs)
{
    std::vector<std::size_t> by_x;
    Region2d region;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        if (runs[i].closed) {
            region.contours.push_back(std::move(runs[i].edges));
        } else {
            by_x.push_back(i);
        }
    }
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
        return start_of(runs[a]).x < start_of(runs[b]).x;
    });
    std::vector<bool> used(runs.size(), false);
    for (const std::size_t first : by_x) {
        if (used[first]) {
            continue;
        }
        Contour contour;
        std::optional<std::size_t> at = first;
        const Vec2d origin = start_of(runs[first]);
        while (true) {
            if (!at) {
                return std::nullopt;
            }
            used[*at] = true;
            if (!contour.empty()) {
                contour.back().end = start_of(runs[*at]);
            }
            contour.insert(contour.end(), runs[*at].edges.begin(), runs[*at].edges.end());
            const Vec2d end = contour.back().end;
            at = next_run(runs, by_x, used, contour.back());
            const bool home = distance(end, origin) < kSameVertex;
            if (home) {
                contour.back().end = origin;
                break;
            }
        }
        region.contours.push_back(std::move(contour));
    }
    return region;
}

}  // namespace cusp::offset
