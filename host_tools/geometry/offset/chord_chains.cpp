// A chord stands for its arc while the triangle of the chord and the tangents at its ends meets
// nothing else.
#include "host_tools/geometry/offset/chord_chains.hpp"

#include <algorithm>
#include <array>

#include "host_tools/geometry/offset/edge_crossings.hpp"
#include "host_tools/geometry/offset/edge_runs.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::offset {

namespace {

constexpr double kOverrun = 1e-9;  // mm: a crossing may lie this far beyond an edge's end
constexpr double kFlat = 1e-6;     // mm: sagitta of a chord that is as good as its arc
constexpr double kApart = 3e-6;    // mm: between triangles without a common vertex
constexpr double kBeside = 1e-7;   // mm: between triangles, farthest from their common vertex

Box2d grown_box(const Box2d& box, double by)
{
    return {box.x0 - by, box.y0 - by, box.x1 + by, box.y1 + by};
}

// Cuts edges where they meet.
class EdgeCutter {
public:
    EdgeCutter(const std::vector<Edge>& edges, GridPoints& points) : edges_{edges}, points_{points}
    {
        for (const Edge& edge : edges) {
            ends_.push_back({points.near(edge.start), points.near(edge.end)});
        }
    }

    std::vector<Segment> run()
    {
        const EdgeTree tree{edges_};
        for (std::uint32_t i = 0; i < edges_.size(); ++i) {
            tree.visit_meeting(grown_box(box_of(edges_[i]), kSameVertex), [&](std::uint32_t j) {
                if (i != j) {
                    cut_at_ends(i, j);
                }
                if (i < j) {
                    cut_at_crossings(i, j);
                }
            });
        }
        std::sort(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) {
            return a.edge != b.edge     ? a.edge < b.edge
                   : a.along != b.along ? a.along < b.along
                                        : a.vertex < b.vertex;
        });
        return segments();
    }

private:
    struct Cut {
        std::uint32_t edge;
        std::uint32_t vertex;
        double along;
    };

    void cut(std::uint32_t i, std::uint32_t vertex)
    {
        if (vertex != ends_[i][0] && vertex != ends_[i][1]) {
            cuts_.push_back({i, vertex, share_of_chord(edges_[i], points_.place(vertex))});
        }
    }

    void cut_at_ends(std::uint32_t i, std::uint32_t j)
    {
        for (const std::uint32_t vertex : ends_[j]) {
            if (distance_to(edges_[i], points_.place(vertex)) <= kSameVertex) {
                cut(i, vertex);
            }
        }
    }

    void cut_at_crossings(std::uint32_t i, std::uint32_t j)
    {
        for (const Vec2d p : crossings(edges_[i], edges_[j], kOverrun)) {
            const std::uint32_t vertex = points_.near(p);
            cut(i, vertex);
            cut(j, vertex);
        }
    }

    std::vector<Segment> segments() const
    {
        std::vector<Segment> out;
        std::size_t k = 0;
        for (std::uint32_t i = 0; i < edges_.size(); ++i) {
            std::uint32_t from = ends_[i][0];
            const auto lead_to = [&](std::uint32_t vertex) {
                if (vertex != from) {
                    out.push_back({from, vertex, i});
                    from = vertex;
                }
            };
            for (; k < cuts_.size() && cuts_[k].edge == i; ++k) {
                lead_to(cuts_[k].vertex);
            }
            lead_to(ends_[i][1]);
        }
        return out;
    }

    const std::vector<Edge>& edges_;
    GridPoints& points_;
    std::vector<std::array<std::uint32_t, 2>> ends_;
    std::vector<Cut> cuts_;
};

// The triangle around an arc, or a segment: then all of `bend` is its end.
struct Hull {
    Vec2d from;
    Vec2d to;
    Vec2d bend;
};

Box2d box_of(const Hull& hull)
{
    const auto [x0, x1] = std::minmax({hull.from.x, hull.to.x, hull.bend.x});
    const auto [y0, y1] = std::minmax({hull.from.y, hull.to.y, hull.bend.y});
    return {x0, y0, x1, y1};
}

// True if a line along a side of `a` has `a` on one side, and `b` on the other, farther than `gap`.
bool side_separates(const Hull& a, const Hull& b, double gap)
{
    const Vec2d corners[]{a.from, a.to, a.bend};
    for (int k = 0; k < 3; ++k) {
        const Vec2d at = corners[k];
        const Vec2d normal = left_normal(unit(corners[(k + 1) % 3] - at));
        const double own = dot(normal, corners[(k + 2) % 3] - at);
        const double to_b[]{dot(normal, b.from - at), dot(normal, b.to - at),
                            dot(normal, b.bend - at)};
        const auto [low, high] = std::minmax({to_b[0], to_b[1], to_b[2]});
        if (low > std::max(own, 0.0) + gap || high < std::min(own, 0.0) - gap) {
            return true;
        }
    }
    return false;
}

