// Cells of the domain are halved until they are plane; their trims divide them into columns.
#include "host_tools/finishing/vertical_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host_tools/finishing/column_outlines.hpp"
#include "host_tools/nurbs/knot_insertion.hpp"
#include "host_tools/parallel/parallel.hpp"

namespace cusp::finishing {

using nurbs::knots_between;
using nurbs::Surface;
using part_model::PartModel;
using part_model::TrimRegion;

namespace {

constexpr int kDeepestCell = 24;           // halvings
constexpr double kPlane = 1e-7;            // mm: control points off a plane
constexpr double kOffShare = 0.04;         // of the scallop: a facet off its face
constexpr double kOffBandShare = 0.15;     // the same, of half the band
constexpr double kMostTurn = 0.1;          // of the normal over a cell
constexpr double kBandShare = 0.25;        // of the greatest z of an vertical normal: its lines off
constexpr double kLeastFacetRise = 0.125;  // of the scallop: height of a part
constexpr double kLongestFacet = 32;       // in stepovers: shared out to threads
constexpr std::size_t kMostCorners = 64;   // of a facet
constexpr int kSideHalvings = 8;           // of a side of an outline that bends
constexpr double kNoNormal = 1e-12;        // mm2

struct Cell {
    Vec2d low;  // (u, v)
    Vec2d high;

    std::array<Cell, 2> halves(bool along_u) const
    {
        std::array<Cell, 2> out{*this, *this};
        if (along_u) {
            out[0].high.x = out[1].low.x = 0.5 * (low.x + high.x);
        } else {
            out[0].high.y = out[1].low.y = 0.5 * (low.y + high.y);
        }
        return out;
    }
};

// The plane of a facet, with its coordinates along it.
struct Frame {
    Vec3d middle;
    Vec3d normal;
    Vec3d along;
    double bend;
    double off;

    Vec2d flat(Vec3d p) const { return {dot(p, along), p.z}; }
    Vec3d point(Vec2d at) const
    {
        const double level = dot(normal, normal) - normal.z * normal.z;
        const Vec3d upward{-normal.x * normal.z, -normal.y * normal.z, level};
        return middle + along * (at.x - dot(middle, along)) + upward * ((at.y - middle.z) / level);
    }
};

// The face at the corners of a cell, at the middles of its sides and at its middle; row by row.
struct Samples {
    std::array<Vec3d, 9> points;
    std::array<Vec3d, 9> normals;  // to one side of the face
    double turn{};                 // how much they differ
    double low{};                  // of their z
    double high{};
    bool turns_along_u{};       // more than along v
    bool lines_bend_along_u{};  // the same, lines of equal z
};

// Corners of the loop inside a half plane (Sutherland & Hodgman). Sides along its border may lie
// twice, and then count as none.
Outline clipped(const Outline& loop, Vec2d inward, double least)
{
    Outline out;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2d a = loop[k];
        const Vec2d b = loop[(k + 1) % loop.size()];
        const double from = dot(a, inward) - least;
        const double to = dot(b, inward) - least;
        if (from >= 0) {
            out.push_back(a);
        }
        if ((from < 0) != (to < 0)) {
            out.push_back(a + (b - a) * (from / (from - to)));
        }
    }
    return out;
}

Outline clipped(const Outline& loop, const Cell& cell)
{
    return clipped(clipped(clipped(clipped(loop, {1, 0}, cell.low.x), {-1, 0}, -cell.high.x),
                           {0, 1}, cell.low.y),
                   {0, -1}, -cell.high.y);
}

class VerticalFace {
public:
    VerticalFace(const Surface& surface,
                 int number,
                 const GougeFreePathFitter& path_fitter,
                 const ScallopAtPoint& places,
                 double scallop)
        : surface_{surface},
          number_{number},
          model_{path_fitter.model()},
          places_{places},
          radius_{path_fitter.tool().radius},
          scallop_{scallop},
          most_z_{places.upright_normal()},
          most_off_{std::min(kOffShare * scallop, kOffBandShare * path_fitter.band().half_width)}
    {
    }

