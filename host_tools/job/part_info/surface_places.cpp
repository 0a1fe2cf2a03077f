// Cells of Bezier patches; a trimmed cell counts with the fraction of it that remains.
#include "host_tools/job/part_info/surface_places.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/part_model/pattern_search.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::part_info {

using nurbs::BezierPatch;
using nurbs::Surface;
using nurbs::SurfacePoint;
using part_model::pattern_search;
using part_model::TrimRegion;

namespace {

constexpr double kEdgeError = 1e-3;  // mm, of trims
constexpr double kSurfacePlaces = 30000;
constexpr double kVertical = 1e-9;  // z of a normal
constexpr double kParallel = 1e-12;

// True if the point is inside the trims.
bool kept(const TrimRegion& region, double u, double v)
{
    return !region.trimmed() || region.inside(u, v);
}

// The greatest length of three isolines of the patch, in each direction.
std::array<double, 2> lengths_of(const Surface& s)
{
    constexpr int kSteps = 8;
    std::array<double, 2> longest{};
    for (const std::size_t way : {std::size_t{0}, std::size_t{1}}) {
        for (int line = 0; line < 3; ++line) {
            double length = 0;
            Vec3d last;
            for (int k = 0; k <= kSteps; ++k) {
                const double along = static_cast<double>(k) / kSteps;
                const double a = way == 0 ? along : line / 2.0;
                const double b = way == 0 ? line / 2.0 : along;
                const Vec3d p = point_at(s, s.u_begin() + a * (s.u_end() - s.u_begin()),
                                         s.v_begin() + b * (s.v_end() - s.v_begin()));
                length += k > 0 ? norm(p - last) : 0;
                last = p;
            }
            longest[way] = std::max(longest[way], length);
        }
    }
    return longest;
}

// A Bezier patch with its own parameters.
struct Patch {
    int surface;
    Surface bezier;
    std::array<double, 2> lengths;
};

class Gathering {
public:
    Gathering(const std::vector<Surface>& surfaces, const std::vector<double>& outwards)
        : surfaces_{surfaces}, outwards_{outwards}
    {
        for (const Surface& surface : surfaces) {
            regions_.emplace_back(surface, kEdgeError);
        }
    }

    SurfacePlaces gathered()
    {
        std::vector<Patch> patches;
        double area = 0;
        for (std::size_t k = 0; k < surfaces_.size(); ++k) {
            for (BezierPatch& patch : bezier_patches(surfaces_[k])) {
                const auto lengths = lengths_of(patch.surface);
                area += lengths[0] * lengths[1];
                patches.push_back({static_cast<int>(k), std::move(patch.surface), lengths});
            }
        }
        const double width = std::sqrt(area / kSurfacePlaces);
        for (const Patch& patch : patches) {
            add_cells(patch, width);
            add_corners(patch);
        }
        for (std::size_t k = 0; k < surfaces_.size(); ++k) {
            add_edges(static_cast<int>(k));
        }
        return std::move(out_);
    }

private:
    void add(int surface, const SurfacePoint& p, double u, double v, double area)
    {
        const Vec3d across = cross(p.du, p.dv);
        Vec3d normal = upward_normal(p);
        if (!(norm(normal) > 0)) {
            return;
        }
        const double outward = outwards_.empty() ? 0 : outwards_[static_cast<std::size_t>(surface)];
        if (outward != 0 && dot(normal, across) * outward < 0) {
            normal = normal * -1.0;
        }
        const bool vertical = std::abs(normal.z) < kVertical;
        out_.places.push_back({p.point, normal, area, outward == 0 && vertical,
                               outward != 0 && normal.z < -kVertical});
        out_.at.push_back({surface, u, v});
    }

    void add_cells(const Patch& patch, double width)
    {
        const Surface& s = patch.bezier;
        const TrimRegion& region = regions_[static_cast<std::size_t>(patch.surface)];
        constexpr int kLeast = 3;
        constexpr int kMost = 200;
        const auto cells = [&](double length) {
            return std::clamp(static_cast<int>(std::ceil(length / width)), kLeast, kMost);
        };
        const int nu = cells(patch.lengths[0]);
        const int nv = cells(patch.lengths[1]);
        const double du = (s.u_end() - s.u_begin()) / nu;
        const double dv = (s.v_end() - s.v_begin()) / nv;
        for (int k = 0; k < nu * nv; ++k) {
            const double u0 = s.u_begin() + k % nu * du;
            const double v0 = s.v_begin() + k / nu * dv;
            add_cell(patch, region, {u0, v0}, {du, dv});
        }
    }

    // If a trim crosses the cell, the sample is a point inside the trim.
    void add_cell(const Patch& patch, const TrimRegion& region, Vec2d low, Vec2d size)
    {
        constexpr int kParts = 5;
        const bool whole =
            !region.trimmed() ||
            region.part(low.x, low.x + size.x, low.y, low.y + size.y) == TrimRegion::Part::kInside;
        const Vec2d middle = low + 0.5 * size;
        if (whole) {
            const SurfacePoint p = derivatives_at(patch.bezier, middle.x, middle.y);
            add(patch.surface, p, middle.x, middle.y, norm(cross(p.du, p.dv)) * size.x * size.y);
            return;
        }
        int inside = 0;
        Vec2d place = middle;
        for (int k = 0; k < kParts * kParts; ++k) {
            const Vec2d part{low.x + (k % kParts + 0.5) / kParts * size.x,
                             low.y + (k / kParts + 0.5) / kParts * size.y};
            if (kept(region, part.x, part.y)) {
                place = inside == 0 || norm(part - middle) < norm(place - middle) ? part : place;
                ++inside;
            }
        }
        if (inside > 0) {
            const SurfacePoint p = derivatives_at(patch.bezier, place.x, place.y);
            const double share = static_cast<double>(inside) / (kParts * kParts);
            add(patch.surface, p, place.x, place.y,
                share * norm(cross(p.du, p.dv)) * size.x * size.y);
        }
    }

