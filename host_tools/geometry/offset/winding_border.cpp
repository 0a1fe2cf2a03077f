// Winding numbers spread from vertex to vertex: one ray for each connected part finds the first.
#include "host_tools/geometry/offset/winding_border.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::offset {

namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

Windings sum(Windings a, Windings b, int sign) { return {a[0] + sign * b[0], a[1] + sign * b[1]}; }

// Equal and opposite segments in one.
struct Side {
    std::uint32_t low;  // vertices
    std::uint32_t high;
    std::uint32_t source;
    bool backwards;  // from low to high: to the source
    Windings step;   // left of the way from low to high, less right of it
    Windings left{};
};

std::vector<Side> sides_of(const std::vector<Segment>& segments, std::size_t first_of_b)
{
    std::vector<Side> all;
    for (const Segment& s : segments) {
        const bool backwards = s.from > s.to;
        Windings step{};
        step[s.source < first_of_b ? 0 : 1] = backwards ? -1 : 1;
        all.push_back({std::min(s.from, s.to), std::max(s.from, s.to), s.source, backwards, step});
    }
    std::stable_sort(all.begin(), all.end(), [](const Side& a, const Side& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    std::vector<Side> sides;
    for (std::size_t i = 0; i < all.size();) {
        Side side = all[i];
        for (++i; i < all.size() && all[i].low == side.low && all[i].high == side.high; ++i) {
            side.step = sum(side.step, all[i].step, 1);
        }
        if (side.step != Windings{}) {
            sides.push_back(side);
        }
    }
    return sides;
}

class Subdivision {
public:
    Subdivision(const GridPoints& points, std::vector<Side> sides)
        : points_{points}, sides_{std::move(sides)}, first_(points.size() + 1)
    {
        for (std::uint32_t i = 0; i < sides_.size(); ++i) {
            spokes_.push_back({sides_[i].low, i, true});
            spokes_.push_back({sides_[i].high, i, false});
        }
        std::sort(spokes_.begin(), spokes_.end(),
                  [&](const Spoke& a, const Spoke& b) { return is_before(a, b); });
        slots_.resize(spokes_.size());
        for (std::uint32_t k = 0; k < spokes_.size(); ++k) {
            slots_[2 * spokes_[k].side + (spokes_[k].forward ? 1 : 0)] = k;
            ++first_[spokes_[k].vertex + 1];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        order_.resize(points.size());
        std::iota(order_.begin(), order_.end(), 0U);
        std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            const GridPoint p = points_.point(a);
            const GridPoint q = points_.point(b);
            return p.x != q.x ? p.x < q.x : p.y < q.y;
        });
    }

    void spread_windings()
    {
        const EdgeTree tree{segments()};
        std::vector<bool> reached(points_.size(), false);
        std::vector<Visit> todo;
        for (const std::uint32_t vertex : order_) {
            if (reached[vertex] || first_[vertex] == first_[vertex + 1]) {
                continue;
            }
            // The least vertex of its part: nothing of the part is to its left, and its spokes
            // begin from there.
            reached[vertex] = true;
            todo.push_back({first_[vertex], left_of(vertex, tree)});
            while (!todo.empty()) {
                const Visit visit = todo.back();
                todo.pop_back();
                spread(visit, reached, todo);
            }
        }
    }

    std::vector<std::vector<BorderPart>> border(bool (*is_in)(Windings))
    {
        kept_.assign(spokes_.size(), false);
        for (std::uint32_t k = 0; k < spokes_.size(); ++k) {
            const Side& side = sides_[spokes_[k].side];
            const bool left = is_in(side.left);
            const bool right = is_in(sum(side.left, side.step, -1));
            kept_[k] = left != right && left == spokes_[k].forward;
        }
        used_.assign(spokes_.size(), false);
        place_.assign(points_.size(), kNone);
        std::vector<std::vector<BorderPart>> loops;
        for (const std::uint32_t vertex : order_) {
            for (std::uint32_t k = first_[vertex]; k < first_[vertex + 1]; ++k) {
                if (kept_[k] && !used_[k]) {
                    trace(k, loops);
                }
            }
        }
        return loops;
    }

private:
    // A side seen from one of its ends. Those of a vertex are in order of their angles, from -x on.
    struct Spoke {
        std::uint32_t vertex;
        std::uint32_t side;
        bool forward;  // from low to high
    };

    struct Visit {
        std::uint32_t spoke;
        Windings before;  // right of the spoke
    };

    std::uint32_t end_of(const Spoke& spoke) const
    {
        return spoke.forward ? sides_[spoke.side].high : sides_[spoke.side].low;
    }

    std::uint32_t twin_of(std::uint32_t k) const
    {
        return slots_[2 * spokes_[k].side + (spokes_[k].forward ? 0 : 1)];
    }

    bool is_before(const Spoke& a, const Spoke& b) const
    {
        if (a.vertex != b.vertex) {
            return a.vertex < b.vertex;
        }
        const GridPoint p = points_.point(end_of(a)) - points_.point(a.vertex);
        const GridPoint q = points_.point(end_of(b)) - points_.point(a.vertex);
        const bool low = p.y < 0 || (p.y == 0 && p.x > 0);
        const bool other_low = q.y < 0 || (q.y == 0 && q.x > 0);
        return low != other_low ? low : cross(p, q) > 0;
    }

    std::vector<Edge> segments() const
    {
        std::vector<Edge> edges;
        for (const Side& side : sides_) {
            edges.push_back(line_edge(exact(side.low), exact(side.high)));
        }
        return edges;
    }

    Vec2d exact(std::uint32_t vertex) const
    {
        const GridPoint p = points_.point(vertex);
        return {static_cast<double>(p.x), static_cast<double>(p.y)};
    }

    // The winding numbers left of a vertex that begins its part.
    Windings left_of(std::uint32_t vertex, const EdgeTree& tree) const
    {
        Windings out{};
        const GridPoint p = points_.point(vertex);
        const Vec2d at = exact(vertex);
        tree.visit_meeting({-kUnbounded, at.y, at.x, at.y}, [&](std::uint32_t i) {
            const GridPoint a = points_.point(sides_[i].low);
            const GridPoint b = points_.point(sides_[i].high);
            const bool falls = a.y > p.y;
            if (falls == (b.y > p.y)) {
                return;
            }
            const WideInt turn = cross(b - a, p - a);
            if (falls ? turn > 0 : turn < 0) {
                // A side that falls has its left to the east, where the vertex is.
                out = sum(out, sides_[i].step, falls ? 1 : -1);
            }
        });
        return out;
    }

    void spread(const Visit& visit, std::vector<bool>& reached, std::vector<Visit>& todo)
    {
        const std::uint32_t vertex = spokes_[visit.spoke].vertex;
        const std::uint32_t count = first_[vertex + 1] - first_[vertex];
        Windings before = visit.before;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t k = first_[vertex] + (visit.spoke - first_[vertex] + i) % count;
            const Spoke& spoke = spokes_[k];
            Side& side = sides_[spoke.side];
            const Windings after = sum(before, side.step, spoke.forward ? 1 : -1);
            side.left = spoke.forward ? after : before;
            const std::uint32_t other = end_of(spoke);
            if (!reached[other]) {
                reached[other] = true;
                todo.push_back({twin_of(k), after});
            }
            before = after;
        }
    }

    // The kept spoke that goes on at the end of one, by the sharpest left turn.
    // Throws std::logic_error where there is none: the winding numbers contradict each other.
    std::uint32_t next_of(std::uint32_t k) const
    {
        const std::uint32_t back = twin_of(k);
        const std::uint32_t vertex = spokes_[back].vertex;
        std::uint32_t at = back;
        do {
            at = at == first_[vertex] ? first_[vertex + 1] - 1 : at - 1;
        } while (!kept_[at] && at != back);
        if (!kept_[at]) {
            throw std::logic_error{"a border of winding numbers ends at a vertex"};
        }
        return at;
    }

    BorderPart part_of(std::uint32_t k) const
    {
        const Spoke& spoke = spokes_[k];
        const Side& side = sides_[spoke.side];
        const auto begin = kept_.begin() + first_[spoke.vertex];
        const auto end = kept_.begin() + first_[spoke.vertex + 1];
        return {{spoke.vertex, end_of(spoke), side.source},
                side.backwards == spoke.forward,
                std::count(begin, end, true) > 1};
    }

    // From a spoke on until it comes back to it. A loop within, at a vertex that comes twice, is one
    // of its own.
    void trace(std::uint32_t start, std::vector<std::vector<BorderPart>>& loops)
    {
        std::vector<BorderPart> path;
        std::uint32_t k = start;
        do {
            used_[k] = true;
            place_[spokes_[k].vertex] = static_cast<std::uint32_t>(path.size());
            path.push_back(part_of(k));
            const std::uint32_t end = path.back().segment.to;
            if (place_[end] != kNone) {
                const auto from = path.begin() + place_[end];
                loops.emplace_back(from, path.end());
                for (auto part = from; part != path.end(); ++part) {
                    place_[part->segment.from] = kNone;
                }
                path.erase(from, path.end());
            }
            k = next_of(k);
            if (used_[k] && k != start) {
                throw std::logic_error{"a border of winding numbers meets itself"};
            }
        } while (k != start);
    }

    const GridPoints& points_;
    std::vector<Side> sides_;
    std::vector<Spoke> spokes_;
    std::vector<std::uint32_t> slots_;  // of a side's two spokes
    std::vector<std::uint32_t> first_;  // spoke of each vertex
    std::vector<std::uint32_t> order_;  // vertices by x and y
    std::vector<bool> kept_;            // spokes with the border's inside on their left
    std::vector<bool> used_;
    std::vector<std::uint32_t> place_;  // of a vertex in the path that is traced
};

}  // namespace

std::vector<std::vector<BorderPart>> winding_border(const std::vector<Segment>& segments,
                                                    const GridPoints& points,
                                                    std::size_t first_of_b,
                                                    bool (*is_in)(Windings))
{
    Subdivision subdivision{points, sides_of(segments, first_of_b)};
    subdivision.spread_windings();
    return subdivision.border(is_in);
}

}  // namespace cusp::offset