    std::vector<WallFacet> facets()
    {
        const Cell whole{{surface_.u_begin(), surface_.v_begin()},
                         {surface_.u_end(), surface_.v_end()}};
        if (const std::optional<Vec3d> normal = plane_normal()) {
            if (places_.is_upright(*normal)) {
                add(whole, frame_of(*normal, surface_.points.front()), {});
            }
            return out_;
        }
        const std::vector<double> us = knots_between(surface_.knots_u, whole.low.x, whole.high.x);
        const std::vector<double> vs = knots_between(surface_.knots_v, whole.low.y, whole.high.y);
        for (std::size_t i = 1; i < us.size(); ++i) {
            for (std::size_t j = 1; j < vs.size(); ++j) {
                look_at({{us[i - 1], vs[j - 1]}, {us[i], vs[j]}}, kDeepestCell);
            }
        }
        return out_;
    }

private:
    static Frame frame_of(Vec3d normal, Vec3d point)
    {
        const double level = std::hypot(normal.x, normal.y);
        return {point, normal, Vec3d{-normal.y, normal.x, 0} / level, 0, 0};
    }

    static Vec3d upward(Vec3d normal) { return normal.z < 0 ? -normal : normal; }

    // Of the plane that all control points lie in, upward; none where they do not.
    std::optional<Vec3d> plane_normal() const
    {
        const std::vector<Vec3d>& points = surface_.points;
        const Vec3d from = points.front();
        const auto farther = [&](const Vec3d& a, const Vec3d& b) {
            return norm(a - from) < norm(b - from);
        };
        const Vec3d way = *std::max_element(points.begin(), points.end(), farther) - from;
        Vec3d normal{};
        for (const Vec3d& p : points) {
            const Vec3d some = cross(way, p - from);
            normal = norm(some) > norm(normal) ? some : normal;
        }
        if (!(norm(normal) > kNoNormal)) {
            return std::nullopt;
        }
        normal = upward(normal / norm(normal));
        return std::all_of(
                   points.begin(), points.end(),
                   [&](const Vec3d& p) { return std::abs(dot(p - from, normal)) <= kPlane; })
                   ? std::optional{normal}
                   : std::nullopt;
    }

    // None where the face has no normal in most places.
    std::optional<Samples> samples_of(const Cell& cell) const
    {
        Samples out;
        int missing = 0;
        Vec3d sum{};
        for (std::size_t k = 0; k < 9; ++k) {
            const Vec2d share{0.5 * static_cast<double>(k / 3), 0.5 * static_cast<double>(k % 3)};
            const nurbs::SurfacePoint p =
                model_.tangents(number_, cell.low.x + (cell.high.x - cell.low.x) * share.x,
                                cell.low.y + (cell.high.y - cell.low.y) * share.y);
            out.points[k] = p.point;
            const Vec3d area = cross(p.du, p.dv);
            const double size = norm(area);
            missing += size > kNoNormal ? 0 : 1;
            out.normals[k] = size > kNoNormal ? area / size : Vec3d{};
            sum = sum + out.normals[k];
        }
        if (missing > 3 || !(norm(sum) > 0)) {
            return std::nullopt;
        }
        // At a pole that of the cell counts.
        sum = sum / norm(sum);
        out.low = 1;
        out.high = -1;
        for (Vec3d& n : out.normals) {
            n = norm(n) > 0 ? n : sum;
            out.turn = std::max(out.turn, norm(n - sum));
            out.low = std::min(out.low, n.z);
            out.high = std::max(out.high, n.z);
        }
        const auto turn_between = [&](std::size_t a, std::size_t b) {
            return std::max(norm(out.normals[a] - out.normals[4]),
                            norm(out.normals[b] - out.normals[4]));
        };
        out.turns_along_u = turn_between(1, 7) >= turn_between(3, 5);
        const auto bend_between = [&](std::size_t a, std::size_t b) {
            return std::abs(out.normals[a].z - 2 * out.normals[4].z + out.normals[b].z);
        };
        out.lines_bend_along_u = bend_between(1, 7) >= bend_between(3, 5);
        return out;
    }

