// A segment that passes the unit square around a vertex is led through the vertex.
#include "host_tools/geometry/offset/planar_segments.hpp"

#include <algorithm>

#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::offset {

namespace {

int sign(WideInt value) { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

// True if the segment from a to b has a point in the square of side 1 around c, which is open at
// its upper and right sides.
bool passes(GridPoint a, GridPoint b, GridPoint c)
{
    if (std::min(a.x, b.x) > c.x || std::max(a.x, b.x) < c.x || std::min(a.y, b.y) > c.y ||
        std::max(a.y, b.y) < c.y) {
        return false;
    }
    const GridPoint way{2 * (b.x - a.x), 2 * (b.y - a.y)};
    const GridPoint arm{2 * (c.x - a.x), 2 * (c.y - a.y)};
    int sides = 0;
    for (const GridPoint corner : {GridPoint{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
        int side = sign(cross(way, {arm.x + corner.x, arm.y + corner.y}));
        if (side == 0) {
            // As if the open sides were moved inward by next to nothing.
            side = sign(cross(way, {corner.x > 0 ? -1 : 0, corner.y > 0 ? -1 : 0}));
        }
        sides += side;
    }
    return sides != 4 && sides != -4;
}

// num / den, to the nearest; half way up. Precondition: den > 0.
std::int64_t rounded(WideInt num, WideInt den)
{
    const WideInt twice = 2 * num + den;
    WideInt whole = twice / (2 * den);
    whole -= whole * 2 * den > twice ? 1 : 0;
    return static_cast<std::int64_t>(whole);
}

class Splitter {
public:
    Splitter(std::vector<Segment>& segments, GridPoints& points)
        : segments_{segments}, points_{points}, tree_{diagonals()}
    {
    }

    // False where there is nothing to split.
    bool run()
    {
        for (std::uint32_t i = 0; i < segments_.size(); ++i) {
            tree_.visit_meeting(box_around(segments_[i].from, segments_[i].to),
                                [&](std::uint32_t j) { look_at(i, j); });
        }
        for (const std::uint32_t vertex : crossings_) {
            tree_.visit_meeting(box_around(vertex, vertex),
                                [&](std::uint32_t i) { cut_at(i, vertex); });
        }
        if (cuts_.empty()) {
            return false;
        }
        split();
        return true;
    }

private:
    struct Cut {
        std::uint32_t segment;
        std::uint32_t vertex;
        WideInt along;
    };

    GridPoint from(std::uint32_t i) const { return points_.point(segments_[i].from); }
    GridPoint to(std::uint32_t i) const { return points_.point(segments_[i].to); }

    // Coordinates of the grid are exact as doubles.
    Vec2d exact(std::uint32_t vertex) const
    {
        const GridPoint p = points_.point(vertex);
        return {static_cast<double>(p.x), static_cast<double>(p.y)};
    }

    Box2d box_around(std::uint32_t a, std::uint32_t b) const
    {
        return box_of(line_edge(exact(a), exact(b)));
    }

    std::vector<Edge> diagonals() const
    {
        std::vector<Edge> edges;
        edges.reserve(segments_.size());
        for (const Segment& segment : segments_) {
            edges.push_back(line_edge(exact(segment.from), exact(segment.to)));
        }
        return edges;
    }

    void cut_at(std::uint32_t i, std::uint32_t vertex)
    {
        const Segment& segment = segments_[i];
        const GridPoint c = points_.point(vertex);
        if (vertex != segment.from && vertex != segment.to && passes(from(i), to(i), c)) {
            cuts_.push_back({i, vertex, dot(c - from(i), to(i) - from(i))});
        }
    }

    void look_at(std::uint32_t i, std::uint32_t j)
    {
        cut_at(i, segments_[j].from);
        cut_at(i, segments_[j].to);
        const bool apart =
            segments_[i].from != segments_[j].from && segments_[i].from != segments_[j].to &&
            segments_[i].to != segments_[j].from && segments_[i].to != segments_[j].to;
        if (j <= i || !apart) {
            return;
        }
        const GridPoint way = to(i) - from(i);
        const WideInt start = cross(way, from(j) - from(i));
        const WideInt end = cross(way, to(j) - from(i));
        const GridPoint other = to(j) - from(j);
        const int first = sign(cross(other, from(i) - from(j)));
        const int second = sign(cross(other, to(i) - from(j)));
        if (sign(start) * sign(end) < 0 && first * second < 0) {
            const WideInt den = start > 0 ? start - end : end - start;
            const WideInt num = start > 0 ? start : -start;
            crossings_.push_back(points_.at({from(j).x + rounded(num * other.x, den),
                                             from(j).y + rounded(num * other.y, den)}));
        }
    }

    void split()
    {
        std::sort(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) {
            return a.segment != b.segment ? a.segment < b.segment : a.along < b.along;
        });
        std::vector<Segment> out;
        out.reserve(segments_.size() + cuts_.size());
        std::size_t k = 0;
        for (std::uint32_t i = 0; i < segments_.size(); ++i) {
            Segment rest = segments_[i];
            for (; k < cuts_.size() && cuts_[k].segment == i; ++k) {
                if (cuts_[k].vertex != rest.from) {
                    out.push_back({rest.from, cuts_[k].vertex, rest.source});
                    rest.from = cuts_[k].vertex;
                }
            }
            out.push_back(rest);
        }
        segments_ = std::move(out);
    }

    std::vector<Segment>& segments_;
    GridPoints& points_;
    EdgeTree tree_;
    std::vector<std::uint32_t> crossings_;
    std::vector<Cut> cuts_;
};

}  // namespace

void make_planar(std::vector<Segment>& segments, GridPoints& points)
{
    while (Splitter{segments, points}.run()) {
    }
}

}  // namespace cusp::offset
