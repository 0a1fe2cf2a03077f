// A surface is trimmed where it lies above the top of another model.
#include "host_tools/geometry/part_model/model_intersection.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "host_tools/geometry/part_model/domain_contour.hpp"
#include "host_tools/geometry/part_model/surface_height_map.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::part_model {

using nurbs::Curve;
using nurbs::Surface;

namespace {

// mm: smaller differences of height count as none.
constexpr double kSameHeight = 1e-5;
// mm: how much a body is widened so that bodies may share an edge.
constexpr double kSameEdge = 2e-4;

// The top of a widened model at a point in plan; none beside it.
std::optional<double> top_at(const SurfaceHeightMap& model, Vec3d p)
{
    if (const auto top = model.at(p.x, p.y)) {
        return top;
    }
    std::optional<double> highest;
    for (int k = 0; k < 9; ++k) {
        const auto top = model.at(p.x + (k / 3 - 1) * kSameEdge, p.y + (k % 3 - 1) * kSameEdge);
        highest = top ? std::max(highest.value_or(*top), *top) : highest;
    }
    return highest;
}

class Intersection {
public:
    Intersection(const std::vector<std::vector<Surface>>& models, double edge_error)
        : models_{models}, edge_error_{edge_error}
    {
        for (const std::vector<Surface>& model : models) {
            tops_.emplace_back(model, edge_error);
        }
    }

    std::vector<Surface> surfaces() const
    {
        std::vector<Surface> out;
        for (std::size_t m = 0; m < models_.size(); ++m) {
            for (const Surface& surface : models_[m]) {
                if (std::optional<Surface> part = part_of(surface, m)) {
                    out.push_back(std::move(*part));
                }
            }
        }
        return out;
    }

private:
    // Depth of a point below the other models, mm; -kInfinite beside one of them.
    double below_others(Vec3d p, std::size_t own) const
    {
        double least = kInfinite;
        for (std::size_t m = 0; m < tops_.size(); ++m) {
            if (m != own) {
                const std::optional<double> top = top_at(tops_[m], p);
                if (!top) {
                    return -kInfinite;
                }
                least = std::min(least, *top - p.z + kSameHeight);
            }
        }
        return least;
    }

    std::optional<Surface> part_of(const Surface& surface, std::size_t own) const
    {
        const TrimRegion region{surface, edge_error_};
        const auto below = [&](Vec2d p) {
            return below_others(point_at(surface, p.x, p.y), own);
        };
        if (is_whole(surface, region, below)) {
            return surface;
        }
        const auto loops = domain_contour(
            surface,
            [&](Vec2d p) {
                return region.trimmed() && !region.inside(p.x, p.y) ? -kInfinite : below(p);
            },
            edge_error_);
        if (loops.empty()) {
            return std::nullopt;
        }
        Surface part = surface;
        part.trims.clear();
        for (const std::vector<Vec2d>& loop : loops) {
            part.trims.push_back({polyline(loop)});
        }
        return part;
    }

    // True if no sample of the surface, inside or along its edges, is cut off.
    template <class Below>
    static bool is_whole(const Surface& surface, const TrimRegion& region, const Below& below)
    {
        const DomainSamples samples = samples_over(surface);
        const Vec2d low{surface.u_begin(), surface.v_begin()};
        const Vec2d size{surface.u_end() - low.x, surface.v_end() - low.y};
        for (int i = 0; i <= samples.u; ++i) {
            for (int j = 0; j <= samples.v; ++j) {
                const Vec2d p{low.x + size.x * i / samples.u, low.y + size.y * j / samples.v};
                if ((!region.trimmed() || region.inside(p.x, p.y)) && below(p) < 0) {
                    return false;
                }
            }
        }
        for (const std::vector<Vec2d>& loop : region.loops()) {
            for (const Vec2d p : loop) {
                if (below(p) < 0) {
                    return false;
                }
            }
        }
        return true;
    }

    static Curve polyline(const std::vector<Vec2d>& loop)
    {
        Curve curve;
        curve.degree = 1;
        curve.knots.push_back(0);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            curve.points.push_back({loop[i].x, loop[i].y, 0});
            curve.weights.push_back(1);
            curve.knots.push_back(static_cast<double>(i));
        }
        curve.knots.push_back(curve.knots.back());
        return curve;
    }

    const std::vector<std::vector<Surface>>& models_;
    double edge_error_;
    std::vector<SurfaceHeightMap> tops_;
};

}  // namespace

std::vector<Surface> intersection_of(const std::vector<std::vector<Surface>>& models,
                                     double edge_error)
{
    return Intersection{models, edge_error}.surfaces();
}

}  // namespace cusp::part_model
