// One cleanup spur for each stretch of the strip's border that is too far from the ring, checked
// along the stretch.
#include "host_tools/cam/clearing/corner_cleanup.hpp"

#include <algorithm>

#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::clearing {

using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::EdgeTree;
using offset::left_normal;
using offset::line_edge;
using offset::Region2d;
using offset::RegionOffset;

namespace {

// The border of the strip may be at exactly this reach from the whole ring.
constexpr double kAbout = 1.000001;

struct FarPoint {
    Vec2d at;
    double apart;
};

struct Spur {
    std::size_t edge;  // counted over all contours
    Vec2d foot;
    Vec2d end;
};

struct Way {
    FarPoint border;
    FarPoint inner;  // the ridge, or a point beyond it that is easily covered
    Vec2d inward;
    bool meets;  // it meets another line before the ring
};

// The strip that a ring and its spurs must cover: from its border to the ring. Every point of it is
// on a straight line inward from the border. The line ends on the ring or, where it meets another
// such line first, on the ridge of the distance from the walls. A line to the ring is no longer
// than the strip is deep. Other lines are checked at both ends: a convex set that covers the ends
// of neighbouring lines, as the reach of a spur is, covers everything between.
class UncutStrip {
public:
    UncutStrip(const RegionOffset& source,
               const std::vector<Edge>& edges,
               const EdgeTree& ring,
               const CleanupSpace& space)
        : source_{source}, edges_{edges}, ring_{ring}, space_{space}
    {
    }

    // In the order of the contour; near ends of stretches beyond reach they are close together.
    std::vector<Way> lines_from(const Contour& border)
    {
        std::vector<Way> ways;
        const Way first = line_from(border.front(), 0.0);
        Way last = first;
        for (std::size_t e = 0; e < border.size(); ++e) {
            const Edge& edge = border[e];
            const double whole = length(edge);
            const int n = 1 + static_cast<int>(4.0 * whole / space_.reach);
            for (int i = 0; i < n;) {
                ways.push_back(last);
                const int free = last.meets ? i : end_of_free(edge, i, n);
                if (free > i) {
                    last = clear_line(free < n ? point_on(edge, static_cast<double>(free) / n)
                                               : edge.end);
                    i = free;
                    continue;
                }
                ++i;
                const Way next = i < n ? line_from(edge, static_cast<double>(i) / n)
                                 : e + 1 < border.size() ? line_from(border[e + 1], 0.0)
                                                         : first;
                refine(ways, {edge, static_cast<double>(i - 1) / n, static_cast<double>(i) / n},
                       last, next);
                last = next;
            }
        }
        return ways;
    }

    bool is_far(const Way& way) const { return is_far(way.border) || is_far(way.inner); }

    // Inward the distance from the walls grows as fast as the length of the line, up to the ridge.
    FarPoint crest_of(const Way& way) const
    {
        constexpr int kHalvings = 6;
        constexpr double kSlack = 1e-6;
        const double border = space_.wall_distance + space_.reach;
        double good = 0.0;
        double bad = space_.depth;
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (good + bad);
            const Vec2d p = way.border.at + way.inward * middle;
            (source_.any_nearer(p, border + middle - kSlack) ? bad : good) = middle;
        }
        return far_point(way.border.at + way.inward * bad);
    }

private:
    struct Part {
        const Edge& edge;
        double from;
        double to;
    };

    Way clear_line(Vec2d p) const { return {{p, space_.depth}, {p, space_.depth}, {}, false}; }

    Way line_from(const Edge& edge, double share)
    {
        const Vec2d p = share > 0.0 ? point_on(edge, share) : edge.start;
        if (is_beside(p)) {
            return clear_line(p);
        }
        const EdgeTree::Nearest nearest = ring_.nearest_edge(p);
        beside_ = nearest.edge;
        if (is_beside(p)) {
            return clear_line(p);
        }
        const Vec2d inward = left_normal(tangent_on(edge, share));
        Way way{{p, nearest.distance}, {p + inward * space_.depth, kUnbounded}, inward, true};
        if (!is_far(way.border)) {
            way.inner = far_point(way.inner.at);
            way.inner = is_far(way.inner) ? crest_of(way) : way.inner;
        }
        return way;
    }

    bool lies_beside(Vec2d p, std::size_t edge) const
    {
        return distance_to(edges_[edge], p) < space_.depth * kAbout;
    }

