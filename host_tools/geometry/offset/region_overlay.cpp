// The edges of each region are cut at those of the other; a piece is kept by the side of its middle.
#include "host_tools/geometry/offset/region_overlay.hpp"

#include <algorithm>
#include <vector>

#include "host_tools/geometry/offset/edge_crossings.hpp"
#include "host_tools/geometry/offset/edge_runs.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::offset {

namespace {

constexpr double kOverrun = 1e-9;  // mm: a crossing may lie this far beyond an edge's end

class Overlay {
public:
    // Adds the pieces of `from` that are inside `other`, or those outside.
    void add(const Region2d& from, const Region2d& other, bool inside, bool backwards)
    {
        const std::vector<Edge> others = edges_of(other);
        const EdgeTree tree{others};
        for (const Contour& contour : from.contours) {
            for (const Edge& edge : contour) {
                for (const Edge& piece : pieces_of(edge, others, tree)) {
                    if (tree.surrounds(point_on(piece, 0.5)) == inside) {
                        runs_.push_back({{backwards ? reversed(piece) : piece}, {}, false, false});
                    }
                }
            }
        }
    }

    std::optional<Region2d> result() { return joined(runs_); }

private:
    static std::vector<Edge> pieces_of(const Edge& edge,
                                       const std::vector<Edge>& others,
                                       const EdgeTree& tree)
    {
        std::vector<Vec2d> cuts{edge.start, edge.end};
        Box2d box = box_of(edge);
        box = {box.x0 - kOverrun, box.y0 - kOverrun, box.x1 + kOverrun, box.y1 + kOverrun};
        tree.visit_meeting(box, [&](std::uint32_t i) {
            for (const Vec2d p : crossings(edge, others[i], kOverrun)) {
                cuts.push_back(p);
            }
        });
        std::sort(cuts.begin() + 2, cuts.end(), [&](Vec2d a, Vec2d b) {
            return share_of_chord(edge, a) < share_of_chord(edge, b);
        });
        std::rotate(cuts.begin() + 1, cuts.begin() + 2, cuts.end());
        std::vector<Edge> pieces;
        for (std::size_t i = 1; i < cuts.size(); ++i) {
            if (distance(cuts[i - 1], cuts[i]) > kShortestPiece) {
                pieces.push_back(between(edge, cuts[i - 1], cuts[i]));
            }
        }
        return pieces;
    }

    std::vector<Run> runs_;
};

}  // namespace

std::optional<Region2d> common(const Region2d& a, const Region2d& b)
{
    Overlay overlay;
    overlay.add(a, b, true, false);
    overlay.add(b, a, true, false);
    return overlay.result();
}

std::optional<Region2d> united(const Region2d& a, const Region2d& b)
{
    Overlay overlay;
    overlay.add(a, b, false, false);
    overlay.add(b, a, false, false);
    return overlay.result();
}

std::optional<Region2d> without(const Region2d& a, const Region2d& b)
{
    Overlay overlay;
    overlay.add(a, b, false, false);
    overlay.add(b, a, true, true);
    return overlay.result();
}

}  // namespace cusp::offset
