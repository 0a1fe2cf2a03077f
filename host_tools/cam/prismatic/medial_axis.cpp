// At each point of the contours a disc that touches it shrinks until it contains no other contour
// point. While the point goes around the contours, the centre traces the axis: each part twice, once
// for either contact of its disc. One of the two is kept.
#include "host_tools/cam/prismatic/medial_axis.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/offset/edge_tree.hpp"

namespace cusp::prismatic {

using offset::Box2d;
using offset::box_of;
using offset::Contour;
using offset::distance;
using offset::Edge;
using offset::edges_of;
using offset::EdgeTree;
using offset::left_normal;
using offset::nearest_on;
using offset::point_on;
using offset::Region2d;
using offset::tangent_at_end;
using offset::tangent_at_start;
using offset::tangent_on;

namespace {

constexpr double kStraight = kAxisTolerance / 4;  // mm: of a chord from the axis
constexpr double kTouch = 1e-8;                   // mm
constexpr double kSamePlace = 1e-4;               // mm: a step across a fork of the axis
constexpr double kReflex = 1e-7;                  // radians

// The disc that touches the contours at `contact`, and its other contact.
struct Disc {
    Vec2d at;
    double radius;
    Vec2d contact;
    Vec2d other;
    std::size_t slot;        // of contact: 2 n on edge n, 2 n + 1 at the corner after it
    std::size_t other_slot;  // `slot` where nothing stopped it but the bend of its own edge
};

// The radius of the circle with its centre on the ray from `contact` along `normal`, through contact, that
// touches a point.
double through_point(Vec2d contact, Vec2d normal, Vec2d q)
{
    const double along = dot(normal, q - contact);
    const double squared = dot(q - contact, q - contact);
    return along > 0 ? squared / (2 * along) : kUnbounded;
}

// As above, for the line or the circle of an edge, which has the region on its left.
double tangent_radius(Vec2d contact, Vec2d normal, const Edge& edge)
{
    if (edge.turn == 0) {
        const Vec2d inward = left_normal(tangent_at_start(edge));
        const double closing = 1 - dot(normal, inward);
        return closing > 0 ? dot(contact - edge.start, inward) / closing : kUnbounded;
    }
    const Vec2d w = contact - edge.centre;
    // inside a circle to the left, outside of one to the right
    const double sum = 2 * (dot(w, normal) + edge.turn * edge.radius);
    const double radius = (edge.radius * edge.radius - dot(w, w)) / sum;
    return sum != 0 && radius > 0 ? radius : kUnbounded;
}

class AxisWalk {
public:
    explicit AxisWalk(const Region2d& region)
        : edges_{edges_of(region)}, tree_{edges_}, reflex_(edges_.size()), before_(edges_.size())
    {
        const Box2d box = box_of(region);
        largest_ = elementary::hypot(box.x1 - box.x0, box.y1 - box.y0);
        std::size_t first = 0;
        for (const Contour& contour : region.contours) {
            const std::size_t size = contour.size();
            for (std::size_t k = 0; k < size; ++k) {
                const std::size_t next = first + (k + 1) % size;
                const Vec2d from = tangent_at_end(edges_[first + k]);
                const Vec2d to = tangent_at_start(edges_[next]);
                reflex_[first + k] =
                    std::max(0.0, -elementary::atan2(cross(from, to), dot(from, to)));
                before_[next] = first + k;
            }
            first += size;
        }
    }

    std::vector<AxisBranch> branches()
    {
        for (std::size_t k = 0; k < edges_.size(); ++k) {
            walk_edge(k);
            if (reflex_[k] > kReflex) {
                walk_corner(k);
            }
        }
        end_branch();
        add_lone_discs();
        return std::move(branches_);
    }

private:
    std::size_t slot_of(std::size_t edge, Vec2d p) const
    {
        if (distance(p, edges_[edge].end) <= kTouch && reflex_[edge] > kReflex) {
            return 2 * edge + 1;
        }
        const std::size_t before = before_[edge];
        if (distance(p, edges_[edge].start) <= kTouch && reflex_[before] > kReflex) {
            return 2 * before + 1;
        }
        return 2 * edge;
    }

