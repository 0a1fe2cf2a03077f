// Facets are sorted by their slopes.
#include "host_tools/job/import/solid_ground.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "firmware/base/math.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/job/import/part_regions.hpp"

namespace cusp::import {

using offset::area;
using offset::Contour;
using offset::length;
using offset::Region2d;

namespace {

using Triangle = std::array<Vec3d, 3>;

constexpr double kUprightNormal = 1e-3;  // z of a unit normal: no more is a wall
constexpr double kSameHeight = 1e-3;     // mm
constexpr double kSameFoot = 5e-3;       // mm
constexpr double kLeastWall = 1.0;       // mm^2: a wall of less is none
constexpr double kShareOfWalls = 0.05;   // of all walls: at a foot with less no pass is made

double lowest(const Triangle& t) { return std::min({t[0].z, t[1].z, t[2].z}); }
double highest(const Triangle& t) { return std::max({t[0].z, t[1].z, t[2].z}); }
Vec3d middle(const Triangle& t) { return (t[0] + t[1] + t[2]) * (1.0 / 3); }

// mm: the length of the facet's lowest edge; 0 if that is a corner.
double level_foot(const Triangle& t)
{
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d a = t[k];
        const Vec3d b = t[(k + 1) % 3];
        if (std::max(a.z, b.z) <= lowest(t) + kSameHeight) {
            return norm(in_plan(b - a));
        }
    }
    return 0;
}

bool is_in_hole(Vec3d p, const std::vector<job::Hole>& holes)
{
    return std::any_of(holes.begin(), holes.end(), [&](const job::Hole& hole) {
        return norm(in_plan(p) - hole.at) <= hole.diameter / 2;
    });
}

bool is_on_side(const Triangle& t, const PartExtent& box)
{
    const auto lie = [&](double Vec3d::*axis, double at) {
        return std::all_of(t.begin(), t.end(), [&](const Vec3d& corner) {
            return std::abs(corner.*axis - at) <= kSameHeight;
        });
    };
    return lie(&Vec3d::x, box.low.x) || lie(&Vec3d::x, box.high.x) || lie(&Vec3d::y, box.low.y) ||
           lie(&Vec3d::y, box.high.y);
}

class SolidSurvey {
public:
    SolidSurvey(const Triangles& facets,
                const std::vector<job::Hole>& holes,
                const std::vector<job::Hole>& mouths,
                const IsCutApart& is_cut_apart)
        : facets_{facets}, holes_{holes}, mouths_{mouths}, is_cut_apart_{is_cut_apart}
    {
        ground_.box = extent_of_triangles(facets);
    }

    SolidGround ground()
    {
        add_openings();
        add_walls();
        add_slanted();
        return std::move(ground_);
    }

private:
    // Bands from the part's top through the heights, which fall.
    std::vector<SolidBand> bands_down(const std::vector<double>& bottoms) const
    {
        std::vector<SolidBand> bands;
        double top = ground_.box.high.z;
        for (const double bottom : bottoms) {
            if (bottom < top - kSameHeight) {
                bands.push_back({top, bottom, false, kUnbounded});
                top = bottom;
            }
        }
        return bands;
    }

    void add_openings()
    {
        std::vector<double> bottoms;
        for (const offset::LevelHeight& level : offset::level_heights(facets_)) {
            if (mouths_.empty() || !is_floor_of_holes(level.z)) {
                bottoms.insert(bottoms.begin(), level.z);
            }
        }
        bottoms.push_back(ground_.box.low.z);
        for (const SolidBand& band : bands_down(bottoms)) {
            if (has_opening(filled(offset::shadow_above(facets_, band.bottom), band.bottom))) {
                ground_.openings.push_back(band);
            }
        }
    }

    Region2d filled(const Region2d& region, double z) const
    {
        return with_holes_filled(region, mouths_, z);
    }

    bool is_floor_of_holes(double z) const
    {
        const Region2d level = offset::level_ground(facets_, z);
        return area(offset::without(level, filled({}, z))) < offset::kLeastLevel;
    }

