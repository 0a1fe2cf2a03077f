// Slanted facets that meet say which bands there may be; the heights beside a loop say whether it has one.
#include "host_tools/job/import/solid_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/offset/shadow.hpp"
#include "host_tools/geometry/waterline_slices/fitted_edges.hpp"

namespace cusp::import {

using offset::Contour;
using offset::Edge;
using offset::EdgeTree;
using offset::Region2d;

namespace {

using Facet = std::array<Vec3d, 3>;

constexpr double kSameLevel = 2e-3;     // mm
constexpr double kSameWidth = 0.01;     // mm: of bands
constexpr double kSameSlope = 0.05;     // of the slope: facets of a cone differ by less
constexpr double kLeastBand = 0.05;     // mm high
constexpr double kGroundWithin = 0.01;  // mm: of heights beside a loop
constexpr double kLook = 0.4;           // mm between looks along a loop
constexpr double kGentlest = 0.25;      // height over width
constexpr double kSteepest = 4;

// Height over width; none where no flank of a vee is so steep.
std::optional<double> slope_of(const Facet& t)
{
    const Vec3d across = cross(t[1] - t[0], t[2] - t[0]);
    const double rise = norm(in_plan(across));
    const double flat = std::abs(across.z);
    if (!(rise >= kGentlest * flat && rise <= kSteepest * flat && rise > 0)) {
        return std::nullopt;
    }
    return rise / flat;
}

bool are_alike(double slope, double other)
{
    return std::abs(slope - other) <= kSameSlope * std::max(slope, other);
}

bool is_one(const EdgeBand& a, const EdgeBand& b)
{
    return std::abs(a.low - b.low) <= kSameLevel && std::abs(a.high - b.high) <= kSameLevel &&
           std::abs(a.width - b.width) <= kSameWidth;
}

// Slanted facets that meet in corners, each as steep as the next.
struct Slope {
    double low{kUnbounded};  // z, mm
    double high{-kUnbounded};
    double steepness{};  // height over width, of one of them
    std::vector<Vec3d> corners;
};

// Sets of numbers that are joined by pairs.
class JoinedSets {
public:
    explicit JoinedSets(std::size_t count) : next_(count)
    {
        std::iota(next_.begin(), next_.end(), std::size_t{0});
    }
    std::size_t set_of(std::size_t k)
    {
        while (next_[k] != k) {
            next_[k] = next_[next_[k]];
            k = next_[k];
        }
        return k;
    }
    void join(std::size_t a, std::size_t b) { next_[set_of(a)] = set_of(b); }

private:
    std::vector<std::size_t> next_;
};

std::vector<Slope> slopes_of(const std::vector<Facet>& facets)
{
    constexpr double kSameCorner = 1e-5;  // mm
    std::vector<std::pair<const Facet*, double>> slanted;
    for (const Facet& facet : facets) {
        if (const auto slope = slope_of(facet)) {
            slanted.emplace_back(&facet, *slope);
        }
    }
    JoinedSets sets{slanted.size()};
    std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> at_corner;
    for (std::size_t k = 0; k < slanted.size(); ++k) {
        for (const Vec3d& p : *slanted[k].first) {
            const auto cell = [](double x) {
                return std::llround(x / kSameCorner);
            };
            std::vector<std::size_t>& there = at_corner[{cell(p.x), cell(p.y), cell(p.z)}];
            for (const std::size_t other : there) {
                if (are_alike(slanted[k].second, slanted[other].second)) {
                    sets.join(k, other);
                }
            }
            there.push_back(k);
        }
    }
    std::map<std::size_t, Slope> by_set;
    for (std::size_t k = 0; k < slanted.size(); ++k) {
        Slope& slope = by_set[sets.set_of(k)];
        slope.steepness = slanted[k].second;
        for (const Vec3d& p : *slanted[k].first) {
            slope.low = std::min(slope.low, p.z);
            slope.high = std::max(slope.high, p.z);
            slope.corners.push_back(p);
        }
    }
    std::vector<Slope> all;
    for (auto& [set, slope] : by_set) {
        if (slope.high - slope.low >= kLeastBand) {
            all.push_back(std::move(slope));
        }
    }
    return all;
}

}  // namespace

SolidEdges::SolidEdges(const std::vector<Facet>& facets) : facets_{facets}, model_{facets} {}

// A corner at the band's upper edge is as far from the lower one as the band is wide.
std::vector<EdgeBand> SolidEdges::bands() const
{
    constexpr std::size_t kMost = 64;  // a sculptured mesh has more, which are no bands
    const std::vector<Slope> slopes = slopes_of(facets_);
    std::vector<EdgeBand> found;
    for (const Slope& slope : slopes.size() > kMost ? std::vector<Slope>{} : slopes) {
        const Region2d foot = standing(slope.low);
        const EdgeTree tree{edges_of(foot)};
        EdgeBand band{slope.low, slope.high, kUnbounded};
        // an end of a broken edge is nearer to the next edge
        const double least = (1 - 2 * kSameSlope) * (slope.high - slope.low) / slope.steepness;
        for (const Vec3d& p : slope.corners) {
            const double away = tree.nearest(in_plan(p), band.width);
            if (slope.high - p.z <= kSameLevel && away >= least) {
                band.width = away;
            }
        }
        if (!(band.width < kUnbounded)) {
            band.width = (slope.high - slope.low) / slope.steepness;
        }
        // the foot is a little higher than the lower edge
        band.width *= (band.high - band.low) / (band.high - band.low - offset::kStandsAbove);
        const bool known = std::any_of(found.begin(), found.end(),
                                       [&](const EdgeBand& other) { return is_one(band, other); });
        if (!known && band.width > 0 && survey(band).count > 0) {
            found.push_back(band);
        }
    }
    std::sort(found.begin(), found.end(), [](const EdgeBand& a, const EdgeBand& b) {
        return std::pair(-a.high, a.low) < std::pair(-b.high, b.low);
    });
    return found;
}

Region2d SolidEdges::standing(double z) const
{
    return waterline_slices::fitted_region(offset::shadow_above(facets_, z), kRegionFit);
}

bool SolidEdges::is_ground(Vec2d at, double z) const
{
    const auto top = model_.height_at(at.x, at.y);
    return top && std::abs(top->point.z - z) <= kGroundWithin;
}

std::vector<SolidEdges::Look> SolidEdges::looks_along(const Contour& loop)
{
    std::vector<Look> all;
    for (const Edge& edge : loop) {
        const int looks = 1 + static_cast<int>(length(edge) / kLook);
        for (int k = 0; k < looks; ++k) {
            const double share = (k + 0.5) / looks;
            all.push_back({point_on(edge, share), offset::left_normal(tangent_on(edge, share)),
                           length(edge) / looks});
        }
    }
    return all;
}

// The ground rises with the distance from the loop, or from the one edge where others of the loop are not broken.
SolidEdges::Rise SolidEdges::rise_at(const Look& look,
                                     const EdgeTree& tree,
                                     const EdgeBand& band) const
{
    const double slope = (band.high - band.low) / band.width;
    const Vec2d across = look.across * band.width;
    for (const double part : {0.1, 0.5, 0.9}) {
        const Vec2d at = look.foot + across * part;
        if (!is_ground(at, band.low + slope * tree.nearest(at, band.width)) &&
            !is_ground(at, band.low + slope * part * band.width)) {
            return {false, false, false};
        }
    }
    constexpr double kBeyond = 0.2;
    const double beyond = slope * band.width * kBeyond;
    return {true, is_ground(look.foot - across * kBeyond, band.low - beyond),
            is_ground(look.foot + across * (1 + kBeyond), band.high + beyond)};
}

bool SolidEdges::rises_beside(const Contour& loop, const EdgeBand& band) const
{
    const EdgeTree tree{loop};
    const std::vector<Look> looks = looks_along(loop);
    const std::vector<bool> on = on_band(looks, tree, band);
    return std::find(on.begin(), on.end(), false) == on.end();
}

Region2d SolidEdges::loops(const EdgeBand& band) const
{
    Region2d found;
    const Region2d stands = standing(band.low);
    for (const Contour& loop : stands.contours) {
        if (rises_beside(loop, band)) {
            found.contours.push_back(loop);
        }
    }
    return found;
}

bool SolidEdges::is_clear(const toolpath::Tool& tool, const Region2d& centres, double z) const
{
    for (const Contour& contour : centres.contours) {
        for (const Edge& edge : contour) {
            const int looks = 1 + static_cast<int>(length(edge) / kLook);
            for (int k = 0; k < looks; ++k) {
                if (!is_clear(tool, point_on(edge, static_cast<double>(k) / looks), z)) {
                    return false;
                }
            }
        }
    }
    return true;
}

bool SolidEdges::is_clear(const toolpath::Tool& tool, Vec2d at, double z) const
{
    const auto rests = model_.drop_height(tool, at.x, at.y);
    return !rests || *rests <= z + kGroundWithin;
}

BandGround::BandGround(const EdgeBand& band, const std::vector<Edge>& edges, double beside)
    : band_{band}, reach_{band.width + beside + kGroundWithin}, tree_{edges}
{
}

bool BandGround::has(const Facet& facet) const
{
    const auto slope = slope_of(facet);
    const Vec2d middle = in_plan((facet[0] + facet[1] + facet[2]) * (1.0 / 3));
    return slope && are_alike(*slope, (band_.high - band_.low) / band_.width) &&
           std::all_of(facet.begin(), facet.end(),
                       [&](const Vec3d& p) {
                           return p.z >= band_.low - kSameLevel && p.z <= band_.high + kSameLevel;
                       }) &&
           tree_.any_nearer(middle, reach_);
}

}  // namespace cusp::import
