// Cells begin at angles at which no edge ends or runs along, as far as there are such angles.
#include "host_tools/job/import/revolved_cells.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/job/import/cell_loops.hpp"

namespace cusp::import {

namespace {

constexpr double kQuarter = 0.5 * kPi;

// Within -pi and pi.
double wrapped(double angle) { return angle - 2 * kPi * std::floor(angle / (2 * kPi) + 0.5); }

// The shortest way from one (u, v) to another one.
Vec3d way(const Revolved& surface, Vec3d from, Vec3d to)
{
    const double v = to.y - from.y;
    return {wrapped(to.x - from.x), surface.is_ring() ? wrapped(v) : v, 0};
}

// Places where cells begin; no `v` on a line, whose cells reach over all edges.
struct Starts {
    double u;
    double v;
};

struct Cells {
    const Revolved& surface;
    Starts starts;
    Vec2d line;  // v of a line from .. to

    int number(Vec3d uv, unsigned axis) const
    {
        if (axis == 1 && !surface.is_ring()) {
            return 0;
        }
        const double from = axis == 0 ? starts.u : starts.v;
        const double turned = std::floor((uv[axis] - from) / kQuarter);
        return static_cast<int>(turned - 4 * std::floor(turned / 4));
    }
    RevolvedCell cell(int u, int v) const
    {
        const double low_u = starts.u + u * kQuarter;
        const double low_v = surface.is_ring() ? starts.v + v * kQuarter : line.x;
        const double high_v = surface.is_ring() ? low_v + kQuarter : line.y;
        return {{low_u, low_v}, {low_u + kQuarter, high_v}, {}};
    }
};

// An edge at the turn of the cell.
FaceEdge near(const Revolved& surface, const RevolvedCell& cell, const FaceEdge& edge)
{
    const Vec3d middle{0.5 * (cell.low.x + cell.high.x), 0.5 * (cell.low.y + cell.high.y), 0};
    return {[&surface, middle, at = edge.at](double t) {
                const PointAndTangent found = at(t);
                return PointAndTangent{middle + way(surface, middle, found.point), found.tangent};
            },
            edge.from, edge.to};
}

// A rectangle in (u, v).
class CellRectangle : public CellBoundary {
public:
    CellRectangle(const Revolved& surface, Vec2d low, Vec2d high)
        : CellBoundary{4},
          surface_{surface},
          corners_{{{low.x, low.y, 0}, {high.x, low.y, 0}, {high.x, high.y, 0}, {low.x, high.y, 0}}}
    {
    }