    Disc disc(Vec2d contact, Vec2d normal, double max_radius, std::size_t slot) const
    {
        constexpr int kMostSteps = 200;
        double radius = max_radius;
        std::optional<std::size_t> stop;
        for (int step = 0; step < kMostSteps; ++step) {
            const Vec2d centre = contact + normal * radius;
            const EdgeTree::Nearest near = tree_.nearest_edge(centre);
            if (near.distance >= radius - kTouch) {
                break;
            }
            double shrunk = tangent_radius(contact, normal, edges_[near.edge]);
            const Vec2d q = contact + normal * shrunk;
            if (!(shrunk < radius) ||
                std::abs(distance(nearest_on(edges_[near.edge], q), q) - shrunk) > kTouch) {
                shrunk = through_point(contact, normal, near.point);
            }
            if (!(shrunk < radius)) {
                break;
            }
            radius = shrunk;
            stop = near.edge;
        }
        const Vec2d centre = contact + normal * radius;
        if (!stop) {
            return {centre, radius, contact, contact, slot, slot};
        }
        const Vec2d other = nearest_on(edges_[*stop], centre);
        return {centre, radius, contact, other, slot, slot_of(*stop, other)};
    }

    void walk_edge(std::size_t k)
    {
        constexpr double kLongest = 1.0;   // mm
        constexpr double kWidest = 0.2;    // radians
        constexpr double kFromEnd = 1e-5;  // mm: at a convex corner there is no disc
        const Edge& edge = edges_[k];
        const double size = offset::length(edge);
        const double sweep = edge.turn == 0 ? 0.0 : size / edge.radius;
        const int pieces = 2 + static_cast<int>(std::max(size / kLongest, sweep / kWidest));
        const double end = std::min(0.25, kFromEnd / size);
        const auto at = [&](double share) {
            return disc(point_on(edge, share), left_normal(tangent_on(edge, share)),
                        edge.turn > 0 ? edge.radius : largest_, 2 * k);
        };
        walk(at, pieces, end);
    }

    // Around the corner after edge k, from the normal of one edge to that of the next.
    void walk_corner(std::size_t k)
    {
        constexpr double kWidest = 0.1;  // radians
        const Vec2d corner = edges_[k].end;
        const Vec2d first = left_normal(tangent_at_end(edges_[k]));
        const auto at = [&](double share) {
            const double angle = -share * reflex_[k];
            const Vec2d normal =
                first * elementary::cos(angle) + left_normal(first) * elementary::sin(angle);
            return disc(corner, normal, largest_, 2 * k + 1);
        };
        walk(at, 2 + static_cast<int>(reflex_[k] / kWidest), 0.0);
    }

    template <class At>
    void walk(const At& at, int pieces, double end)
    {
        Disc from = at(end);
        double share = end;
        for (int i = 1; i <= pieces; ++i) {
            const double next = end + (1 - 2 * end) * i / pieces;
            const Disc to = at(next);
            refine(at, share, from, next, to, 0);
            from = to;
            share = next;
        }
    }

    // Halves the step until the axis is straight between its ends, or a fork lies between equal points.
    template <class At>
    void refine(const At& at, double a, const Disc& from, double b, const Disc& to, int depth)
    {
        constexpr int kMostHalvings = 45;
        const double middle = (a + b) / 2;
        const Disc half = at(middle);
        const bool short_enough =
            distance(from.at, to.at) <= kSamePlace && distance(from.at, half.at) <= kSamePlace;
        if (depth >= kMostHalvings || short_enough ||
            (is_straight(from, half, to) && is_straight(from, at(a + (b - a) / 4), half) &&
             is_straight(half, at(a + (b - a) * 3 / 4), to))) {
            add(from, half, to);
            return;
        }
        refine(at, a, from, middle, half, depth + 1);
        refine(at, middle, half, b, to, depth + 1);
    }

    static bool is_on_chord(const AxisPoint& from, const AxisPoint& between, const AxisPoint& to)
    {
        const Vec2d along = to.at - from.at;
        const double squared = dot(along, along);
        const double share =
            squared > 0 ? std::clamp(dot(between.at - from.at, along) / squared, 0.0, 1.0) : 0.0;
        return distance(between.at, from.at + share * along) <= kStraight &&
               std::abs(between.radius - from.radius - share * (to.radius - from.radius)) <=
                   kStraight;
    }

    static bool is_straight(const Disc& from, const Disc& between, const Disc& to)
    {
        if (from.other_slot != to.other_slot || between.other_slot != to.other_slot) {
            return false;
        }
        return is_on_chord({from.at, from.radius}, {between.at, between.radius},
                           {to.at, to.radius});
    }

    // mm: height of the corner left between the disc and the two points that it touches.
    static double sharpness(const Disc& disc)
    {
        if (disc.slot == disc.other_slot || !(disc.radius > 0)) {
            return 0;
        }
        const Vec2d a = (disc.contact - disc.at) * (1 / disc.radius);
        const Vec2d b = (disc.other - disc.at) * (1 / disc.radius);
        const double cosine = std::sqrt(std::max(0.0, (1 + dot(a, b)) / 2));
        return cosine > 0 ? disc.radius * (1 / cosine - 1) : kUnbounded;
    }

