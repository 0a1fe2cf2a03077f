// A distance changes by no more than the position, so a square's middle decides the whole square.
#include "host_tools/cam/hull_rough/layer_coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::hull_rough {

using clearing::LayerRun;
using offset::Edge;
using offset::EdgeTree;
using offset::line_edge;
using offset::RegionOffset;

namespace {

constexpr double kSmallestSquare = 1.0 / 64;  // of the reach

// Share of the reach that is checked: beyond it lie only points beside outlines, which are runs.
constexpr double kReachChecked = 0.97;

std::vector<Edge> edges_of(const std::vector<LayerRun>& runs)
{
    std::vector<Edge> out;
    for (const LayerRun& run : runs) {
        out.insert(out.end(), run.edges.begin(), run.edges.end());
    }
    return out;
}

struct Square {
    Vec2d middle;
    double side;
};

std::array<Vec2d, 4> corners_of(const Square& square)
{
    const Vec2d m = square.middle;
    const double half = square.side / 2;
    return {Vec2d{m.x - half, m.y - half}, Vec2d{m.x + half, m.y - half},
            Vec2d{m.x + half, m.y + half}, Vec2d{m.x - half, m.y + half}};
}

class Search {
public:
    Search(const std::vector<LayerRun>& runs, const RegionOffset& centres, double reach)
        : edges_{edges_of(runs)}, tree_{edges_}, centres_{centres}, reach_{reach}
    {
    }

    UncoveredSpots over(const Rectangle& window)
    {
        const double side = reach_ * 2;
        for (double x = window.x_min + side / 2; x - side / 2 < window.x_max; x += side) {
            for (double y = window.y_min + side / 2; y - side / 2 < window.y_max; y += side) {
                stack_.push_back({{x, y}, side});
                empty_stack(window);
            }
        }
        return std::move(found_);
    }

private:
    std::vector<Edge> edges_;
    EdgeTree tree_;
    const RegionOffset& centres_;
    double reach_;
    std::vector<Square> stack_;
    UncoveredSpots found_;

    void empty_stack(const Rectangle& window)
    {
        while (!stack_.empty()) {
            const Square square = stack_.back();
            stack_.pop_back();
            examine(square, window);
        }
    }

    void examine(const Square& square, const Rectangle& window)
    {
        const Vec2d m = square.middle;
        const double half = square.side / 2;
        const double corner = half * std::sqrt(2.0);
        const bool outside = m.x - half >= window.x_max || m.y - half >= window.y_max;
        if (outside || (reach_ > corner && tree_.any_nearer(m, reach_ - corner)) ||
            two_lines_clear(square)) {
            return;
        }
        const double inside = centres_.clearance(m);
        if (inside < -(kReachChecked * reach_ + corner)) {
            return;
        }
        if (square.side > kSmallestSquare * reach_) {
            for (const Vec2d way : {Vec2d{-1, -1}, Vec2d{1, -1}, Vec2d{-1, 1}, Vec2d{1, 1}}) {
                stack_.push_back({m + way * (half / 2), half});
            }
        } else if (inside > -(kReachChecked * reach_ - corner) && !tree_.any_nearer(m, reach_)) {
            found_.squares.push_back({m.x - half, m.y - half, m.x + half, m.y + half});
            found_.area += square.side * square.side;
        }
    }

    // A straight run clears a convex set. Two convex sets that cover the border of a square cover
    // the square: a point in neither would lie in a wedge outside both, and the wedge would cross
    // the border.
    bool two_lines_clear(const Square& square) const
    {
        if (square.side > reach_ || edges_.empty()) {
            return false;
        }
        const std::array<Vec2d, 4> corners = corners_of(square);
        const std::size_t first = tree_.nearest_edge(square.middle).edge;
        const auto open = std::find_if(corners.begin(), corners.end(),
                                       [&](Vec2d p) { return !clears(first, p); });
        if (edges_[first].turn != 0 || open == corners.end()) {
            return edges_[first].turn == 0;
        }
        const std::size_t second = tree_.nearest_edge(*open).edge;
        if (edges_[second].turn != 0) {
            return false;
        }
        for (std::size_t i = 0; i < 4; ++i) {
            if (!both_clear(first, second, corners[i], corners[(i + 1) % 4])) {
                return false;
            }
        }
        return true;
    }

    bool clears(std::size_t edge, Vec2d p) const { return distance_to(edges_[edge], p) <= reach_; }

    // True if the two runs together clear the segment from a to b.
    bool both_clear(std::size_t first, std::size_t second, Vec2d a, Vec2d b) const
    {
        if (!clears(first, a)) {
            std::swap(a, b);
        }
        if (!clears(first, a)) {
            return clears(second, a) && clears(second, b);
        }
        if (clears(first, b)) {
            return true;
        }
        if (!clears(second, b)) {
            return false;
        }
        // The last point that the first run clears: the second run has to clear it too.
        Vec2d last_cleared = a;
        Vec2d open = b;
        for (int i = 0; i < 24; ++i) {
            const Vec2d middle = (last_cleared + open) * 0.5;
            (clears(first, middle) ? last_cleared : open) = middle;
        }
        return clears(second, last_cleared);
    }
};

}  // namespace

UncoveredSpots uncovered_spots(const std::vector<LayerRun>& runs,
                               const RegionOffset& centres,
                               double reach,
                               const Rectangle& window)
{
    return Search{runs, centres, reach}.over(window);
}

std::vector<LayerRun> runs_near(const std::vector<LayerRun>& runs,
                                const UncoveredSpots& uncovered,
                                double reach)
{
    std::vector<Edge> diagonals;
    for (const Rectangle& s : uncovered.squares) {
        diagonals.push_back(line_edge({s.x_min, s.y_min}, {s.x_max, s.y_max}));
    }
    const EdgeTree squares{diagonals};
    std::vector<LayerRun> out;
    LayerRun part;
    const auto close_part = [&] {
        if (!part.edges.empty()) {
            out.push_back(std::exchange(part, {}));
        }
    };
    for (const LayerRun& run : runs) {
        for (const Edge& edge : run.edges) {
            const int pieces = 1 + static_cast<int>(length(edge) / reach);
            Vec2d from = edge.start;
            for (int i = 1; i <= pieces; ++i) {
                const Vec2d to =
                    i == pieces ? edge.end : point_on(edge, static_cast<double>(i) / pieces);
                const Edge piece = between(edge, from, to);
                if (squares.any_nearer(point_on(piece, 0.5), 1.1 * reach + length(piece) / 2)) {
                    part.edges.push_back(piece);
                } else {
                    close_part();
                }
                from = to;
            }
        }
        close_part();
    }
    return out;
}

}  // namespace cusp::hull_rough
