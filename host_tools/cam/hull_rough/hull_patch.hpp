// Bezier patches and their convex hull boxes: a patch lies in the hull of its control points.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "host_tools/cam/hull_rough/box_union.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::hull_rough {

// A Bezier patch by its control points; weights are positive, so the hull property holds.
struct HullPatch {
    int degree_u{};
    int degree_v{};
    std::vector<Vec3d> points;  // (degree_u + 1) x (degree_v + 1), v fastest
    std::vector<double> weights;
    double bottom{};  // least and greatest z of the control points
    double top{};
    // Null where no edge of the surface crosses the patch.
    std::shared_ptr<const part_model::TrimRegion> trims{};
    std::array<double, 2> u{};  // domain of the patch in its surface
    std::array<double, 2> v{};
};

// mm: error of the edges of trimmed surfaces. The tolerance of every layer is larger.
constexpr double kTrimError = 5e-4;

// The Bezier patches of all surfaces, without those trimmed away. Patches crossed by an edge are
// quartered up to four times, and quarters trimmed away are left out.
std::vector<HullPatch> hull_patches(const std::vector<nurbs::Surface>& surfaces);

// The quarters of a patch, by de Casteljau's algorithm at the middle of both parameters, without
// those trimmed away.
std::vector<HullPatch> quarters(const HullPatch& patch);

// The convex hull box in plan.
Rectangle plan_box(const HullPatch& patch);

// The box in plan of the convex hull's part above `plane`; none if the whole hull is at or below.
// It is smaller than the box of the whole hull, and the surface above the plane lies in it.
std::optional<Rectangle> plan_box_above(const HullPatch& patch, double plane);

// Plan boxes that together cover every point of the patches above `plane`. Patches that cross the
// plane are quartered up to `levels` times. levels = 0 is the paper's rule: the whole box of each
// patch with its top above the plane. Boxes for a lower plane cover those for a higher one.
std::vector<Rectangle> boxes_above(const std::vector<HullPatch>& patches, double plane, int levels);

}  // namespace cusp::hull_rough
