// Cells of patches are halved until they are proved to be plane; trims divide them into columns.
#include "host_tools/cam/finishing/vertical_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/column_outlines.hpp"
#include "host_tools/cam/finishing/face_samples.hpp"
#include "host_tools/cam/finishing/wall_cell.hpp"

namespace cusp::finishing {

using nurbs::BezierPatch;
using nurbs::Surface;
using part_model::PartModel;
using part_model::TrimRegion;

namespace {

constexpr int kDeepestCell = 24;          // halvings
constexpr int kProofHalvings = 4;         // of a cell that is plane by its samples
constexpr double kMostOffProved = 1.5;    // of what is allowed by samples
constexpr double kOffAtLast = 0.25;       // of the scallop: proved after the last of those
constexpr double kBandProved = 0.5;       // of the greatest z of a vertical normal: its lines off
constexpr int kPoleHalvings = 4;          // where most of a cell has no normal
constexpr double kPlane = 1e-7;           // mm: control points off a plane
constexpr double kOffShare = 0.04;        // of the scallop: a facet off its face
constexpr double kOffBandShare = 0.15;    // the same, of half the band
constexpr double kMostTurn = 0.1;         // of the normal over a cell
constexpr double kBandShare = 0.25;       // of the greatest z of an vertical normal: its lines off
constexpr double kLeastFacetRise = 0.02;  // of the scallop: height of a part
constexpr double kLongestFacet = 32;      // in stepovers: shared out to threads
constexpr std::size_t kMostCorners = 64;  // of a facet
constexpr int kMostSideParts = 256;       // of a side of an outline that bends
constexpr double kNoNormal = 1e-12;       // mm2

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

// z of the normal over a cell is about at_low + dot(slope, share of the cell), by so much.
struct LevelLines {
    double at_low;
    Vec2d slope;
    double off;
};

Outline within(const Outline& loop, const Cell& cell)
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
        const std::optional<Vec3d> normal = plane_normal();
        if (normal && !places_.is_upright(*normal)) {
            return out_;
        }
        for (const BezierPatch& patch : bezier_patches(surface_)) {
            const Cell cell{{patch.u_begin, patch.v_begin}, {patch.u_end, patch.v_end}};
            if (normal) {
                add(cell, {patch, cell.low, cell.high}, frame_of(*normal, surface_.points.front()),
                    {});
            } else {
                look_at(patch, cell, kDeepestCell, kProofHalvings);
            }
        }
        return out_;
    }

private:
    static Frame frame_of(Vec3d normal, Vec3d point)
    {
        const double level = elementary::hypot(normal.x, normal.y);
        return {point, normal, Vec3d{-normal.y, normal.x, 0} / level, 0, 0};
    }

    static Vec3d upward(Vec3d normal) { return normal.z < 0 ? -normal : normal; }

    // Normal of the plane that all control points lie in, upward; none if they lie in no plane.
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

    // The plane through the middle of the samples, as the facet of the cell has it.
    static Frame fitted(const FaceSamples& at)
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

    // True if the face leaves the facet along u more than along v. A wall that bulges along its height
    // is off by that, however its normals turn along it.
    bool is_off_along_u(const FaceSamples& at, const Frame& frame) const
    {
        const auto off_between = [&](std::size_t a, std::size_t b) {
            double off = 0;
            for (const std::size_t k : {a, b}) {
                const double turn = norm(at.normals[k] - at.normals[4]);
                off = std::max(off, std::abs(dot(at.points[k] - at.points[4], frame.normal)) +
                                        scallop_ * turn * turn);
            }
            return off;
        };
        return off_between(1, 7) >= off_between(3, 5);
    }

