// Newton's method starts from the nearest sample of a piece; from all samples of one that folds.
#include "host_tools/geometry/part_model/surface_height_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/surface_length.hpp"

namespace cusp::part_model {

using nurbs::BezierPatch;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

constexpr double kPiecesAlong = 100;   // the box of all surfaces
constexpr int kMostParts = 400;        // of a patch, along each side
constexpr std::size_t kBins = 128;     // along each side of the box
constexpr double kBeyondPiece = 0.25;  // of a piece's size: its edges are not straight
constexpr int kMostSteps = 20;
constexpr double kMeet = 1e-7;      // mm
constexpr double kTooSteep = 1e-3;  // cosine of the slope: too steep to start from
constexpr double kSingular = 1e-9;  // cosine of the slope: no step is possible

// The cosine of the slope; its sign says which side of the surface faces up.
double facing(const SurfacePoint& s)
{
    const double across = norm(s.du) * norm(s.dv);
    return across > 0 ? (s.du.x * s.dv.y - s.du.y * s.dv.x) / across : 0.0;
}

int parts_along(const Surface& patch, bool along_u, double width)
{
    return static_cast<int>(
        std::clamp(std::ceil(longest_row(patch, along_u) / width), 2.0, double{kMostParts}));
}

}  // namespace

SurfaceHeightMap::SurfaceHeightMap(const std::vector<Surface>& surfaces, double edge_error)
    : low_{kInfinite, kInfinite}, high_{-kInfinite, -kInfinite}
{
    for (const Surface& surface : surfaces) {
        for (const Vec3d p : surface.points) {
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
            high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
        }
    }
    const double width = std::max(high_.x - low_.x, high_.y - low_.y) / kPiecesAlong;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        regions_.emplace_back(surfaces[k], edge_error);
        for (BezierPatch& patch : bezier_patches(surfaces[k])) {
            patches_.push_back({k, std::move(patch.surface)});
            add_pieces(patches_.size() - 1, width);
        }
    }
    make_bins();
}

void SurfaceHeightMap::add_pieces(std::size_t patch, double width)
{
    const Surface& bezier = patches_[patch].bezier;
    const int parts_u = parts_along(bezier, true, width);
    const int parts_v = parts_along(bezier, false, width);
    const double step_u = (bezier.u_end() - bezier.u_begin()) / parts_u;
    const double step_v = (bezier.v_end() - bezier.v_begin()) / parts_v;
    for (int i = 0; i < parts_u; ++i) {
        for (int j = 0; j < parts_v; ++j) {
            Piece piece{patch, {kInfinite, kInfinite}, {-kInfinite, -kInfinite}, {}, false};
            int up = 0;
            for (std::size_t k = 0; k < piece.samples.size(); ++k) {
                const double u = bezier.u_begin() + (i + 0.5 * static_cast<double>(k / 3)) * step_u;
                const double v = bezier.v_begin() + (j + 0.5 * static_cast<double>(k % 3)) * step_v;
                const SurfacePoint s = derivatives_at(bezier, u, v);
                const double cosine = facing(s);
                up += cosine > kTooSteep ? 1 : cosine < -kTooSteep ? -1 : 0;
                piece.samples[k] = {u, v, s.point, std::abs(cosine) > kTooSteep};
                piece.low = {std::min(piece.low.x, s.point.x), std::min(piece.low.y, s.point.y)};
                piece.high = {std::max(piece.high.x, s.point.x), std::max(piece.high.y, s.point.y)};
            }
            piece.folds = std::abs(up) != 9;
            const double beyond =
                kBeyondPiece * std::max(piece.high.x - piece.low.x, piece.high.y - piece.low.y);
            piece.low = piece.low - Vec2d{beyond, beyond};
            piece.high = piece.high + Vec2d{beyond, beyond};
            pieces_.push_back(std::move(piece));
        }
    }
}

std::size_t SurfaceHeightMap::column(double x) const
{
    const double share = (x - low_.x) / std::max(high_.x - low_.x, kMeet);
    return static_cast<std::size_t>(std::clamp(share * kBins, 0.0, kBins - 1.0));
}

std::size_t SurfaceHeightMap::row(double y) const
{
    const double share = (y - low_.y) / std::max(high_.y - low_.y, kMeet);
    return static_cast<std::size_t>(std::clamp(share * kBins, 0.0, kBins - 1.0));
}

void SurfaceHeightMap::make_bins()
{
    bins_.resize(kBins * kBins);
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const Piece& piece = pieces_[k];
        for (std::size_t i = column(piece.low.x); i <= column(piece.high.x); ++i) {
            for (std::size_t j = row(piece.low.y); j <= row(piece.high.y); ++j) {
                bins_[i * kBins + j].push_back(static_cast<std::uint32_t>(k));
            }
        }
    }
}

std::optional<double> SurfaceHeightMap::at(double x, double y) const
{
    if (x < low_.x - kMeet || x > high_.x + kMeet || y < low_.y - kMeet || y > high_.y + kMeet) {
        return std::nullopt;
    }
    double height = -kInfinite;
    for (const std::uint32_t k : bins_[column(x) * kBins + row(y)]) {
        const Piece& piece = pieces_[k];
        if (x < piece.low.x - kMeet || x > piece.high.x + kMeet || y < piece.low.y - kMeet ||
            y > piece.high.y + kMeet) {
            continue;
        }
        if (piece.folds) {
            for (const Sample& sample : piece.samples) {
                if (sample.can_start) {
                    raise(piece, sample, x, y, height);
                }
            }
        } else {
            const auto nearer = [&](const Sample& a, const Sample& b) {
                return elementary::hypot(a.point.x - x, a.point.y - y) <
                       elementary::hypot(b.point.x - x, b.point.y - y);
            };
            raise(piece, *std::min_element(piece.samples.begin(), piece.samples.end(), nearer), x,
                  y, height);
        }
    }
    return std::isfinite(height) ? std::optional{height} : std::nullopt;
}

void SurfaceHeightMap::raise(
    const Piece& piece, const Sample& from, double x, double y, double& height) const
{
    const Patch& patch = patches_[piece.patch];
    const Surface& bezier = patch.bezier;
    double u = from.u;
    double v = from.v;
    for (int step = 0; step < kMostSteps; ++step) {
        const SurfacePoint s = derivatives_at(bezier, u, v);
        const double off_x = x - s.point.x;
        const double off_y = y - s.point.y;
        if (elementary::hypot(off_x, off_y) < kMeet) {
            const TrimRegion& region = regions_[patch.surface];
            if (s.point.z > height && (!region.trimmed() || region.inside(u, v))) {
                height = s.point.z;
            }
            return;
        }
        if (std::abs(facing(s)) < kSingular) {
            return;
        }
        const double det = s.du.x * s.dv.y - s.du.y * s.dv.x;
        u = std::clamp(u + (off_x * s.dv.y - off_y * s.dv.x) / det, bezier.u_begin(),
                       bezier.u_end());
        v = std::clamp(v + (s.du.x * off_y - s.du.y * off_x) / det, bezier.v_begin(),
                       bezier.v_end());
    }
}

}  // namespace cusp::part_model
