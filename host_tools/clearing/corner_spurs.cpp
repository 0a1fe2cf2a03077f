// One spur for each stretch of the rest's border that lies too far, checked along the stretch.
#include "host_tools/clearing/corner_spurs.hpp"

#include <algorithm>

#include "host_tools/offset/edge_tree.hpp"

namespace cusp::host {

namespace {

// The border of the rest may lie at just this reach from all of a level.
constexpr double kRounding = 1.000001;

struct FarPoint {
    Vec2d at;
    double apart;
};

struct Spur {
    std::size_t edge;  // counted over all contours
    Vec2d foot;
    Vec2d end;
};

std::vector<FarPoint> border_points(const Contour& border, const EdgeTree& tree, double reach)
{
    std::vector<FarPoint> points;
    for (const Edge& edge : border) {
        const int n = 1 + static_cast<int>(4.0 * length(edge) / reach);
        for (int i = 0; i < n; ++i) {
            const Vec2d p = point_on(edge, static_cast<double>(i) / n);
            const bool near = tree.any_nearer(p, reach * kRounding);
            points.push_back({p, near ? 0.0 : tree.nearest(p, 1e300)});
        }
    }
    return points;
}

// The points start at one within reach, or all lie beyond it.
std::vector<std::vector<FarPoint>> far_stretches(std::vector<FarPoint> points, double reach)
{
    const auto within = [&](const FarPoint& p) {
        return p.apart <= reach;
    };
    const auto first = std::find_if(points.begin(), points.end(), within);
    if (first != points.end()) {
        std::rotate(points.begin(), first, points.end());
    }
    std::vector<std::vector<FarPoint>> stretches;
    bool open = false;
    for (const FarPoint& p : points) {
        if (within(p)) {
            open = false;
            continue;
        }
        if (!open) {
            stretches.emplace_back();
            open = true;
        }
        stretches.back().push_back(p);
    }
    return stretches;
}

// The clearance changes by no more than the way.
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

std::optional<Spur> spur_for(const std::vector<FarPoint>& stretch,
                             const EdgeTree& tree,
                             double reach)
{
    const FarPoint farthest =
        *std::max_element(stretch.begin(), stretch.end(),
                          [](const FarPoint& a, const FarPoint& b) { return a.apart < b.apart; });
    const EdgeTree::Nearest foot = tree.nearest_edge(farthest.at);
    const Vec2d back = foot.point - farthest.at;
    const Vec2d end = farthest.at + back * (reach / farthest.apart);
    const Edge line = line_edge(foot.point, end);
    const bool covered = std::all_of(stretch.begin(), stretch.end(), [&](const FarPoint& p) {
        return distance_to(line, p.at) <= reach * kRounding;
    });
    if (!covered) {
        return std::nullopt;
    }
    return Spur{foot.edge, foot.point, end};
}

// Where along its edge the spur leaves; ordered as the path goes.
double along(const Edge& edge, Vec2d foot) { return dot(foot - edge.start, edge.end - edge.start); }

Region2d with_spurs(const Region2d& level, std::vector<Spur> spurs)
{
    const std::vector<Edge> edges = edges_of(level);
    std::sort(spurs.begin(), spurs.end(), [&](const Spur& a, const Spur& b) {
        return a.edge != b.edge ? a.edge < b.edge
                                : along(edges[a.edge], a.foot) < along(edges[b.edge], b.foot);
    });
    Region2d result;
    std::size_t index = 0;
    auto spur = spurs.begin();
    for (const Contour& contour : level.contours) {
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

std::optional<Region2d> with_corner_spurs(const Region2d& level,
                                          const Region2d& rest,
                                          double reach,
                                          const RegionOffset& source,
                                          double room)
{
    if (level.contours.empty()) {
        return rest.contours.empty() ? std::optional<Region2d>{level} : std::nullopt;
    }
    const EdgeTree tree{edges_of(level)};
    std::vector<Spur> spurs;
    for (const Contour& border : rest.contours) {
        for (const auto& stretch : far_stretches(border_points(border, tree, reach), reach)) {
            const auto spur = spur_for(stretch, tree, reach);
            if (!spur || !keeps_room(source, spur->foot, spur->end, room)) {
                return std::nullopt;
            }
            spurs.push_back(*spur);
        }
    }
    return spurs.empty() ? level : with_spurs(level, std::move(spurs));
}

}  // namespace cusp::host
