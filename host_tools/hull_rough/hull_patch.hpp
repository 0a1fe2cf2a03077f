// Bezier patches and the boxes of their control points: a patch lies inside its convex hull.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "host_tools/hull_rough/box_union.hpp"
#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_model/trim_region.hpp"

namespace cusp::hull_rough {

// One Bezier patch by its control points alone; weights are positive, so the hull property holds.
struct HullPatch {
    int degree_u{};
    int degree_v{};
    std::vector<Vec3d> points;  // (degree_u + 1) x (degree_v + 1), v fastest
    std::vector<double> weights;
    double bottom{};  // least and greatest z of the control points
    double top{};
    // none where no edge of its surface crosses it
    std::shared_ptr<const part_model::TrimRegion> trims{};
    std::array<double, 2> u{};  // the patch in its surface's domain
    std::array<double, 2> v{};
};

// How far from the true edge of a trimmed surface a piece may be taken to be trimmed away, mm: the
// tolerance that every layer keeps is larger.
constexpr double kTrimError = 5e-4;

// The Bezier patches of all surfaces. Patches that are trimmed away are left out; those that an
// edge crosses are quartered up to four times, and the quarters that are trimmed away left out.
std::vector<HullPatch> hull_patches(const std::vector<nurbs::Surface>& surfaces);

// The quarters of a patch, by de Casteljau at the middle of both parameters, without those that are
// trimmed away.
std::vector<HullPatch> quarters(const HullPatch& patch);

// Plan view of the convex hull box.
Rectangle plan_box(const HullPatch& patch);

// Plan view of what the convex hull has above `plane`; nothing where all of it lies at or below.
// Tighter than the box of the whole hull, and as safe: the surface above the plane lies in it.
std::optional<Rectangle> plan_box_above(const HullPatch& patch, double plane);

// Plan boxes that together cover every point of the patches above `plane`, after up to `levels`
// quarterings of the patches that cross it. With no level it is the paper's rule: the whole box of
// each patch whose top is above the plane. Boxes for a lower plane cover those for a higher one.
std::vector<Rectangle> boxes_above(const std::vector<HullPatch>& patches, double plane, int levels);

}  // namespace cusp::hull_rough