    void add(const Disc& from, const Disc& half, const Disc& to)
    {
        const bool blunt = sharpness(from) <= kAxisTolerance && sharpness(to) <= kAxisTolerance &&
                           sharpness(half) <= kAxisTolerance;
        if (blunt) {
            end_branch();
            if (!lone_ || to.radius > lone_->radius) {
                lone_ = AxisPoint{to.at, to.radius};
            }
            return;
        }
        if (lone_) {
            lone_discs_.push_back(*lone_);
            lone_.reset();
        }
        if (half.slot > half.other_slot) {
            end_branch();
            return;
        }
        // another contour, or beyond a convex corner
        if (!branch_.empty() && distance(branch_.back().at, from.at) > kSamePlace) {
            end_branch();
        }
        if (branch_.empty()) {
            branch_.push_back({from.at, from.radius});
        }
        extend({to.at, to.radius});
    }

    // Adds the point; removes those before it that a chord replaces within tolerance.
    void extend(const AxisPoint& to)
    {
        constexpr double kSame = 1e-7;  // mm
        if (distance(branch_.back().at, to.at) <= kSame) {
            return;
        }
        if (branch_.size() > 1) {
            const AxisPoint& first = branch_[branch_.size() - 2];
            left_out_.push_back(branch_.back());
            if (std::all_of(left_out_.begin(), left_out_.end(), [&](const AxisPoint& between) {
                    return is_on_chord(first, between, to);
                })) {
                branch_.back() = to;
                return;
            }
        }
        left_out_.clear();
        branch_.push_back(to);
    }

    void end_branch()
    {
        if (branch_.size() > 1) {
            shrink(branch_);
            branches_.push_back(std::move(branch_));
        }
        branch_.clear();
        left_out_.clear();
    }

    // Beside a corner a chord is nearer to the contour than its ends are: their discs shrink.
    void shrink(AxisBranch& branch) const
    {
        constexpr int kLooks = 16;
        std::vector<double> over(branch.size(), 0.0);
        for (std::size_t i = 0; i + 1 < branch.size(); ++i) {
            for (int k = 0; k <= kLooks; ++k) {
                const double share = static_cast<double>(k) / kLooks;
                const double radius =
                    branch[i].radius + share * (branch[i + 1].radius - branch[i].radius);
                const Vec2d p = branch[i].at + share * (branch[i + 1].at - branch[i].at);
                const double much = radius - tree_.nearest(p, radius);
                over[i] = std::max(over[i], much);
                over[i + 1] = std::max(over[i + 1], much);
            }
        }
        for (std::size_t i = 0; i < branch.size(); ++i) {
            branch[i].radius = std::max(0.0, branch[i].radius - over[i]);
        }
    }

    // The largest disc of a bend, where no disc of a branch nor another one covers it.
    void add_lone_discs()
    {
        if (lone_) {
            lone_discs_.push_back(*lone_);
        }
        std::stable_sort(
            lone_discs_.begin(), lone_discs_.end(),
            [](const AxisPoint& a, const AxisPoint& b) { return a.radius > b.radius; });
        for (const AxisPoint& disc : lone_discs_) {
            const bool covered =
                std::any_of(branches_.begin(), branches_.end(), [&](const AxisBranch& branch) {
                    return std::any_of(branch.begin(), branch.end(), [&](const AxisPoint& p) {
                        return distance(p.at, disc.at) + disc.radius <=
                               p.radius + 2 * kAxisTolerance;
                    });
                });
            if (!covered) {
                branches_.push_back({{disc.at, tree_.nearest(disc.at, disc.radius)}});
            }
        }
    }

    std::vector<Edge> edges_;
    EdgeTree tree_;
    std::vector<double> reflex_;       // radians: of the corner after each edge, 0 where convex
    std::vector<std::size_t> before_;  // the edge before each
    double largest_;
    AxisBranch branch_;
    std::vector<AxisPoint> left_out_;  // since the last but one of branch_
    std::optional<AxisPoint> lone_;
    std::vector<AxisPoint> lone_discs_;
    std::vector<AxisBranch> branches_;
};

}  // namespace

std::vector<AxisBranch> medial_axis(const Region2d& region)
{
    return region.contours.empty() ? std::vector<AxisBranch>{} : AxisWalk{region}.branches();
}

}  // namespace cusp::prismatic