    // True if the point is no farther than the strip is deep from the edge of the ring that was
    // nearest to the point before, or from the next edge.
    bool is_beside(Vec2d p)
    {
        if (lies_beside(p, beside_)) {
            return true;
        }
        if (beside_ + 1 < edges_.size() && lies_beside(p, beside_ + 1)) {
            ++beside_;
            return true;
        }
        return false;
    }

    // Point i of n on the edge is beside an edge of the ring. Returns the last point for which this
    // holds for all between: along a line the distance from another line has no maximum; along an
    // arc the distance from an arc with equal centre has one only opposite its middle, which arcs
    // bulging to one side do not reach.
    int end_of_free(const Edge& edge, int i, int n) const
    {
        const Edge& beside = edges_[beside_];
        const bool straight = edge.turn == 0 && beside.turn == 0;
        const bool round = edge.turn != 0 && beside.turn == edge.turn &&
                           distance(edge.centre, beside.centre) < 1e-9 &&
                           dot(edge.end - edge.start, beside.end - beside.start) > 0.0;
        if (!straight && !round) {
            return i;
        }
        if (lies_beside(edge.end, beside_)) {
            return n;
        }
        int bad = n;
        while (bad - i > 1) {
            const int middle = i + (bad - i) / 2;
            const bool free = lies_beside(point_on(edge, static_cast<double>(middle) / n), beside_);
            (free ? i : bad) = middle;
        }
        return i;
    }

    FarPoint far_point(Vec2d p) const { return {p, ring_.nearest(p, kUnbounded)}; }

    bool is_far(const FarPoint& p) const { return p.apart > space_.reach * kAbout; }

    void refine(std::vector<Way>& ways, const Part& part, const Way& a, const Way& b)
    {
        constexpr double kClosest = 0.05;  // of the reach
        if (!hides(a, b)) {
            return;
        }
        const double apart = (part.to - part.from) * length(part.edge);
        if (apart < kClosest * space_.reach) {
            return;
        }
        const double middle = 0.5 * (part.from + part.to);
        const Way between = line_from(part.edge, middle);
        refine(ways, {part.edge, part.from, middle}, a, between);
        ways.push_back(between);
        refine(ways, {part.edge, middle, part.to}, between, b);
    }

    // True if a line between the two may lead beyond reach where they do not, or the other way
    // round.
    bool hides(const Way& a, const Way& b) const
    {
        if (is_far(a) || is_far(b)) {
            return is_far(a) != is_far(b);
        }
        const auto farthest = [](const FarPoint& p, const FarPoint& q) {
            return 0.5 * (p.apart + q.apart + distance(p.at, q.at));
        };
        return (a.meets || b.meets) &&
               std::max(farthest(a.border, b.border), farthest(a.inner, b.inner)) > space_.reach;
    }

    const RegionOffset& source_;
    const std::vector<Edge>& edges_;  // of the ring
    const EdgeTree& ring_;
    const CleanupSpace& space_;
    std::size_t beside_{};  // index of the edge nearest to the last point examined
};

// The lines start at one within reach, or all lead beyond it.
std::vector<std::vector<Way>> far_stretches(std::vector<Way> ways, const UncutStrip& rest)
{
    const auto first =
        std::find_if(ways.begin(), ways.end(), [&](const Way& way) { return !rest.is_far(way); });
    if (first != ways.end()) {
        std::rotate(ways.begin(), first, ways.end());
    }
    std::vector<std::vector<Way>> stretches;
    bool open = false;
    for (const Way& way : ways) {
        if (!rest.is_far(way)) {
            open = false;
            continue;
        }
        if (!open) {
            stretches.emplace_back();
            open = true;
        }
        stretches.back().push_back(way);
    }
    return stretches;
}

// The clearance changes no faster than the position.
bool keeps_room(const RegionOffset& source, Vec2d a, Vec2d b, double room)
{
    constexpr double kSlack = 1e-6;
    const double half = 0.5 * distance(a, b);
    const double here = source.clearance((a + b) * 0.5);
    if (here >= room - kSlack + half) {
        return true;
    }
    const Vec2d middle = (a + b) * 0.5;
    return here >= room - kSlack && (half < kSlack || (keeps_room(source, a, middle, room) &&
                                                       keeps_room(source, middle, b, room)));
}

