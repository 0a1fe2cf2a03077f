// Horizontal pieces of the part are gathered by height; the part above a height says where the tool may be.
#include "host_tools/cam/adaptive_isocurve/level_floors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/adaptive_isocurve/cleared_level.hpp"
#include "host_tools/cam/adaptive_isocurve/rough_constants.hpp"
#include "host_tools/cam/adaptive_isocurve/rough_depths.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"
#include "host_tools/geometry/waterline_slices/fitted_edges.hpp"
#include "host_tools/geometry/waterline_slices/waterline_slices.hpp"

namespace cusp::adaptive_isocurve {

using adaptive_clearing::AdaptiveSettings;
using adaptive_clearing::clear_adaptively;
using clearing::clear_region;
using clearing::ClearingSettings;
using job::Job;
using job::Operation;
using nurbs::Surface;
using offset::area;
using offset::Box2d;
using offset::box_of;
using offset::common;
using offset::Contour;
using offset::grown;
using offset::line_edge;
using offset::Region2d;
using offset::RegionOffset;
using part_model::PartModel;
using part_model::TrimRegion;
using toolpath::Tool;
using waterline_slices::fitted_region;
using waterline_slices::SliceSettings;
using waterline_slices::WaterlineSlices;

namespace {

constexpr double kLevel = 1e-6;      // mm: heights that differ by less are one
constexpr double kUnderTop = 1e-3;   // mm: a floor is lower than the stock's top by more
constexpr double kEdgeError = 1e-3;  // mm: of a floor's edges
constexpr double kLess = 0.02;       // mm: of what is said to be swept
constexpr double kNarrow = 0.02;     // of the radius: half the width of a strip that has no pass
constexpr std::size_t kMostHeights = 12;
constexpr std::size_t kMostPieces = 20000;  // of one floor

struct Piece {
    double z;
    Region2d region;
};

Contour closed(const std::vector<Vec2d>& corners)
{
    Contour out;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2d next = corners[(i + 1) % corners.size()];
        if (norm(next - corners[i]) > 0) {
            out.push_back(line_edge(corners[i], next));
        }
    }
    return out;
}

// The contours with the region on their left, as seen from above.
Region2d turned_up(Region2d region)
{
    if (area(region) < 0) {
        for (Contour& contour : region.contours) {
            contour = offset::reversed(contour);
        }
    }
    return region;
}

template <class Points>
bool is_level(const Points& points)
{
    return std::all_of(points.begin(), points.end(),
                       [&](Vec3d p) { return std::abs(p.z - points.front().z) <= kLevel; });
}

template <class Points>
double highest_of(const Points& points)
{
    return std::max_element(points.begin(), points.end(),
                            [](Vec3d a, Vec3d b) { return a.z < b.z; })
        ->z;
}

Region2d plan_of(const Surface& surface)
{
    std::vector<std::vector<Vec2d>> loops;
    const TrimRegion trims{surface, kEdgeError};
    if (trims.trimmed()) {
        for (const std::vector<Vec3d>& edge : trims.edges(surface)) {
            std::vector<Vec2d>& loop = loops.emplace_back();
            std::transform(edge.begin(), edge.end() - 1, std::back_inserter(loop), in_plan);
        }
    } else if (surface.degree_u == 1 && surface.degree_v == 1 && surface.points.size() == 4) {
        const auto at = [&](std::size_t k) {
            return in_plan(surface.points[k]);
        };
        loops.push_back({at(0), at(2), at(3), at(1)});
    }
    Region2d out;
    for (const std::vector<Vec2d>& loop : loops) {
        out.contours.push_back(closed(loop));
    }
    return turned_up(std::move(out));
}

std::vector<Piece> level_pieces(const Operation& operation)
{
    std::vector<Piece> out;
    for (const std::array<Vec3d, 3>& facet : operation.part.mesh) {
        if (is_level(facet)) {
            out.push_back(
                {facet[0].z,
                 turned_up({{closed({in_plan(facet[0]), in_plan(facet[1]), in_plan(facet[2])})}})});
        }
    }
    for (const Surface& surface : operation.part.floor) {
        if (operation.part.mesh.empty() && is_level(surface.points)) {
            out.push_back({surface.points.front().z, plan_of(surface)});
        }
    }
    return out;
}

// Floors of one height each, the greatest of them, from the top down.
std::vector<Piece> floors_of(std::vector<Piece> pieces, double least_area)
{
    std::sort(pieces.begin(), pieces.end(),
              [](const Piece& a, const Piece& b) { return a.z > b.z; });
    std::vector<Piece> out;
    for (Piece& piece : pieces) {
        if (out.empty() || out.back().z - piece.z > kLevel) {
            out.push_back({piece.z, {}});
        }
        std::vector<Contour>& contours = out.back().region.contours;
        std::move(piece.region.contours.begin(), piece.region.contours.end(),
                  std::back_inserter(contours));
    }
    const auto is_no_floor = [&](const Piece& floor) {
        return floor.region.contours.size() > kMostPieces || area(floor.region) < least_area;
    };
    out.erase(std::remove_if(out.begin(), out.end(), is_no_floor), out.end());
    if (out.size() > kMostHeights) {
        std::stable_sort(out.begin(), out.end(), [](const Piece& a, const Piece& b) {
            return area(a.region) > area(b.region);
        });
        out.resize(kMostHeights);
        std::sort(out.begin(), out.end(), [](const Piece& a, const Piece& b) { return a.z > b.z; });
    }
    return out;
}

// The facets or surfaces that rise over a height; none: nothing does.
std::optional<PartModel> part_above(const Operation& operation, double z)
{
    if (!operation.part.mesh.empty()) {
        std::vector<std::array<Vec3d, 3>> above;
        std::copy_if(
            operation.part.mesh.begin(), operation.part.mesh.end(), std::back_inserter(above),
            [&](const std::array<Vec3d, 3>& facet) { return highest_of(facet) > z + kLevel; });
        return above.empty() ? std::nullopt : std::optional<PartModel>{above};
    }
    std::vector<Surface> above;
    std::copy_if(operation.part.floor.begin(), operation.part.floor.end(),
                 std::back_inserter(above),
                 [&](const Surface& surface) { return highest_of(surface.points) > z + kLevel; });
    return above.empty() ? std::nullopt : std::optional<PartModel>{above};
}

// mm off the part beyond the allowance: inside the slices of the levels above, which keep as much at smooth
// walls. Beside them a floor would be cut from the stock's top on.
double inside_levels(const SliceSettings& settings)
{
    constexpr double kFits = 0.04;  // mm: of up to twenty levels, and their margins
    const double side = 1.42 * settings.least_pitch;
    return elementary::hypot(settings.clearance, std::sqrt(0.5) * side) - settings.clearance +
           0.01 * side + settings.excess + kFits;
}

// The places of the axis over the floor with the tip at its height.
Region2d centres_over(const Piece& floor, const Operation& operation, const Tool& tool)
{
    const std::optional<PartModel> above = part_above(operation, floor.z);
    Region2d centres = common(floor.region, floor.region);
    if (above) {
        const Box2d box = box_of(floor.region);
        const double out = 2.0 * tool.radius;
        const SliceSettings settings{operation.passes.allowance + kRounded,
                                     0.5 * operation.tolerance.plan,
                                     tool.radius / kPitchOfRadius,
                                     {box.x0 - out, box.y0 - out, box.x1 + out, box.y1 + out}};
        const WaterlineSlices slices{*above, tool, settings};
        centres = common(fitted_region(slices.at(floor.z, inside_levels(settings)), kFit), centres);
    }
    const double narrow = kNarrow * tool.radius;
    const Region2d core =
        centres.contours.empty() ? centres : RegionOffset{centres}.at(narrow + kFirst);
    return core.contours.empty() ? core : grown(core, narrow);
}

// False where passes do not cover the floor.
bool fill(LevelFloor& floor, const Operation& operation, const Tool& tool)
{
    const Region2d& region = floor.centres->source();
    if (operation.passes.max_engagement) {
        AdaptiveSettings settings;
        settings.tool_radius = tool.radius;
        settings.wall_clearance = kFirst;
        settings.max_engagement = *operation.passes.max_engagement * kPi / 180.0;
        settings.tolerance = std::min(kRoughChord, 0.005 * tool.radius);
        settings.corner = operation.tolerance.plan;
        settings.direction = operation.passes.direction_of_cut;
        floor.adaptive = clear_adaptively(region, settings);
        return !floor.adaptive->runs.empty() && floor.adaptive->left.empty();
    }
    const double whole = pass_spacing(tool, 0.0).stepover;
    for (const double share : {0.95, 0.9, 0.8}) {
        ClearingSettings settings;
        settings.wall_clearance = kFirst;
        settings.stepover = share * whole;
        settings.direction = operation.passes.direction_of_cut;
        floor.cleared = clear_region(region, settings);
        if (!floor.cleared.passes.empty() && covers(floor.cleared, region, whole, box_of(region))) {
            return true;
        }
    }
    return false;
}

// The smallest of the flat ends that rough.
std::optional<Tool> flat_end_of(const Operation& operation)
{
    std::vector<Tool> tools = operation.tools;
    if (tools.empty()) {
        tools.push_back(operation.tool);
    }
    std::optional<Tool> out;
    for (const Tool& tool : tools) {
        if (tool.shape == toolpath::ToolShape::kFlat && (!out || tool.radius < out->radius)) {
            out = tool;
        }
    }
    return out;
}

}  // namespace

