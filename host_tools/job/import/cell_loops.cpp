#include "host_tools/job/import/cell_loops.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::import {

namespace {

// The unused edge that begins nearest to a point, among those that enter or those that do not.
CellEdge* nearest(std::vector<CellEdge>& edges,
                  Vec3d point,
                  bool enters,
                  const CellBoundary& boundary)
{
    CellEdge* best = nullptr;
    double least = kInfinite;
    for (CellEdge& edge : edges) {
        const double apart = boundary.distance(edge.edge.begin(), point);
        if (!edge.used && edge.enters == enters && apart < least) {
            least = apart;
            best = &edge;
        }
    }
    return best;
}

class Walk {
public:
    Walk(std::vector<CellEdge>& edges,
         const CellBoundary& boundary,
         double gap,
         const std::string& place)
        : edges_{edges}, boundary_{boundary}, gap_{gap}, place_{place}
    {
    }

    FaceLoop loop_from(CellEdge& first)
    {
        FaceLoop loop;
        for (CellEdge* at = &first; at != nullptr;) {
            at->used = true;
            loop.push_back(at->edge);
            at = at->leaves ? along_boundary(*at, first, loop) : next_of(*at, first);
        }
        return loop;
    }

private:
    // The edge that begins where this one ends inside the cell; none where the loop is closed.
    CellEdge* next_of(const CellEdge& edge, const CellEdge& first)
    {
        const Vec3d end = edge.edge.end();
        CellEdge* next = nearest(edges_, end, false, boundary_);
        const double to_next =
            next != nullptr ? boundary_.distance(next->edge.begin(), end) : kInfinite;
        const double to_first =
            first.enters ? kInfinite : boundary_.distance(first.edge.begin(), end);
        if (std::min(to_next, to_first) > gap_) {
            throw InputError(place_ + ": the edges do not close");
        }
        return to_next < to_first ? next : nullptr;
    }

    // Follows the boundary to the next edge that enters; none where that is the first.
    CellEdge* along_boundary(const CellEdge& edge, const CellEdge& first, FaceLoop& loop)
    {
        const double around = boundary_.sides();
        const double from = boundary_.place_of(edge.edge.end());
        CellEdge* next = nullptr;
        double least = kInfinite;
        double to = from;
        for (CellEdge& other : edges_) {
            const double there = other.enters ? boundary_.place_of(other.edge.begin()) : 0;
            const double ahead = std::fmod(there - from + around, around);
            if (other.enters && ahead < least) {
                least = ahead;
                next = &other;
                to = there;
            }
        }
        if (next == nullptr || (next->used && next != &first)) {
            throw InputError(place_ + ": the edges do not bound a face");
        }
        const FaceLoop sides = boundary_.between(from, to);
        loop.insert(loop.end(), sides.begin(), sides.end());
        return next == &first ? nullptr : next;
    }

    std::vector<CellEdge>& edges_;
    const CellBoundary& boundary_;
    double gap_;
    const std::string& place_;
};

// True if the face has the boundary of a cell that no edge meets, all of it.
bool is_boundary_inside(const CellBoundary& boundary,
                        const std::function<bool(Vec3d)>& is_inside,
                        const std::string& place)
{
    const bool inside = is_inside(boundary.part(0, 0, 1).begin());
    for (unsigned side = 0; side < boundary.sides(); ++side) {
        const FaceEdge whole = boundary.part(side, 0, 1);
        if (is_inside(whole.begin()) != inside || is_inside(whole.at(0.5).point) != inside) {
            throw InputError(place + ": the edges have the face on both sides");
        }
    }
    return inside;
}

}  // namespace

std::vector<CellEdge> cut_at_cells(const FaceEdge& edge,
                                   unsigned axes,
                                   const std::function<int(Vec3d point, unsigned axis)>& cell_of)
{
    constexpr int kHalvings = 60;
    std::vector<double> cuts;
    for (int k = 0; k < kEdgeChords; ++k) {
        for (unsigned axis = 0; axis < axes; ++axis) {
            double a = parameter_of(edge, k);
            double b = parameter_of(edge, k + 1);
            const int cell = cell_of(edge.at(a).point, axis);
            if (cell_of(edge.at(b).point, axis) == cell) {
                continue;
            }
            for (int i = 0; i < kHalvings; ++i) {
                const double middle = 0.5 * (a + b);
                (cell_of(edge.at(middle).point, axis) == cell ? a : b) = middle;
            }
            cuts.push_back(0.5 * (a + b));
        }
    }
    std::sort(cuts.begin(), cuts.end());
    if (edge.to < edge.from) {
        std::reverse(cuts.begin(), cuts.end());
    }
    cuts.push_back(edge.to);
    std::vector<CellEdge> parts;
    double from = edge.from;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        parts.push_back({{edge.at, from, cuts[i]}, i > 0, i + 1 < cuts.size(), false});
        from = cuts[i];
    }
    return parts;
}

double CellBoundary::place_of(Vec3d point) const
{
    unsigned nearest_side = 0;
    double least = kInfinite;
    for (unsigned side = 0; side < sides_; ++side) {
        const double off = beside(point, side);
        if (off < least) {
            least = off;
            nearest_side = side;
        }
    }
    return nearest_side + std::clamp(along(point, nearest_side), 0.0, 1.0);
}

FaceLoop CellBoundary::between(double from, double to) const
{
    to += to <= from ? sides_ : 0;
    FaceLoop parts;
    for (double at = from; at < to;) {
        const double corner = std::floor(at) + 1;
        const double end = std::min(corner, to);
        const unsigned side = static_cast<unsigned>(corner - 1) % sides_;
        parts.push_back(part(side, at - (corner - 1), end - (corner - 1)));
        at = end;
    }
    return parts;
}

std::vector<FaceLoop> cell_loops(std::vector<CellEdge> edges,
                                 const CellBoundary& boundary,
                                 const std::function<bool(Vec3d)>& is_inside,
                                 double gap,
                                 const std::string& place)
{
    std::vector<FaceLoop> loops;
    const bool is_met =
        std::any_of(edges.begin(), edges.end(), [](const CellEdge& edge) { return edge.enters; });
    if (!is_met && is_boundary_inside(boundary, is_inside, place)) {
        loops.push_back(boundary.between(0, boundary.sides()));
    }
    Walk walk{edges, boundary, gap, place};
    for (const bool enters : {true, false}) {
        for (CellEdge& edge : edges) {
            if (!edge.used && edge.enters == enters) {
                loops.push_back(walk.loop_from(edge));
            }
        }
    }
    return loops;
}

}  // namespace cusp::import
