// Edges are split at the ends of those that touch them; pieces with a twin in the other direction go.
#include "host_tools/cam/prismatic/common_edges.hpp"

#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::prismatic {

using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::Region2d;

namespace {

constexpr double kCommon = 1e-6;  // mm

struct EdgeBox {
    Vec2d low, high;

    bool meets(const EdgeBox& other) const
    {
        return low.x <= other.high.x + kCommon && other.low.x <= high.x + kCommon &&
               low.y <= other.high.y + kCommon && other.low.y <= high.y + kCommon;
    }
    void add(Vec2d p)
    {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
};

// An arc sweeps less than half a turn: it is within its radius of both ends' box.
EdgeBox bounds_of(const Edge& edge)
{
    EdgeBox box{edge.start, edge.start};
    box.add(edge.end);
    if (edge.turn != 0) {
        const Vec2d middle = offset::point_on(edge, 0.5);
        const double bulge = distance(middle, 0.5 * (edge.start + edge.end));
        box.low = box.low - Vec2d{bulge, bulge};
        box.high = box.high + Vec2d{bulge, bulge};
    }
    return box;
}

EdgeBox bounds_of(const Contour& contour)
{
    EdgeBox box = bounds_of(contour.front());
    for (const Edge& edge : contour) {
        const EdgeBox one = bounds_of(edge);
        box.add(one.low);
        box.add(one.high);
    }
    return box;
}

bool same(Vec2d a, Vec2d b) { return distance(a, b) <= kCommon; }

struct ContourPiece {
    Edge edge;
    std::size_t source;
    EdgeBox box;
    bool gone{false};
};

class CommonEdges {
public:
    explicit CommonEdges(const Region2d& region) : region_{region}, touched_(region.contours.size())
    {
        std::vector<EdgeBox> boxes;
        for (const Contour& contour : region.contours) {
            boxes.push_back(bounds_of(contour));
        }
        for (std::size_t a = 0; a < boxes.size(); ++a) {
            for (std::size_t b = 0; b < boxes.size(); ++b) {
                touched_[a] = touched_[a] || (a != b && boxes[a].meets(boxes[b]));
            }
        }
    }

    ContourGroup run()
    {
        for (std::size_t n = 0; n < region_.contours.size(); ++n) {
            for (const Edge& edge : region_.contours[n]) {
                if (touched_[n]) {
                    pieces_.push_back({edge, n, bounds_of(edge)});
                }
            }
        }
        by_left_end();
        split();
        by_left_end();
        leave_out_twins();
        if (!(out_.common > 0) || !chain()) {
            out_ = {};
            std::fill(touched_.begin(), touched_.end(), false);
        }
        for (std::size_t n = 0; n < region_.contours.size(); ++n) {
            if (!touched_[n]) {
                add(region_.contours[n], n);
            }
        }
        return std::move(out_);
    }

private:
    void add(Contour contour, std::size_t source)
    {
        out_.region.contours.push_back(std::move(contour));
        out_.sources.push_back(source);
    }

    void by_left_end()
    {
        std::stable_sort(
            pieces_.begin(), pieces_.end(),
            [](const ContourPiece& a, const ContourPiece& b) { return a.box.low.x < b.box.low.x; });
    }

    // Calls visit(one, other) for pieces of two contours whose boxes meet, the one further left first.
    template <class Visit>
    void each_pair(const Visit& visit)
    {
        std::vector<std::size_t> open;
        for (std::size_t k = 0; k < pieces_.size(); ++k) {
            const ContourPiece& one = pieces_[k];
            open.erase(std::remove_if(open.begin(), open.end(),
                                      [&](std::size_t n) {
                                          return pieces_[n].box.high.x + kCommon < one.box.low.x;
                                      }),
                       open.end());
            for (const std::size_t n : open) {
                if (pieces_[n].source != one.source && pieces_[n].box.meets(one.box)) {
                    visit(n, k);
                }
            }
            open.push_back(k);
        }
    }