// From the ring towards a point, until `reach` remains.
Spur spur_towards(const FarPoint& far, const EdgeTree& ring, double reach)
{
    const EdgeTree::Nearest foot = ring.nearest_edge(far.at);
    return {foot.edge, foot.point, far.at + (foot.point - far.at) * (reach / far.apart)};
}

const FarPoint& farther(const FarPoint& a, const FarPoint& b) { return a.apart < b.apart ? b : a; }

// Towards the farthest point of the border; if that does not cover the lines, towards the farthest
// of all.
std::optional<Spur> spur_for(std::vector<Way> stretch,
                             const EdgeTree& ring,
                             const UncutStrip& rest,
                             double reach)
{
    const auto covers = [&](const Spur& spur, const FarPoint& p) {
        return p.apart <= reach ||
               distance_to(line_edge(spur.foot, spur.end), p.at) <= reach * kAbout;
    };
    const auto covers_all = [&](const Spur& spur) {
        return std::all_of(stretch.begin(), stretch.end(), [&](Way& way) {
            if (covers(spur, way.border) && !covers(spur, way.inner)) {
                way.inner = rest.crest_of(way);
            }
            return covers(spur, way.border) && covers(spur, way.inner);
        });
    };
    FarPoint farthest = stretch.front().border;
    for (const Way& way : stretch) {
        farthest = farther(farthest, way.border);
    }
    const Spur by_border = spur_towards(farthest, ring, reach);
    if (farthest.apart > reach && covers_all(by_border)) {
        return by_border;
    }
    for (Way& way : stretch) {
        way.inner = rest.crest_of(way);
        farthest = farther(farthest, way.inner);
    }
    const Spur by_all = spur_towards(farthest, ring, reach);
    return covers_all(by_all) ? std::optional{by_all} : std::nullopt;
}

// Place along its edge where the spur starts; increasing along the path.
double along(const Edge& edge, Vec2d foot) { return dot(foot - edge.start, edge.end - edge.start); }

Region2d with_spurs(const Region2d& ring, std::vector<Spur> spurs)
{
    const std::vector<Edge> edges = edges_of(ring);
    std::sort(spurs.begin(), spurs.end(), [&](const Spur& a, const Spur& b) {
        return a.edge != b.edge ? a.edge < b.edge
                                : along(edges[a.edge], a.foot) < along(edges[b.edge], b.foot);
    });
    Region2d result;
    std::size_t index = 0;
    auto spur = spurs.begin();
    for (const Contour& contour : ring.contours) {
        Contour path;
        for (const Edge& edge : contour) {
            Vec2d from = edge.start;
            const auto advance = [&](Vec2d to) {
                if (distance(from, to) > 1e-6) {
                    path.push_back(between(edge, from, to));
                    from = to;
                }
            };
            for (; spur != spurs.end() && spur->edge == index; ++spur) {
                advance(spur->foot);
                path.push_back(line_edge(from, spur->end));
                path.push_back(line_edge(spur->end, from));
            }
            advance(edge.end);
            path.back().end = edge.end;
            ++index;
        }
        result.contours.push_back(std::move(path));
    }
    return result;
}

}  // namespace

std::optional<Region2d> with_corner_cleanup(const Region2d& ring,
                                            const Region2d& border,
                                            const RegionOffset& source,
                                            const CleanupSpace& space)
{
    if (ring.contours.empty()) {
        return border.contours.empty() ? std::optional<Region2d>{ring} : std::nullopt;
    }
    const double reach = space.reach;
    const std::vector<Edge> edges = edges_of(ring);
    const EdgeTree tree{edges};
    UncutStrip rest{source, edges, tree, space};
    std::vector<Spur> spurs;
    for (const Contour& contour : border.contours) {
        for (const auto& stretch : far_stretches(rest.lines_from(contour), rest)) {
            const auto spur = spur_for(stretch, tree, rest, reach);
            if (!spur || !keeps_room(source, spur->foot, spur->end, space.wall_distance)) {
                return std::nullopt;
            }
            spurs.push_back(*spur);
        }
    }
    return spurs.empty() ? ring : with_spurs(ring, std::move(spurs));
}

bool starts_cleanup_spur(const Contour& contour, std::size_t edge)
{
    constexpr double kOnePoint = 1e-9;  // mm
    return edge + 1 < contour.size() && contour[edge].turn == 0 && contour[edge + 1].turn == 0 &&
           distance(contour[edge].start, contour[edge + 1].end) < kOnePoint;
}

}  // namespace cusp::clearing
