// Fit points beside control points are what the drawing program made them of: they are not read.
#include "host_tools/job/import/dxf_spline.hpp"

#include <cmath>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/job/import/interpolated_curve.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

// Points of the groups code, code + 10 and code + 20, mm. z may be left out.
std::vector<Vec3d> points_of(const DxfDrawing& drawing, const DxfEntity& entity, int code)
{
    const std::vector<double> x = drawing.values(entity, code);
    const std::vector<double> y = drawing.values(entity, code + 10);
    const std::vector<double> z = drawing.values(entity, code + 20);
    if (x.size() != y.size() || (!z.empty() && z.size() != x.size())) {
        drawing.refuse(entity.line,
                       fmt::format("SPLINE with {} x, {} y and {} z of {} points", x.size(),
                                   y.size(), z.size(), code == 10 ? "control" : "fit"));
    }
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < x.size(); ++i) {
        points.push_back(drawing.unit() * Vec3d{x[i], y[i], z.empty() ? 0 : z[i]});
    }
    return points;
}

std::optional<Vec3d> direction(const DxfDrawing& drawing, const DxfEntity& entity, int code)
{
    const Vec3d tangent{drawing.value(entity, code, 0), drawing.value(entity, code + 10, 0),
                        drawing.value(entity, code + 20, 0)};
    return norm(tangent) > 0 ? std::optional{tangent} : std::nullopt;
}

bool are_different(const std::vector<Vec3d>& points)
{
    constexpr double kSamePlace = 1e-6;  // mm
    for (const Vec3d p : points) {
        if (norm(p - points.front()) > kSamePlace) {
            return true;
        }
    }
    return false;
}

DrawingPath through_fit_points(const DxfDrawing& drawing, const DxfEntity& entity)
{
    const std::vector<Vec3d> points = points_of(drawing, entity, 11);
    if (points.empty() || !are_different(points)) {
        drawing.refuse(entity.line, points.empty()
                                        ? "SPLINE without control points and without fit points"
                                        : "SPLINE whose fit points are one place");
    }
    constexpr double kSamePlace = 1e-6;    // mm
    constexpr unsigned kClosed = 1U | 2U;  // closed, or periodic
    const EndTangents tangents{direction(drawing, entity, 12), direction(drawing, entity, 13)};
    const bool meets = norm(points.back() - points.front()) <= kSamePlace;
    const bool closed =
        (drawing.flags(entity, 70) & kClosed) != 0 || (meets && !tangents.first && !tangents.last);
    return {{interpolated_curve(points, closed, tangents)}, closed || meets};
}

}  // namespace

DrawingPath drawn_spline(const DxfDrawing& drawing,
                         const DxfEntity& entity,
                         std::size_t& interpolated)
{
    Curve curve;
    curve.points = points_of(drawing, entity, 10);
    if (curve.points.empty()) {
        ++interpolated;
        return through_fit_points(drawing, entity);
    }
    drawing.required(entity, 71);
    curve.degree = static_cast<int>(drawing.flags(entity, 71));
    curve.knots = drawing.values(entity, 40);
    merge_close_knots(curve.knots);
    curve.weights = drawing.values(entity, 41);
    if (curve.weights.empty()) {
        curve.weights.assign(curve.points.size(), 1.0);
    }
    const std::string place = fmt::format("{}:{}: SPLINE", drawing.file(), entity.line);
    DrawingPath path;
    for (const Curve& part : parts_of(curve)) {
        check_curve(part, place, kLargestDrawn);
        path.curves.push_back(clamped(part));
    }
    return path;
}

}  // namespace cusp::import