    void add_corners(const Patch& patch)
    {
        constexpr int kSides = 4;
        const Surface& s = patch.bezier;
        for (int k = 0; k <= kSides; ++k) {
            for (int side = 0; side < 4; ++side) {
                const double along = static_cast<double>(k) / kSides;
                const double a = side < 2 ? along : side - 2.0;
                const double b = side < 2 ? side : along;
                const double u = s.u_begin() + a * (s.u_end() - s.u_begin());
                const double v = s.v_begin() + b * (s.v_end() - s.v_begin());
                if (kept(regions_[static_cast<std::size_t>(patch.surface)], u, v)) {
                    add(patch.surface, derivatives_at(s, u, v), u, v, 0);
                }
            }
        }
    }

    void add_edges(int surface)
    {
        constexpr std::size_t kMost = 200;  // for each loop
        for (const auto& loop : regions_[static_cast<std::size_t>(surface)].loops()) {
            const std::size_t step = std::max<std::size_t>(1, loop.size() / kMost);
            for (std::size_t k = 0; k < loop.size(); k += step) {
                const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
                add(surface, derivatives_at(s, loop[k].x, loop[k].y), loop[k].x, loop[k].y, 0);
            }
        }
    }

    const std::vector<Surface>& surfaces_;
    const std::vector<double>& outwards_;
    std::vector<TrimRegion> regions_;
    SurfacePlaces out_;
};

// Within 1e-4 of the surface's size from a pole: derivatives are dominated by rounding there.
bool beside_pole(const Surface& s, const SurfacePoint& p)
{
    constexpr double kShare = 1e-4;
    const double u = norm(p.du) * (s.u_end() - s.u_begin());
    const double v = norm(p.dv) * (s.v_end() - s.v_begin());
    return u < kShare * v || v < kShare * u;
}

}  // namespace

SurfacePlaces surface_places(const std::vector<Surface>& surfaces,
                             const std::vector<double>& outwards)
{
    return Gathering{surfaces, outwards}.gathered();
}

std::optional<double> hollow_radius(const SurfacePoint& p, Vec3d normal)
{
    const double e = dot(p.du, p.du);
    const double f = dot(p.du, p.dv);
    const double g = dot(p.dv, p.dv);
    const double square = e * g - f * f;
    if (!(square > kParallel * e * g)) {
        return std::nullopt;  // a pole
    }
    const double l = dot(p.duu, normal);
    const double m = dot(p.duv, normal);
    const double n = dot(p.dvv, normal);
    const double mean = (e * n - 2 * f * m + g * l) / (2 * square);
    const double gauss = (l * n - m * m) / square;
    const double greater = mean + std::sqrt(std::max(0.0, mean * mean - gauss));
    constexpr double kFlat = 1e-9;  // 1/mm
    return greater > kFlat ? std::optional{1 / greater} : std::nullopt;
}

std::optional<Hollow> smallest_hollow(const std::vector<Surface>& surfaces,
                                      const SurfacePlaces& places,
                                      const std::vector<char>& hidden)
{
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t k = 0; k < places.places.size(); ++k) {
        const GroundPlace& place = places.places[k];
        if (hidden[k] != 0 || place.two_sided) {
            continue;
        }
        const SurfaceAt& at = places.at[k];
        const Surface& surface = surfaces[static_cast<std::size_t>(at.surface)];
        const SurfacePoint p = derivatives_at(surface, at.u, at.v);
        const auto radius = hollow_radius(p, place.normal);
        if (radius && !beside_pole(surface, p)) {
            found.emplace_back(*radius, k);
        }
    }
    constexpr std::size_t kWalks = 8;
    const std::size_t walks = std::min(kWalks, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(walks),
                      found.end());
    std::optional<Hollow> smallest;
    for (std::size_t w = 0; w < walks; ++w) {
        const SurfaceAt& at = places.at[found[w].second];
        const Surface& s = surfaces[static_cast<std::size_t>(at.surface)];
        const TrimRegion region{s, kEdgeError};
        Hollow here{found[w].first, places.places[found[w].second]};
        const Vec3d side = here.place.normal;
        const Vec2d width{s.u_end() - s.u_begin(), s.v_end() - s.v_begin()};
        constexpr double kFirst = 0.01;
        constexpr double kFinest = 1e-6;
        pattern_search({at.u / width.x, at.v / width.y}, kFirst, kFinest, [&](Vec2d place) {
            const double u = std::clamp(place.x * width.x, s.u_begin(), s.u_end());
            const double v = std::clamp(place.y * width.y, s.v_begin(), s.v_end());
            const SurfacePoint p = derivatives_at(s, u, v);
            Vec3d normal = upward_normal(p);
            normal = dot(normal, side) < 0 ? normal * -1.0 : normal;
            const auto radius = hollow_radius(p, normal);
            if (!radius || *radius >= here.radius || beside_pole(s, p) || !kept(region, u, v)) {
                return false;
            }
            here.radius = *radius;
            here.place.point = p.point;
            here.place.normal = normal;
            return true;
        });
        if (!smallest || here.radius < smallest->radius) {
            smallest = here;
        }
    }
    return smallest;
}

}  // namespace cusp::part_info
