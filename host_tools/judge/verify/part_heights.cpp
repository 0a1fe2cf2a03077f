// Divides each Bezier patch into small quads and solves for the grid points over each.
#include "host_tools/judge/verify/part_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "host_tools/judge/verify/bands.hpp"

namespace cusp::verify {

using job::encloses;
using job::loop_polyline;
using nurbs::BezierPatch;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

struct Quad {
    const Surface* patch;
    double u, v;    // middle
    double hu, hv;  // half sizes
    Vec3d middle;
    Vec3d du, dv;  // per half size
};

// Quads about this many pitches wide.
constexpr double kQuadPitches = 4.0;
constexpr int kMostParts = 400;

int parts_along(const Surface& patch, bool along_u, double width)
{
    constexpr int kSamples = 8;
    double longest = 0;
    for (int k = 0; k <= kSamples; ++k) {
        const double share = static_cast<double>(k) / kSamples;
        double length = 0;
        Vec3d last;
        for (int i = 0; i <= kSamples; ++i) {
            const double step = static_cast<double>(i) / kSamples;
            const double a = along_u ? step : share;
            const double b = along_u ? share : step;
            const Vec3d p = point_at(patch, patch.u_begin() + a * (patch.u_end() - patch.u_begin()),
                                     patch.v_begin() + b * (patch.v_end() - patch.v_begin()));
            length += i > 0 ? norm(p - last) : 0;
            last = p;
        }
        longest = std::max(longest, length);
    }
    return std::clamp(static_cast<int>(std::ceil(longest / width)), 2, kMostParts);
}

std::vector<Quad> quads_of(const Surface& patch, double width)
{
    const int nu = parts_along(patch, true, width);
    const int nv = parts_along(patch, false, width);
    const double hu = (patch.u_end() - patch.u_begin()) / nu / 2;
    const double hv = (patch.v_end() - patch.v_begin()) / nv / 2;
    std::vector<Quad> quads;
    for (int i = 0; i < nu; ++i) {
        for (int j = 0; j < nv; ++j) {
            const double u = patch.u_begin() + (2 * i + 1) * hu;
            const double v = patch.v_begin() + (2 * j + 1) * hv;
            const SurfacePoint s = derivatives_at(patch, u, v);
            quads.push_back({&patch, u, v, hu, hv, s.point, hu * s.du, hv * s.dv});
        }
    }
    return quads;
}

// Trims of a surface as polylines in its parameters.
class Trims {
public:
    explicit Trims(const Surface& surface)
    {
        const double size =
            std::max(surface.u_end() - surface.u_begin(), surface.v_end() - surface.v_begin());
        constexpr double kShare = 1e-5;
        for (const auto& loop : surface.trims) {
            loops_.push_back(loop_polyline(loop, kShare * size));
        }
    }
    bool keep(double u, double v) const
    {
        if (loops_.empty()) {
            return true;
        }
        bool inside = false;
        for (const auto& loop : loops_) {
            inside = inside != encloses(loop, {u, v});
        }
        return inside;
    }

private:
    std::vector<std::vector<Vec2d>> loops_;
};

struct Root {
    double u, v;
    SurfacePoint at;
    bool found;
};

Root solve(const Quad& quad, double x, double y, double u, double v)
{
    constexpr int kMostSteps = 12;
    constexpr double kMeet = 1e-8;  // mm
    const Surface& patch = *quad.patch;
    Root root{u, v, {}, false};
    for (int step = 0; step < kMostSteps; ++step) {
        root.at = derivatives_at(patch, root.u, root.v);
        const double ex = x - root.at.point.x;
        const double ey = y - root.at.point.y;
        if (elementary::hypot(ex, ey) < kMeet) {
            root.found = true;
            return root;
        }
        const Vec3d& a = root.at.du;
        const Vec3d& b = root.at.dv;
        const double det = a.x * b.y - a.y * b.x;
        if (std::abs(det) < 1e-12) {
            return root;
        }
        root.u = std::clamp(root.u + (ex * b.y - ey * b.x) / det, patch.u_begin(), patch.u_end());
        root.v = std::clamp(root.v + (a.x * ey - a.y * ex) / det, patch.v_begin(), patch.v_end());
    }
    return root;
}

std::array<float, 2> lean_of(Vec3d normal)
{
    return {static_cast<float>(normal.x), static_cast<float>(normal.y)};
}

// Fills the columns [begin, end) of the grid over one quad.
void fill(const Quad& quad,
          const Trims& trims,
          const HeightGrid& grid,
          std::size_t begin,
          std::size_t end,
          PartHeights& heights)
{
    // a quad includes points slightly beyond it, since its edges are not straight
    constexpr double kBeyond = 1.6;
    const double reach_x = kBeyond * (std::abs(quad.du.x) + std::abs(quad.dv.x));
    const double reach_y = kBeyond * (std::abs(quad.du.y) + std::abs(quad.dv.y));
    const double det = quad.du.x * quad.dv.y - quad.du.y * quad.dv.x;
    if (std::abs(det) < 1e-14) {
        return;
    }
    const std::size_t first = std::max(begin, grid.first_column(quad.middle.x - reach_x));
    const std::size_t last = std::min(end, grid.end_column(quad.middle.x + reach_x));
    const std::size_t low = grid.first_row(quad.middle.y - reach_y);
    const std::size_t high = grid.end_row(quad.middle.y + reach_y);
    for (std::size_t i = first; i < last; ++i) {
        for (std::size_t j = low; j < high; ++j) {
            const double x = grid.x(i, j);
            const double y = grid.y(i, j);
            const double ex = x - quad.middle.x;
            const double ey = y - quad.middle.y;
            const double s = (ex * quad.dv.y - ey * quad.dv.x) / det;
            const double t = (quad.du.x * ey - quad.du.y * ex) / det;
            if (std::abs(s) > kBeyond || std::abs(t) > kBeyond) {
                continue;
            }
            const Root root =
                solve(quad, x, y,
                      std::clamp(quad.u + s * quad.hu, quad.patch->u_begin(), quad.patch->u_end()),
                      std::clamp(quad.v + t * quad.hv, quad.patch->v_begin(), quad.patch->v_end()));
            const std::size_t at = grid.index(i, j);
            if (!root.found || root.at.point.z <= heights.z[at] || !trims.keep(root.u, root.v)) {
                continue;
            }
            const Vec3d n = upward_normal(root.at);
            heights.z[at] = root.at.point.z;
            heights.cosine[at] = n.z > 0 ? n.z : 1.0;
            heights.lean[at] = lean_of(n);
        }
    }
}

// Fills the grid over one triangle.
void fill(const std::array<Vec3d, 3>& t, const HeightGrid& grid, PartHeights& heights)
{
    constexpr double kVertical = 1e-9;  // z of the normal
    constexpr double kOnSide = 1e-12;   // of the triangle
    const Vec3d across = cross(t[1] - t[0], t[2] - t[0]);
    const double cosine = std::abs(across.z) / norm(across);
    if (!(cosine > kVertical)) {
        return;
    }
    const std::array<float, 2> lean = lean_of(across * ((across.z < 0 ? -1 : 1) / norm(across)));
    const auto [x_low, x_high] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y_low, y_high] = std::minmax({t[0].y, t[1].y, t[2].y});
    for (std::size_t i = grid.first_column(x_low); i < grid.end_column(x_high); ++i) {
        for (std::size_t j = grid.first_row(y_low); j < grid.end_row(y_high); ++j) {
            const double ex = grid.x(i, j) - t[0].x;
            const double ey = grid.y(i, j) - t[0].y;
            const Vec3d b = t[1] - t[0];
            const Vec3d c = t[2] - t[0];
            const double s = (ex * c.y - ey * c.x) / across.z;
            const double r = (b.x * ey - b.y * ex) / across.z;
            const double z = t[0].z + s * b.z + r * c.z;
            const std::size_t at = grid.index(i, j);
            if (s >= -kOnSide && r >= -kOnSide && s + r <= 1 + kOnSide && z > heights.z[at]) {
                heights.z[at] = z;
                heights.cosine[at] = cosine;
                heights.lean[at] = lean;
            }
        }
    }
}

}  // namespace