    // At the ends of the others that lie on them.
    void split()
    {
        std::vector<std::vector<Vec2d>> cuts(pieces_.size());
        const auto cut = [&](std::size_t n, Vec2d p) {
            const Edge& edge = pieces_[n].edge;
            if (!same(p, edge.start) && !same(p, edge.end) &&
                offset::distance_to(edge, p) <= kCommon) {
                cuts[n].push_back(p);
            }
        };
        each_pair([&](std::size_t a, std::size_t b) {
            for (const auto& [n, other] : {std::pair{a, b}, std::pair{b, a}}) {
                cut(n, pieces_[other].edge.start);
                cut(n, pieces_[other].edge.end);
            }
        });
        std::vector<ContourPiece> all;
        for (std::size_t n = 0; n < pieces_.size(); ++n) {
            const ContourPiece& piece = pieces_[n];
            std::sort(cuts[n].begin(), cuts[n].end(), [&](Vec2d p, Vec2d q) {
                return distance(piece.edge.start, p) < distance(piece.edge.start, q);
            });
            Vec2d from = piece.edge.start;
            cuts[n].push_back(piece.edge.end);
            for (const Vec2d to : cuts[n]) {
                if (!same(from, to)) {
                    const Edge part = offset::between(piece.edge, from, to);
                    all.push_back({part, piece.source, bounds_of(part)});
                    from = to;
                }
            }
        }
        pieces_ = std::move(all);
    }

    void leave_out_twins()
    {
        double longest = 0;
        each_pair([&](std::size_t a, std::size_t b) {
            ContourPiece& one = pieces_[a];
            ContourPiece& other = pieces_[b];
            const Vec2d middle = offset::point_on(one.edge, 0.5);
            if (!one.gone && !other.gone && same(one.edge.start, other.edge.end) &&
                same(one.edge.end, other.edge.start) &&
                same(middle, offset::point_on(other.edge, 0.5))) {
                one.gone = other.gone = true;
                const double size = offset::length(one.edge);
                out_.common += size;
                if (size > longest) {
                    longest = size;
                    out_.place = middle;
                }
            }
        });
    }

    // If two begin at a place, the one furthest to the left, so that lobes stay apart.
    std::size_t next_after(const Edge& edge) const
    {
        std::size_t found = pieces_.size();
        double best = 0;
        for (std::size_t n = 0; n < pieces_.size(); ++n) {
            if (pieces_[n].gone || !same(pieces_[n].edge.start, edge.end)) {
                continue;
            }
            const Vec2d before = tangent_at_end(edge);
            const Vec2d after = tangent_at_start(pieces_[n].edge);
            const double turn = elementary::atan2(cross(before, after), dot(before, after));
            if (found == pieces_.size() || turn > best) {
                best = turn;
                found = n;
            }
        }
        return found;
    }

    // False where the pieces make no closed contours.
    bool chain()
    {
        for (std::size_t first = 0; first < pieces_.size(); ++first) {
            Contour contour;
            const std::size_t source = pieces_[first].source;
            for (std::size_t at = first; at < pieces_.size() && !pieces_[at].gone;) {
                pieces_[at].gone = true;
                contour.push_back(pieces_[at].edge);
                if (same(contour.back().end, contour.front().start)) {
                    break;
                }
                at = next_after(contour.back());
            }
            if (!contour.empty()) {
                if (!same(contour.back().end, contour.front().start)) {
                    return false;
                }
                for (std::size_t k = 0; k < contour.size(); ++k) {
                    contour[(k + 1) % contour.size()].start = contour[k].end;
                }
                add(std::move(contour), source);
            }
        }
        return true;
    }

    const Region2d& region_;
    std::vector<bool> touched_;
    std::vector<ContourPiece> pieces_;
    ContourGroup out_;
};

}  // namespace

ContourGroup without_common_edges(const Region2d& region) { return CommonEdges{region}.run(); }

}  // namespace cusp::prismatic