    double beside(Vec3d p, unsigned side) const override
    {
        const unsigned axis = side % 2 == 0 ? 1 : 0;
        return std::abs(p[axis] - corners_[side][axis]);
    }
    double along(Vec3d p, unsigned side) const override
    {
        const unsigned axis = side % 2;
        const double from = corners_[side][axis];
        return (p[axis] - from) / (corners_[(side + 1) % 4][axis] - from);
    }
    FaceEdge part(unsigned side, double from, double to) const override
    {
        const Vec3d a = corners_[side];
        const Vec3d b = corners_[(side + 1) % 4];
        return {[a, b](double t) { return PointAndTangent{a + (b - a) * t, b - a}; }, from, to};
    }
    double distance(Vec3d a, Vec3d b) const override
    {
        const Vec3d apart = way(surface_, a, b);
        return elementary::hypot(apart.x * surface_.profile(a.y).x,
                                 apart.y * (surface_.is_ring() ? surface_.tube : 1));
    }

private:
    const Revolved& surface_;
    std::array<Vec3d, 4> corners_;
};

// True if a point lies on the left of the nearest edge, by (u, v). Ends that meet lie up to `gap` mm apart.
bool is_left(const Revolved& surface, const std::vector<FaceEdge>& edges, double gap, Vec3d p)
{
    const double same = gap / (surface.is_ring() ? surface.tube : surface.profile(p.y).x);
    const double across = surface.is_ring() ? 1 : 1 / surface.profile(p.y).x;
    return is_left_of_nearest(
        edges, p, same,
        [&](Vec3d from, Vec3d to) {
            const Vec3d apart = way(surface, from, to);
            return Vec3d{apart.x, apart.y * across, 0};
        },
        [](Vec3d) {
            return Vec3d{0, 0, 1};
        });
}

// Distance of an angle from the nearest beginning of a cell.
double from_cut(double angle, double start)
{
    const double turns = (angle - start) / kQuarter;
    return kQuarter * std::abs(turns - std::floor(turns + 0.5));
}

// Quality of cells that begin there: the least of the distance of ends from a cut, the angle at
// which edges cross one, and their distance from the corners of cells; radians.
double cut_quality(const Revolved& surface,
                   const std::vector<std::vector<PointAndTangent>>& looks,
                   Starts starts)
{
    double least = kQuarter;
    for (const auto& edge : looks) {
        for (std::size_t k = 0; k < edge.size(); ++k) {
            const auto& [p, tangent] = edge[k];
            const bool is_end = k == 0 || k + 1 == edge.size();
            const double off_u = from_cut(p.x, starts.u);
            least = std::min(least, is_end ? off_u : elementary::hypot(off_u, tangent.x));
            if (surface.is_ring()) {
                const double off_v = from_cut(p.y, starts.v);
                least = std::min(least, is_end ? off_v : elementary::hypot(off_v, tangent.y));
                least = std::min(least, std::max(off_u, off_v));
            }
        }
    }
    return least;
}

Starts best_starts(const Revolved& surface, const std::vector<FaceEdge>& edges)
{
    constexpr int kChoices = 24;
    std::vector<std::vector<PointAndTangent>> looks;
    for (const FaceEdge& edge : edges) {
        looks.emplace_back();
        for (int k = 0; k <= kEdgeChords; ++k) {
            PointAndTangent at = edge.at(parameter_of(edge, k));
            at.tangent.y *= surface.is_ring() ? 1 : 1 / surface.profile(at.point.y).x;
            at.tangent = at.tangent / norm(at.tangent);
            looks.back().push_back(at);
        }
    }
    Starts best{};
    double most = -1;
    for (int i = 0; i < kChoices * (surface.is_ring() ? kChoices : 1); ++i) {
        const Starts starts{kQuarter * (i % kChoices + 0.5) / kChoices,
                            kQuarter * (i / kChoices + 0.5) / kChoices};
        const double quality = cut_quality(surface, looks, starts);
        if (quality > most) {
            most = quality;
            best = starts;
        }
    }
    return best;
}

// All v of edges, and some more.
Vec2d line_of(const std::vector<FaceEdge>& edges)
{
    Vec2d line{kInfinite, -kInfinite};
    for (const FaceEdge& edge : edges) {
        for (int k = 0; k <= kEdgeChords; ++k) {
            const double v = edge.at(parameter_of(edge, k)).point.y;
            line = {std::min(line.x, v), std::max(line.y, v)};
        }
    }
    constexpr double kBeyond = 0.01;
    const double more = kBeyond * (line.y - line.x);
    return {line.x - more, line.y + more};
}

}  // namespace

Vec2d Revolved::profile(double v) const
{
    return is_ring() ? Vec2d{radius + tube * elementary::cos(v), tube * elementary::sin(v)}
                     : Vec2d{radius + v * elementary::sin(slope), v * elementary::cos(slope)};
}

PointAndTangent Revolved::uv_of(const PointAndTangent& at) const
{
    const auto into = [this](Vec3d p) {
        return Vec3d{dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)};
    };
    const Vec3d p = into(at.point - origin);
    const Vec3d d = into(at.tangent);
    const double out = elementary::hypot(p.x, p.y);
    const double turn = (p.x * d.y - p.y * d.x) / (out * out);
    const double outwards = (p.x * d.x + p.y * d.y) / out;
    const double beyond = out - radius;
    const double u = elementary::atan2(p.y, p.x);
    if (is_ring()) {
        const double square = beyond * beyond + p.z * p.z;
        return {{u, elementary::atan2(p.z, beyond), 0},
                {turn, (beyond * d.z - p.z * outwards) / square, 0}};
    }
    const double s = elementary::sin(slope);
    const double c = elementary::cos(slope);
    return {{u, beyond * s + p.z * c, 0}, {turn, outwards * s + d.z * c, 0}};
}

double Revolved::off(Vec3d point) const
{
    const Vec3d p = point - origin;
    const double z = dot(axes[2], p);
    const double beyond = elementary::hypot(dot(axes[0], p), dot(axes[1], p)) - radius;
    return std::abs(is_ring() ? elementary::hypot(beyond, z) - tube
                              : beyond * elementary::cos(slope) - z * elementary::sin(slope));
}

std::vector<RevolvedCell> revolved_cells(const Revolved& surface,
                                         const std::vector<FaceEdge>& edges,
                                         double gap,
                                         const std::string& place)
{
    const Cells grid{surface, best_starts(surface, edges), line_of(edges)};
    const auto number = [&grid](Vec3d uv, unsigned axis) {
        return grid.number(uv, axis);
    };
    std::vector<std::vector<CellEdge>> parts(16);
    for (const FaceEdge& edge : edges) {
        for (const CellEdge& part : cut_at_cells(edge, 2, number)) {
            const Vec3d middle = part.edge.at(0.5 * (part.edge.from + part.edge.to)).point;
            parts[static_cast<std::size_t>(4 * number(middle, 1) + number(middle, 0))].push_back(
                part);
        }
    }
    const auto is_inside = [&](Vec3d p) {
        return edges.empty() || is_left(surface, edges, gap, p);
    };
    std::vector<RevolvedCell> cells;
    for (int k = 0; k < (surface.is_ring() ? 16 : 4); ++k) {
        RevolvedCell cell = grid.cell(k % 4, k / 4);
        std::vector<CellEdge>& within = parts[static_cast<std::size_t>(k)];
        for (CellEdge& part : within) {
            part.edge = near(surface, cell, part.edge);
        }
        const CellRectangle boundary{surface, cell.low, cell.high};
        cell.loops = cell_loops(std::move(within), boundary, is_inside, gap, place);
        if (!cell.loops.empty()) {
            cells.push_back(std::move(cell));
        }
    }
    return cells;
}

}  // namespace cusp::import