    bool has_opening(const Region2d& stands) const
    {
        const Region2d open = offset::without(box_region(ground_.box), stands);
        // Strips beside the box are rounding.
        return std::any_of(open.contours.begin(), open.contours.end(), [](const Contour& contour) {
            return std::abs(area(contour)) > 2 * kRegionFit * length(contour);
        });
    }

    // mm: radius of the largest disc in the region, to a hundredth.
    static double widest(const Region2d& region)
    {
        const offset::RegionOffset inward{region};
        double fits = 0;
        double over = offset::box_of(region).x1 - offset::box_of(region).x0;
        while (over - fits > 0.01 * over) {
            const double middle = (fits + over) / 2;
            (inward.at(middle).contours.empty() ? over : fits) = middle;
        }
        return fits;
    }

    bool fills_box(const Region2d& stands) const
    {
        const Contour box = box_region(ground_.box).contours.front();
        return std::any_of(stands.contours.begin(), stands.contours.end(), [&](const Contour& c) {
            return area(c) >= area(box) - 2 * kRegionFit * length(box);
        });
    }

    // Walls of which much begins at one height.
    void add_walls()
    {
        std::map<double, double> by_foot;  // mm^2
        for (const Triangle& t : facets_) {
            const Vec3d across = cross(t[1] - t[0], t[2] - t[0]);
            if (std::abs(across.z) <= kUprightNormal * norm(across) &&
                !is_on_side(t, ground_.box) && !is_in_hole(middle(t), holes_)) {
                const double foot = std::round(lowest(t) / kSameFoot) * kSameFoot;
                by_foot[foot] += level_foot(t) * (highest(t) - lowest(t));
                ground_.wall += norm(across) / 2;
            }
        }
        const double least = std::max(kLeastWall, kShareOfWalls * ground_.wall);
        std::vector<double> feet;
        for (const auto& [foot, wall] : by_foot) {
            if (wall >= least) {
                feet.insert(feet.begin(), foot);
                ground_.wall -= wall;
            }
        }
        ground_.wall = std::max(0.0, ground_.wall);
        ground_.walls = bands_down(feet);
        for (SolidBand& band : ground_.walls) {
            const Region2d stands = filled(offset::shadow_above(facets_, band.bottom), band.bottom);
            band.fills_box = fills_box(stands);
            if (band.fills_box) {
                band.widest = widest(offset::without(box_region(ground_.box), stands));
            }
        }
    }

    void add_slanted()
    {
        Triangles slanted;
        for (const Triangle& t : facets_) {
            const Vec3d across = cross(t[1] - t[0], t[2] - t[0]);
            if (std::abs(across.z) > kUprightNormal * norm(across) &&
                highest(t) - lowest(t) > kSameHeight && !is_in_hole(middle(t), holes_) &&
                !is_cut_apart_(t)) {
                slanted.push_back(t);
            }
        }
        if (slanted.empty()) {
            return;
        }
        const part_model::PartModel model{facets_};
        double largest = 0;
        for (const Triangle& t : slanted) {
            const Vec3d at = middle(t);
            const auto top = model.height_at(at.x, at.y);
            if (top && top->point.z > at.z + kSameHeight) {
                continue;  // material is above it
            }
            const double seen = std::abs(cross(t[1] - t[0], t[2] - t[0]).z) / 2;
            ground_.slanted += seen;
            if (seen > largest) {
                largest = seen;
                ground_.slanted_at = at;
            }
        }
    }

    const Triangles& facets_;
    const std::vector<job::Hole>& holes_;
    const std::vector<job::Hole>& mouths_;
    const IsCutApart& is_cut_apart_;
    SolidGround ground_;
};

}  // namespace

SolidGround ground_of_solid(const Triangles& facets,
                            const std::vector<job::Hole>& holes,
                            const std::vector<job::Hole>& mouths,
                            const IsCutApart& is_cut_apart)
{
    return SolidSurvey{facets, holes, mouths, is_cut_apart}.ground();
}

}  // namespace cusp::import
