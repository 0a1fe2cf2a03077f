// Holes of one kind are listed together.
#include "host_tools/job/import/part_features.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/offset/shadow.hpp"
#include "host_tools/job/import/cad_fillets.hpp"
#include "host_tools/job/import/cad_holes.hpp"

namespace cusp::import {

using job::Hole;
using job::PartFeatures;
using job::PartHoles;
using job::PartPocket;
using offset::Region2d;

namespace {

constexpr double kSameFeature = 0.01;  // mm
constexpr double kLeastBeside = 0.01;  // mm^2 of the ring beside a piece

bool is_same(double a, double b) { return std::abs(a - b) <= kSameFeature; }

// Surroundings of a piece, by area: far enough that a fillet has risen.
struct Beside {
    double walls{};  // mm^2 of what stands above it
    double open{};   // mm^2 of what does not
};

Beside beside(const Region2d& piece, const Region2d& standing)
{
    constexpr double kNear = 0.4;  // mm
    constexpr double kFar = 0.5;   // mm
    const Region2d ring = offset::without(offset::grown(piece, kFar), offset::grown(piece, kNear));
    const double all = offset::area(ring);
    const double walls = offset::area(offset::common(ring, standing));
    return {walls, all - walls};
}

void add_pockets(const std::vector<std::array<Vec3d, 3>>& triangles,
                 double z,
                 PartFeatures& features)
{
    const Region2d level = offset::level_ground(triangles, z);
    const Region2d standing = offset::shadow_above(triangles, z);
    std::vector<PartPocket> found;
    for (const offset::RegionPart& part : offset::connected_parts(level)) {
        Region2d piece{{level.contours[part.outer]}};
        for (const std::size_t hole : part.holes) {
            piece.contours.push_back(level.contours[hole]);
        }
        const offset::Box2d box = offset::box_of(piece);
        PartPocket pocket{z,
                          {(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2},
                          {box.x1 - box.x0, box.y1 - box.y0},
                          offset::area(piece),
                          false};
        const Beside sides = pocket.area >= offset::kLeastLevel
                                 ? beside({{piece.contours.front()}}, standing)
                                 : Beside{};
        if (sides.walls > kLeastBeside) {
            pocket.open = sides.open > kLeastBeside;
            found.push_back(pocket);
        }
    }
    std::sort(found.begin(), found.end(), [](const PartPocket& a, const PartPocket& b) {
        return std::tie(b.area, a.middle.x, a.middle.y) < std::tie(a.area, b.middle.x, b.middle.y);
    });
    features.pockets.insert(features.pockets.end(), found.begin(), found.end());
}

// The hole right under another one about its axis that is wider.
const Hole* hole_under(const Hole& wide, const std::vector<Hole>& holes)
{
    for (const Hole& hole : holes) {
        if (norm(hole.at - wide.at) <= kSameFeature &&
            hole.diameter < wide.diameter - kSameFeature &&
            hole.span->top <= wide.span->bottom + kSameFeature) {
            return &hole;
        }
    }
    return nullptr;
}

std::optional<job::HoleMouth> mouth_of(const Hole& hole, const CadHoles& found, std::size_t place)
{
    for (const Hole& wide : found.holes) {
        if (hole_under(wide, found.holes) == &hole) {
            return job::HoleMouth{wide.diameter, wide.span->top - hole.span->top, 0};
        }
    }
    return found.cones[place];
}

bool is_kind(const PartHoles& a, const PartHoles& b)
{
    const bool same_mouth = a.mouth.has_value() == b.mouth.has_value() &&
                            (!a.mouth || (is_same(a.mouth->diameter, b.mouth->diameter) &&
                                          is_same(a.mouth->depth, b.mouth->depth) &&
                                          is_same(a.mouth->angle, b.mouth->angle)));
    return same_mouth && a.through == b.through && is_same(a.diameter, b.diameter) &&
           is_same(a.top, b.top) && is_same(a.depth, b.depth) && is_same(a.tip, b.tip);
}

void add_holes(const CadHoles& found, PartFeatures& features)
{
    for (std::size_t k = 0; k < found.holes.size(); ++k) {
        const Hole& hole = found.holes[k];
        if (hole_under(hole, found.holes) != nullptr) {
            continue;  // a counterbore
        }
        const Hole::Span& span = *hole.span;
        const PartHoles one{hole.diameter, span.top,     span.top - span.bottom - span.tip,
                            span.tip,      span.through, mouth_of(hole, found, k),
                            {hole.at}};
        const auto kind = std::find_if(features.holes.begin(), features.holes.end(),
                                       [&](const PartHoles& other) { return is_kind(one, other); });
        if (kind == features.holes.end()) {
            features.holes.push_back(one);
        } else {
            kind->places.push_back(hole.at);
        }
    }
    features.closed_above = found.closed_above;
}

bool is_in_hole(const PartPocket& pocket, const std::vector<Hole>& holes)
{
    return std::any_of(holes.begin(), holes.end(), [&](const Hole& hole) {
        return norm(hole.at - pocket.middle) <= kSameFeature &&
               std::max(pocket.size.x, pocket.size.y) <= hole.diameter + kSameFeature;
    });
}

}  // namespace

PartFeatures features_of_mesh(const std::vector<std::array<Vec3d, 3>>& triangles)
{
    PartFeatures features;
    for (const offset::LevelHeight& level : offset::level_heights(triangles)) {
        features.levels.push_back({level.z, level.area});
    }
    std::reverse(features.levels.begin(), features.levels.end());
    for (std::size_t k = 1; k < features.levels.size(); ++k) {
        add_pockets(triangles, features.levels[k].z, features);
    }
    return features;
}

PartFeatures features_of_model(const CadModel& model)
{
    PartFeatures features = features_of_mesh(model.triangles);
    const CadHoles found = holes_of(model);
    features.pockets.erase(
        std::remove_if(features.pockets.begin(), features.pockets.end(),
                       [&](const PartPocket& pocket) { return is_in_hole(pocket, found.holes); }),
        features.pockets.end());
    add_holes(found, features);
    std::vector<double> radii = found.corners;
    std::sort(radii.begin(), radii.end());
    for (const double radius : radii) {
        if (features.corners.empty() || !is_same(features.corners.back().radius, radius)) {
            features.corners.push_back({radius, 0});
        }
        ++features.corners.back().count;
    }
    features.fillets = fillets_of(model);
    return features;
}

}  // namespace cusp::import