// Halves arcs until their chords may stand for them, pair by pair: the triangles of an arc's halves
// lie within its own, so what was apart from it stays apart from them.
class ArcHalver {
public:
    ArcHalver(const std::vector<Edge>& edges,
              const std::vector<Segment>& segments,
              GridPoints& points)
        : edges_{edges}, points_{points}, roots_{segments.size()}
    {
        for (const Segment& segment : segments) {
            add(segment);
        }
    }

    std::vector<Segment> run()
    {
        const std::vector<std::uint32_t> narrow = narrow_pieces();
        std::vector<Edge> diagonals;
        diagonals.reserve(narrow.size());
        for (const std::uint32_t i : narrow) {
            diagonals.push_back(line_edge({pieces_[i].box.x0, pieces_[i].box.y0},
                                          {pieces_[i].box.x1, pieces_[i].box.y1}));
        }
        const EdgeTree tree{std::move(diagonals)};
        for (std::uint32_t k = 0; k < narrow.size(); ++k) {
            if (pieces_[narrow[k]].bent) {
                tree.visit_meeting(grown_box(pieces_[narrow[k]].box, kApart), [&](std::uint32_t m) {
                    if (m > k || (m < k && !pieces_[narrow[m]].bent)) {
                        separate(narrow[k], narrow[m]);
                    }
                });
            }
        }
        std::vector<Segment> out;
        visit_leaves([&](std::uint32_t i) { out.push_back(pieces_[i].segment); });
        return out;
    }

private:
    struct Piece {
        Segment segment;
        Hull hull;
        Box2d box;           // of its hull
        bool bent;           // its chord is not as good as its arc
        std::uint32_t half;  // the first of its two halves, or 0
    };

    void add(const Segment& segment)
    {
        const bool bent = edges_[segment.source].turn != 0 && sagitta(segment) > kFlat;
        const Hull hull = hull_of(segment);
        pieces_.push_back({segment, hull, box_of(hull), bent, 0});
    }

    // False where it cannot be halved.
    bool halve(std::uint32_t i)
    {
        if (pieces_[i].half != 0 || !pieces_[i].bent) {
            return pieces_[i].half != 0;
        }
        const Segment s = pieces_[i].segment;
        const std::uint32_t middle = points_.near(middle_of(s));
        pieces_[i].bent = middle != s.from && middle != s.to;
        if (pieces_[i].bent) {
            pieces_[i].half = static_cast<std::uint32_t>(pieces_.size());
            add({s.from, middle, s.source});
            add({middle, s.to, s.source});
        }
        return pieces_[i].bent;
    }

    template <class Visit>
    void visit_leaves(Visit visit) const
    {
        std::vector<std::uint32_t> todo;
        for (std::uint32_t root = 0; root < roots_; ++root) {
            todo.push_back(root);
            while (!todo.empty()) {
                const std::uint32_t i = todo.back();
                todo.pop_back();
                if (pieces_[i].half == 0) {
                    visit(i);
                } else {
                    todo.push_back(pieces_[i].half + 1);
                    todo.push_back(pieces_[i].half);
                }
            }
        }
    }