PartHeights part_heights(const std::vector<Surface>& surfaces,
                         const std::vector<std::array<Vec3d, 3>>& triangles,
                         const HeightGrid& grid)
{
    PartHeights heights{std::vector<double>(grid.size(), -kInfinite),
                        std::vector<double>(grid.size(), 1.0),
                        std::vector<std::array<float, 2>>(grid.size())};
    for (const Surface& surface : surfaces) {
        const Trims trims{surface};
        const std::vector<BezierPatch> patches = bezier_patches(surface);
        std::vector<std::vector<Quad>> quads(patches.size());
        parallel::for_each(patches.size(), [&](std::size_t k) {
            quads[k] = quads_of(patches[k].surface, kQuadPitches * grid.pitch);
        });
        for_each_band(grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (const std::vector<Quad>& some : quads) {
                for (const Quad& quad : some) {
                    fill(quad, trims, grid, begin, end, heights);
                }
            }
        });
    }
    for (const auto& triangle : triangles) {
        fill(triangle, grid, heights);
    }
    for (double& z : heights.z) {
        z = std::isfinite(z) ? z : kNoValue;
    }
    return heights;
}

PartBox part_box(const std::vector<Surface>& surfaces,
                 const std::vector<std::array<Vec3d, 3>>& triangles)
{
    constexpr int kSamples = 24;
    PartBox box{kInfinite, -kInfinite, kInfinite, -kInfinite, kInfinite, -kInfinite};
    const auto widen = [&box](Vec3d p) {
        box = {std::min(box.x_low, p.x),  std::max(box.x_high, p.x), std::min(box.y_low, p.y),
               std::max(box.y_high, p.y), std::min(box.z_low, p.z),  std::max(box.z_high, p.z)};
    };
    for (const auto& triangle : triangles) {
        std::for_each(triangle.begin(), triangle.end(), widen);
    }
    for (const Surface& surface : surfaces) {
        for (const BezierPatch& patch : bezier_patches(surface)) {
            for (int k = 0; k < (kSamples + 1) * (kSamples + 1); ++k) {
                const double a = static_cast<double>(k % (kSamples + 1)) / kSamples;
                const double b = static_cast<double>(k / (kSamples + 1)) / kSamples;
                widen(point_at(patch.surface, patch.u_begin + a * (patch.u_end - patch.u_begin),
                               patch.v_begin + b * (patch.v_end - patch.v_begin)));
            }
        }
    }
    return box;
}

}  // namespace cusp::verify