    // The plane through the middle of the samples, as the facet of the cell has it.
    static Frame fitted(const Samples& at)
    {
        Vec3d middle{};
        Vec3d normal{};
        for (std::size_t k = 0; k < 9; ++k) {
            middle = middle + at.points[k] / 9.0;
            normal = normal + at.normals[k];
        }
        Frame out = frame_of(upward(normal / norm(normal)), middle);
        const double side = dot(normal, out.normal) < 0 ? -1 : 1;
        double square = 0;
        double product = 0;
        for (std::size_t k = 0; k < 9; ++k) {
            const double way = dot(at.points[k] - middle, out.along);
            square += way * way;
            product += way * side * dot(at.normals[k], out.along);
        }
        out.bend = square > 0 ? product / square : 0;
        return out;
    }

    // mm: how far the face, raised by the scallop, is off the facet.
    double off_of(const Samples& at, const Frame& frame) const
    {
        double off = 0;
        double turn = 0;
        double rise = 0;
        const double middle = dot(frame.middle, frame.along);
        const double side = dot(at.normals[4], frame.normal) < 0 ? -1 : 1;
        for (std::size_t k = 0; k < 9; ++k) {
            off = std::max(off, std::abs(dot(at.points[k] - frame.middle, frame.normal)));
            const Vec3d out =
                frame.normal +
                frame.along * (frame.bend * (dot(at.points[k], frame.along) - middle));
            const Vec3d turned = at.normals[k] * side - out / norm(out);
            turn = std::max(turn, std::hypot(turned.x, turned.y));
            rise = std::max(rise, std::min(std::abs(turned.z), 2 * most_z_));
        }
        // The side of the ball is steep where it leaves no more than the scallop: a point that is
        // higher or lower is that much nearer or farther, times the slope.
        turn += rise * std::min(1.0, std::sqrt(2 * scallop_ / radius_));
        // Between two places of a facet the straight way between raised points is lower.
        const double sag = 0.125 * scallop_ * at.turn * at.turn;
        return 2 * (off + scallop_ * turn) + sag;
    }

    void look_at(const Cell& cell, int depth)
    {
        if (model_.outside_trims(number_, cell.low, cell.high)) {
            return;
        }
        const std::optional<Samples> at = samples_of(cell);
        if (!at) {
            return;
        }
        const bool one_way = at->low > 0 || at->high < 0;
        const double least = std::min(std::abs(at->low), std::abs(at->high));
        if (one_way && least > at->turn + kUprightNormal) {
            return;
        }
        const auto halve = [&](bool along_u) {
            if (depth > 0) {
                for (const Cell& half : cell.halves(along_u)) {
                    look_at(half, depth - 1);
                }
            }
        };
        if (at->turn > kMostTurn) {
            halve(at->turns_along_u);
            return;
        }
        if (one_way && least > most_z_ + 0.5 * (at->high - at->low)) {
            return;
        }
        Frame frame = fitted(*at);
        frame.off = off_of(*at, frame);
        const LevelLines lines = level_lines(*at);
        if (depth > 0 && frame.off > most_off_) {
            halve(at->turns_along_u);
        } else if (depth > 0 && lines.off > kBandShare * most_z_ &&
                   std::max(std::abs(at->low), std::abs(at->high)) > most_z_) {
            halve(at->lines_bend_along_u);
        } else {
            add(cell, frame, lines);
        }
    }

    // z of the normal over a cell is about at_low + dot(slope, share of the cell), by so much.
    struct LevelLines {
        double at_low;
        Vec2d slope;
        double off;
    };
    static LevelLines level_lines(const Samples& at)
    {
        LevelLines out{0, {0, 0}, 0};
        double mean = 0;
        for (std::size_t k = 0; k < 9; ++k) {
            const double z = at.normals[k].z;
            mean += z / 9;
            out.slope = out.slope + Vec2d{(static_cast<double>(k / 3) - 1) * z / 3,
                                          (static_cast<double>(k % 3) - 1) * z / 3};
        }
        out.at_low = mean - 0.5 * (out.slope.x + out.slope.y);
        for (std::size_t k = 0; k < 9; ++k) {
            const double z = out.at_low + 0.5 * (out.slope.x * static_cast<double>(k / 3) +
                                                 out.slope.y * static_cast<double>(k % 3));
            out.off = std::max(out.off, std::abs(at.normals[k].z - z));
        }
        return out;
    }