bool LevelFloors::is_free(Vec3d a, Vec3d b, double radius) const
{
    const double low = std::min(a.z, b.z) + kLevel;
    return std::any_of(levels_.begin(), levels_.end(), [&](const LevelFloor& floor) {
        return low >= floor.z && line_inside(*floor.swept, in_plan(a), in_plan(b), radius);
    });
}

void leave_out(const LevelFloors& floors, finishing::SurfaceOperation& work)
{
    if (!floors.levels().empty()) {
        work.leave_out([&floors, &work](Vec3d a, Vec3d b) {
            return floors.is_free(a, b, work.path_fitter().offset_tool().radius);
        });
    }
}

LevelFloors level_floors(const Job& job, const Operation& operation)
{
    LevelFloors out;
    const std::optional<Tool> tool = flat_end_of(operation);
    if (!operation.passes.roughing || !tool) {
        return out;
    }
    const double least_area = kPi * tool->radius * tool->radius;
    for (const Piece& floor : floors_of(level_pieces(operation), least_area)) {
        if (floor.z > job.stock_top - kUnderTop ||
            floor.z < job.stock_bottom.value_or(-kUnbounded) - kLevel) {
            continue;
        }
        const Region2d centres = centres_over(floor, operation, *tool);
        if (centres.contours.empty()) {
            continue;
        }
        LevelFloor level{floor.z, std::make_unique<RegionOffset>(centres),
                         std::make_unique<RegionOffset>(grown(centres, tool->radius - kLess))};
        if (fill(level, operation, *tool)) {
            out.levels_.push_back(std::move(level));
            out.tool_ = tool;
        }
    }
    return out;
}

}  // namespace cusp::adaptive_isocurve