    // mm: how far the face, raised by the scallop, is off the facet, by the samples.
    double off_of(const FaceSamples& at, const Frame& frame) const
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
            turn = std::max(turn, elementary::hypot(turned.x, turned.y));
            rise = std::max(rise, std::min(std::abs(turned.z), 2 * most_z_));
        }
        turn += rise * slope_of_ball();
        // Between two places of a facet the straight way between raised points is lower.
        const double sag = 0.125 * scallop_ * at.turn * at.turn;
        return 2 * (off + scallop_ * turn) + sag;
    }

    static LevelLines level_lines(const FaceSamples& at)
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
            out.off = std::max(out.off, 2 * std::abs(at.normals[k].z - z));
        }
        return out;
    }

    // The facet and lines with what is proved: how far the face, raised by the scallop, is off the facet
    // (mm), and z of its normal off the lines. The facet is put into the middle of the cell.
    struct Proved {
        Frame frame;
        LevelLines lines;
    };
    // side  1 where the cell's normals lead to the frame's side, else -1
    std::optional<Proved> proved(const WallCell& cell,
                                 double side,
                                 Frame frame,
                                 LevelLines lines) const
    {
        const auto [low, high] = cell.along(frame.middle, frame.normal);
        frame.middle = frame.middle + frame.normal * (0.5 * (low + high));
        const auto turn = cell.turn({frame.middle, frame.normal, frame.along, frame.bend},
                                    {lines.at_low, lines.slope}, side);
        if (!turn) {
            return std::nullopt;
        }
        lines.off = turn->lines;
        // Only what is vertical is looked at.
        const double rise =
            std::min(turn->rise, std::abs(frame.normal.z) + most_z_ + lines.off) * slope_of_ball();
        // Between two places of a facet the straight way between raised points is lower.
        const double sag = 0.5 * scallop_ * turn->most * turn->most;
        frame.off = 0.5 * (high - low) + scallop_ * (turn->along + rise) + sag;
        return Proved{frame, lines};
    }

    // The side of the ball is steep where it leaves no more than the scallop: a point that is higher or
    // lower is that much nearer or farther, times the slope.
    double slope_of_ball() const { return std::min(1.0, std::sqrt(2 * scallop_ / radius_)); }

    void halve(const BezierPatch& patch, const Cell& cell, bool along_u, int depth, int spare)
    {
        for (const Cell& half : cell.halves(along_u)) {
            look_at(patch, half, depth - 1, spare);
        }
    }

    // By samples a cell is halved until it is plane; then until that is proved.
    //
    // spare  halvings for the proof
    void look_at(const BezierPatch& patch, const Cell& cell, int depth, int spare)
    {
        if (model_.outside_trims(number_, cell.low, cell.high)) {
            return;
        }
        const std::optional<FaceSamples> at = sample_face(model_, number_, cell.low, cell.high);
        if (!at) {
            // Two poles may end one patch.
            if (depth > kDeepestCell - kPoleHalvings) {
                halve(patch, cell, depth % 2 == 0, depth, spare);
            }
            return;
        }
        const bool one_way = at->low > 0 || at->high < 0;
        const double least = std::min(std::abs(at->low), std::abs(at->high));
        if (one_way && least > at->turn + kUprightNormal) {
            if (depth > 0 && spare > 0 &&
                !WallCell{patch, cell.low, cell.high}.leans_more_than(most_z_)) {
                halve(patch, cell, at->turns_along_u, depth, spare - 1);
            }
        } else if (at->turn <= kMostTurn) {
            const bool leans = one_way && least > most_z_ + 0.5 * (at->high - at->low);
            look_at_plane(patch, cell, *at, leans, depth, spare);
        } else if (depth > 0) {
            halve(patch, cell, at->turns_along_u, depth, spare);
        }
    }

    // leans  by the samples, so much that nothing of it is vertical
    void look_at_plane(const BezierPatch& patch,
                       const Cell& cell,
                       const FaceSamples& at,
                       bool leans,
                       int depth,
                       int spare)
    {
        Frame frame = fitted(at);
        frame.off = off_of(at, frame);
        const LevelLines lines = level_lines(at);
        const bool along_u = is_off_along_u(at, frame);
        if (depth > 0 && !leans && frame.off > most_off_) {
            halve(patch, cell, along_u, depth, spare);
            return;
        }
        if (depth > 0 && !leans && lines.off > 2 * kBandShare * most_z_ &&
            std::max(std::abs(at.low), std::abs(at.high)) > most_z_) {
            halve(patch, cell, at.lines_bend_along_u, depth, spare);
            return;
        }
        const WallCell bounds{patch, cell.low, cell.high};
        if (leans && bounds.leans_more_than(most_z_)) {
            return;
        }
        const double side = dot(at.normals[4], frame.normal) < 0 ? -1 : 1;
        const std::optional<Proved> found = proved(bounds, side, frame, lines);
        const bool is_near = found && found->frame.off <= kMostOffProved * most_off_;
        if (is_near && found->lines.off <= kBandProved * most_z_) {
            add(cell, bounds, found->frame, found->lines);
        } else if (depth > 0 && spare > 0) {
            halve(patch, cell, is_near ? at.lines_bend_along_u : along_u, depth, spare - 1);
        } else if (found && found->frame.off <= kOffAtLast * scallop_) {
            add(cell, bounds, found->frame, found->lines);
        } else if (!leans) {
            add(cell, bounds, frame, lines);
        }
    }

    // The part of a loop in the cell that is vertical.
    Outline upright_part(const Outline& loop, const Cell& cell, const LevelLines& lines) const
    {
        const double most = most_z_ + lines.off;
        const Vec2d slope{lines.slope.x / (cell.high.x - cell.low.x),
                          lines.slope.y / (cell.high.y - cell.low.y)};
        const double at_zero = lines.at_low - dot(slope, cell.low);
        return clipped(clipped(loop, slope, -most - at_zero), slope * -1.0, at_zero - most);
    }

    // A side of a loop in the frame, without its end; one that bends in space is divided.
    void append_side(Vec2d from, Vec2d to, int parts, const Frame& frame, Outline& out) const
    {
        for (int k = 0; k < parts; ++k) {
            const Vec2d uv = from + (to - from) * (static_cast<double>(k) / parts);
            out.push_back(frame.flat(model_.tangents(number_, uv.x, uv.y).point));
        }
    }

    void add(const Cell& cell, const WallCell& bounds, const Frame& frame, const LevelLines& lines)
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
                    inside.push_back(within(loop, cell));
                }
            }
        }
        // Corners off by as much leave a corner of the wall so high.
        const double corner_off = 0.25 * most_off_;
        const WallCell::Bends bends =
            bounds.bends({frame.middle, frame.normal, frame.along, frame.bend});
        const auto parts_of = [&](Vec2d side) {
            const double bow = bends.bow(
                {side.x / (cell.high.x - cell.low.x), side.y / (cell.high.y - cell.low.y)});
            return std::clamp(static_cast<int>(std::ceil(std::sqrt(bow / (0.5 * corner_off)))), 1,
                              kMostSideParts);
        };
        std::vector<Outline> outlines;
        for (const Outline& whole : inside) {
            const Outline loop = upright_part(whole, cell, lines);
            Outline flat;
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const Vec2d to = loop[(k + 1) % loop.size()];
                append_side(loop[k], to, parts_of(to - loop[k]), frame, flat);
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