    // Leaves, after those of more than a quarter turn are halved.
    std::vector<std::uint32_t> narrow_pieces()
    {
        for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
            if (is_wide(pieces_[i].segment)) {
                halve(i);
            }
        }
        std::vector<std::uint32_t> leaves;
        visit_leaves([&](std::uint32_t i) { leaves.push_back(i); });
        return leaves;
    }

    // Halves both while their triangles have more than a vertex in common.
    void separate(std::uint32_t i, std::uint32_t j)
    {
        if (!meet(grown_box(pieces_[i].box, kApart), pieces_[j].box) || apart(i, j)) {
            return;
        }
        const bool halved = halve(i);
        const std::uint32_t first = halved ? pieces_[i].half : i;
        const bool other_halved = halve(j);
        const std::uint32_t other_first = other_halved ? pieces_[j].half : j;
        if (halved || other_halved) {
            for (std::uint32_t k = first; k <= first + (halved ? 1 : 0); ++k) {
                for (std::uint32_t m = other_first; m <= other_first + (other_halved ? 1 : 0);
                     ++m) {
                    separate(k, m);
                }
            }
        }
    }

    Vec2d middle_of(const Segment& s) const
    {
        const Edge& edge = edges_[s.source];
        const Vec2d from = points_.place(s.from);
        const Vec2d to = points_.place(s.to);
        const Vec2d chord_middle = 0.5 * (from + to);
        if (edge.turn == 0) {
            return chord_middle;
        }
        // Each is exact where the other is not.
        const Vec2d way = is_wide(s) ? left_normal(unit(to - from)) * -edge.turn
                                     : unit(chord_middle - edge.centre);
        return edge.centre + way * edge.radius;
    }

    double sagitta(const Segment& s) const
    {
        return distance(middle_of(s), 0.5 * (points_.place(s.from) + points_.place(s.to)));
    }

    Hull hull_of(const Segment& s) const
    {
        const Edge& edge = edges_[s.source];
        const Vec2d from = points_.place(s.from);
        const Vec2d to = points_.place(s.to);
        const Vec2d arm = 0.5 * (from + to) - edge.centre;
        if (edge.turn == 0 || sagitta(s) <= kFlat || is_wide(s)) {
            return {from, to, is_wide(s) ? middle_of(s) : to};
        }
        return {from, to, edge.centre + arm * (edge.radius * edge.radius / dot(arm, arm))};
    }

    // True for more than a quarter turn: its triangle is far from it.
    bool is_wide(const Segment& s) const
    {
        const Edge& edge = edges_[s.source];
        const Vec2d arm = 0.5 * (points_.place(s.from) + points_.place(s.to)) - edge.centre;
        return edge.turn != 0 && dot(arm, arm) < 0.49 * edge.radius * edge.radius &&
               edge.radius > kSameVertex;
    }

    // True if the triangles of two segments have nothing in common but a vertex.
    bool apart(std::uint32_t i, std::uint32_t j) const
    {
        const Segment& a = pieces_[i].segment;
        const Segment& b = pieces_[j].segment;
        const Hull& hull = pieces_[i].hull;
        const Hull& other = pieces_[j].hull;
        if (a.from != b.from && a.from != b.to && a.to != b.from && a.to != b.to) {
            return side_separates(hull, other, kApart) || side_separates(other, hull, kApart);
        }
        const bool along = a.from == b.from && a.to == b.to;
        if (along || (a.from == b.to && a.to == b.from)) {
            return distance(middle_of(a), middle_of(b)) <= kSameVertex;
        }
        return beside(hull, other, a.from == b.from || a.from == b.to,
                      b.from == a.from || b.from == a.to);
    }

    // True if a line through the common vertex lies between.
    //
    // at_from, other_at_from  which end the vertex is
    static bool beside(const Hull& a, const Hull& b, bool at_from, bool other_at_from)
    {
        const Vec2d vertex = at_from ? a.from : a.to;
        const auto arm = [&](const Hull& hull, bool from, bool bend) {
            const bool bent = norm(hull.bend - hull.to) > 0.0;
            return (bend && bent ? hull.bend : from ? hull.to : hull.from) - vertex;
        };
        const Vec2d arms[]{arm(a, at_from, false), arm(a, at_from, true)};
        const Vec2d others[]{arm(b, other_at_from, false), arm(b, other_at_from, true)};
        const auto separates = [&](Vec2d way, const Vec2d* own, const Vec2d* far) {
            const Vec2d normal = left_normal(unit(way));
            const double own_side = std::abs(dot(normal, own[0])) > std::abs(dot(normal, own[1]))
                                        ? dot(normal, own[0])
                                        : dot(normal, own[1]);
            const double sign = own_side > 0.0 ? -1.0 : 1.0;
            const bool flat = std::abs(own_side) <= 1e-12;
            const double x = dot(normal, far[0]);
            const double y = dot(normal, far[1]);
            return std::min(sign * x, sign * y) > kBeside || (flat && std::max(x, y) < -kBeside);
        };
        for (int k = 0; k < 2; ++k) {
            if (separates(arms[k], arms, others) || separates(others[k], others, arms)) {
                return true;
            }
        }
        return false;
    }

    const std::vector<Edge>& edges_;
    GridPoints& points_;
    std::size_t roots_;
    std::vector<Piece> pieces_;  // roots first, then halves
};

}  // namespace

std::vector<Segment> chord_chains(const std::vector<Edge>& edges, GridPoints& points)
{
    return ArcHalver{edges, EdgeCutter{edges, points}.run(), points}.run();
}

}  // namespace cusp::offset