    // The part of a loop in the cell that is vertical.
    Outline upright_part(const Outline& loop, const Cell& cell, const LevelLines& lines) const
    {
        const double most = most_z_ + 2 * lines.off;
        const Vec2d slope{lines.slope.x / (cell.high.x - cell.low.x),
                          lines.slope.y / (cell.high.y - cell.low.y)};
        const double at_zero = lines.at_low - dot(slope, cell.low);
        return clipped(clipped(loop, slope, -most - at_zero), slope * -1.0, at_zero - most);
    }

    // The sides of a loop in the frame; those that bend in space are divided.
    void append_side(
        Vec2d from, Vec2d to, int depth, const Frame& frame, double most_off, Outline& out) const
    {
        const auto at = [&](Vec2d uv) {
            return frame.flat(model_.tangents(number_, uv.x, uv.y).point);
        };
        const Vec2d middle = (from + to) * 0.5;
        const Vec2d a = at(from);
        const Vec2d off = at(middle) - (a + at(to)) * 0.5;
        if (depth > 0 && std::sqrt(dot(off, off)) > most_off) {
            append_side(from, middle, depth - 1, frame, most_off, out);
            append_side(middle, to, depth - 1, frame, most_off, out);
        } else {
            out.push_back(a);
        }
    }

    void add(const Cell& cell, const Frame& frame, const LevelLines& lines)
    {
        std::vector<Outline> inside{
            {cell.low, {cell.high.x, cell.low.y}, cell.high, {cell.low.x, cell.high.y}}};
        if (!surface_.trims.empty()) {
            if (!region_) {
                region_.emplace(surface_, model_.edge_error());
            }
            const auto part = region_->part(cell.low.x, cell.high.x, cell.low.y, cell.high.y);
            if (part == TrimRegion::Part::kOutside) {
                return;
            }
            if (part == TrimRegion::Part::kCut) {
                inside.clear();
                for (const std::vector<Vec2d>& loop : region_->loops()) {
                    inside.push_back(clipped(loop, cell));
                }
            }
        }
        // Corners off by as much leave a corner of the wall so high.
        const double corner_off = 0.25 * most_off_;
        std::vector<Outline> outlines;
        for (const Outline& whole : inside) {
            const Outline loop = upright_part(whole, cell, lines);
            Outline flat;
            for (std::size_t k = 0; k < loop.size(); ++k) {
                append_side(loop[k], loop[(k + 1) % loop.size()], kSideHalvings, frame,
                            0.5 * corner_off, flat);
            }
            outlines.push_back(simplified(flat, 0.5 * corner_off));
        }
        const double longest = kLongestFacet * places_.step();
        for (const Outline& outline : column_outlines(outlines, longest, kMostCorners)) {
            const auto [low, high] = std::minmax_element(
                outline.begin(), outline.end(), [](Vec2d a, Vec2d b) { return a.y < b.y; });
            if (high->y - low->y <= kLeastFacetRise * scallop_) {
                continue;
            }
            WallFacet facet{
                {}, frame.normal, frame.bend, dot(frame.middle, frame.along), frame.off};
            for (const Vec2d at : outline) {
                facet.corners.push_back(frame.point(at));
            }
            out_.push_back(std::move(facet));
        }
    }

    const Surface& surface_;
    int number_;
    const PartModel& model_;
    const ScallopAtPoint& places_;
    double radius_;
    double scallop_;
    double most_z_;  // of a normal that is vertical
    double most_off_;
    std::optional<TrimRegion> region_;
    std::vector<WallFacet> out_;
};

}  // namespace

std::vector<WallFacet> vertical_faces(const std::vector<Surface>& surfaces,
                                      const GougeFreePathFitter& path_fitter,
                                      const ScallopAtPoint& places,
                                      double scallop)
{
    std::vector<std::vector<WallFacet>> found(surfaces.size());
    {
        const PartModel::SharedQueries shared{path_fitter.model()};
        parallel::for_each(surfaces.size(), [&](std::size_t k) {
            const PartModel::SharedQueries::Part queries{path_fitter.model()};
            VerticalFace face{surfaces[k], static_cast<int>(k), path_fitter, places, scallop};
            found[k] = face.facets();
        });
    }
    path_fitter.model().forget_queries();
    std::vector<WallFacet> out;
    for (std::vector<WallFacet>& some : found) {
        for (WallFacet& facet : some) {
            out.push_back(std::move(facet));
        }
    }
    return out;
}

}  // namespace cusp::finishing
