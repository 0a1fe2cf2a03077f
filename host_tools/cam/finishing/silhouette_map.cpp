// Patches are sampled as densely as their longest row of control points requires.
#include "host_tools/cam/finishing/silhouette_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "host_tools/geometry/part_model/surface_length.hpp"

namespace cusp::finishing {

using nurbs::BezierPatch;
using nurbs::Surface;
using nurbs::SurfacePoint;
using part_model::longest_row;
using part_model::PartModel;

namespace {

constexpr double kMostSquares = 4e6;
constexpr std::size_t kMostSamples = 1000;  // of a patch, each way

enum class Facing : std::uint8_t { kUnknown, kTrimmed, kUp, kDown };

}  // namespace

SilhouetteMap::SilhouetteMap(const std::vector<Surface>& surfaces,
                             const PartModel& model,
                             double pitch)
    : model_{model}, x0_{model.box_low().x}, y0_{model.box_low().y}
{
    const Vec3d size = model.box_high() - model.box_low();
    pitch_ = std::max(pitch, std::sqrt(size.x * size.y / kMostSquares));
    nx_ = static_cast<std::size_t>(size.x / pitch_) + 1;
    ny_ = static_cast<std::size_t>(size.y / pitch_) + 1;
    top_.assign(nx_ * ny_, -kInfinite);
    places_.resize(nx_ * ny_);
    silhouette_.assign(nx_ * ny_, -kInfinite);
    for (std::size_t number = 0; number < surfaces.size(); ++number) {
        for (const BezierPatch& patch : bezier_patches(surfaces[number])) {
            sample(surfaces[number], static_cast<int>(number), patch, model);
        }
    }
}

std::size_t SilhouetteMap::square_of(Vec3d p) const
{
    const auto along = [&](double at, std::size_t count) {
        return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, at / pitch_)));
    };
    return along(p.x - x0_, nx_) * ny_ + along(p.y - y0_, ny_);
}

// A silhouette passes a sample at the border of its surface, and a sample that differs from its
// neighbour in facing up or down, or in being trimmed away.
void SilhouetteMap::sample(const Surface& whole,
                           int surface,
                           const BezierPatch& patch,
                           const PartModel& model)
{
    const auto count = [&](bool along_u) {
        const double parts = 2.0 * longest_row(patch.surface, along_u) / pitch_;
        return std::min(kMostSamples, static_cast<std::size_t>(parts) + 2);
    };
    const std::size_t nu = count(true);
    const std::size_t nv = count(false);
    std::vector<Facing> last_row(nv + 1, Facing::kUnknown);
    for (std::size_t i = 0; i <= nu; ++i) {
        Facing last = Facing::kUnknown;
        for (std::size_t j = 0; j <= nv; ++j) {
            const double s = static_cast<double>(i) / static_cast<double>(nu);
            const double t = static_cast<double>(j) / static_cast<double>(nv);
            const double u = patch.u_begin * (1 - s) + patch.u_end * s;
            const double v = patch.v_begin * (1 - t) + patch.v_end * t;
            const SurfacePoint p = model.tangents(surface, u, v);
            Facing here = cross(p.du, p.dv).z > 0 ? Facing::kUp : Facing::kDown;
            if (!model.inside_trims(surface, u, v)) {
                here = Facing::kTrimmed;
            }
            const std::size_t square = square_of(p.point);
            if (here != Facing::kTrimmed && p.point.z > top_[square]) {
                top_[square] = p.point.z;
                places_[square] = {static_cast<float>(u), static_cast<float>(v), surface};
            }
            const bool differs = (last != Facing::kUnknown && last != here) ||
                                 (last_row[j] != Facing::kUnknown && last_row[j] != here);
            const bool ends =
                here != Facing::kTrimmed && (u == whole.u_begin() || u == whole.u_end() ||
                                             v == whole.v_begin() || v == whole.v_end());
            if (differs || ends) {
                silhouette_[square] = std::max(silhouette_[square], p.point.z);
            }
            last = last_row[j] = here;
        }
    }
}

double SilhouetteMap::least_around(double x, double y) const
{
    const double at_x = std::floor((x - x0_) / pitch_);
    const double at_y = std::floor((y - y0_) / pitch_);
    if (!(at_x >= 1 && at_y >= 1 && at_x + 1 < static_cast<double>(nx_) &&
          at_y + 1 < static_cast<double>(ny_))) {
        return -kInfinite;
    }
    const double* first =
        &top_[(static_cast<std::size_t>(at_x) - 1) * ny_ + static_cast<std::size_t>(at_y) - 1];
    double least = kInfinite;
    for (int i = 0; i < 3; ++i, first += ny_) {
        least = std::min({least, first[0], first[1], first[2]});
    }
    return least;
}

double SilhouetteMap::highest_silhouette(Vec2d low, Vec2d high) const
{
    const auto first = [&](double at, double begin) {
        return static_cast<std::size_t>(std::max(0.0, std::floor((at - begin) / pitch_) - 1));
    };
    const auto end = [&](double at, double begin, std::size_t count) {
        const double after = std::max(0.0, std::floor((at - begin) / pitch_) + 2);
        return std::min(count, static_cast<std::size_t>(after));
    };
    double highest = -kInfinite;
    for (std::size_t i = first(low.x, x0_); i < end(high.x, x0_, nx_); ++i) {
        for (std::size_t j = first(low.y, y0_); j < end(high.y, y0_, ny_); ++j) {
            highest = std::max(highest, silhouette_[i * ny_ + j]);
        }
    }
    return highest;
}

bool SilhouetteMap::finds_over(Vec3d place, double by, int surface) const
{
    const double at_x = std::floor((place.x - x0_) / pitch_);
    const double at_y = std::floor((place.y - y0_) / pitch_);
    const auto ends = [](double at, std::size_t count) {
        const double most = static_cast<double>(count);
        return std::array<std::size_t, 2>{static_cast<std::size_t>(std::clamp(at - 1, 0.0, most)),
                                          static_cast<std::size_t>(std::clamp(at + 2, 0.0, most))};
    };
    const auto [i_begin, i_end] = ends(at_x, nx_);
    const auto [j_begin, j_end] = ends(at_y, ny_);
    for (std::size_t i = i_begin; i < i_end; ++i) {
        for (std::size_t j = j_begin; j < j_end; ++j) {
            const std::size_t square = i * ny_ + j;
            if (top_[square] <= place.z + by) {
                continue;
            }
            const Place& from = places_[square];
            if (surface >= 0 && from.surface != surface) {
                continue;
            }
            const auto found =
                model_.cc_point_under(place.x, place.y, from.surface, {from.u, from.v}, 0);
            if (found && found->point.z > place.z + by &&
                model_.inside_trims(found->surface, found->u, found->v)) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace cusp::finishing
