// Circles, arcs, polylines and references are in the coordinates of the object; lines, ellipses, splines
// and polylines in space in those of the drawing.
#include "host_tools/job/import/dxf_entities.hpp"

#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/job/import/dxf_plane.hpp"
#include "host_tools/job/import/dxf_spline.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

constexpr double kLeastLength = 1e-9;

struct Vertex {
    Vec3d at;
    double bulge;  // tangent of a quarter of the sweep to the next vertex
};

void place_on(const Similarity& axes, double elevation, Curve& curve)
{
    for (Vec3d& p : curve.points) {
        p = axes.of({p.x, p.y, elevation});
    }
}

DrawingPath drawn_line(const DxfDrawing& drawing, const DxfEntity& entity)
{
    const Vec3d a = point_of(drawing, entity, 10);
    const Vec3d b = point_of(drawing, entity, 11);
    if (!(norm(b - a) > kLeastLength)) {
        return {};
    }
    return {{Curve{1, {0, 0, 1, 1}, {a, b}, {1, 1}}}, false};
}

DrawingPath drawn_arc(const DxfDrawing& drawing, const DxfEntity& entity)
{
    const Vec3d centre = point_of(drawing, entity, 10);
    const double radius = drawing.unit() * drawing.required(entity, 40);
    if (!(radius > 0)) {
        drawing.refuse(entity.line, fmt::format("{} of radius {} mm", entity.type, radius));
    }
    double start = 0;
    double sweep = 2 * kPi;
    if (entity.type == "ARC") {
        start = drawing.required(entity, 50) * kPi / 180;
        sweep = std::fmod(drawing.required(entity, 51) * kPi / 180 - start, 2 * kPi);
        sweep += sweep <= 0 ? 2 * kPi : 0;
    }
    Curve curve = arc_curve(in_plan(centre), radius, start, sweep);
    place_on(object_axes(extrusion_of(drawing, entity)), centre.z, curve);
    return {{std::move(curve)}, entity.type == "CIRCLE"};
}

// Centre, end of the longer half axis from there, ratio of the axes, first and last parameter.
DrawingPath drawn_ellipse(const DxfDrawing& drawing, const DxfEntity& entity)
{
    const Vec3d centre = point_of(drawing, entity, 10);
    const Vec3d major = point_of(drawing, entity, 11);
    const double ratio = drawing.required(entity, 40);
    if (!(ratio > 0) || !(norm(major) > kLeastLength)) {
        drawing.refuse(entity.line, fmt::format("ELLIPSE with half axes of {:g} and {:g} mm",
                                                norm(major), ratio * norm(major)));
    }
    const double start = drawing.value(entity, 41, 0);
    double sweep = std::fmod(drawing.value(entity, 42, 2 * kPi) - start, 2 * kPi);
    constexpr double kWhole = 1e-9;
    const bool whole = sweep <= kWhole && sweep >= -kWhole;
    sweep += sweep <= kWhole ? 2 * kPi : 0;
    const Vec3d minor = ratio * cross(object_axes(extrusion_of(drawing, entity)).axes[2], major);
    Curve curve = arc_curve({0, 0}, 1, start, sweep);
    for (Vec3d& p : curve.points) {
        p = centre + p.x * major + p.y * minor;
    }
    return {{std::move(curve)}, whole};
}

// axes  of the vertices
DrawingPath path_through(const std::vector<Vertex>& vertices, bool closed, const Similarity& axes)
{
    DrawingPath path{{}, closed};
    for (std::size_t i = 0; i + (closed ? 0 : 1) < vertices.size(); ++i) {
        const Vertex& from = vertices[i];
        const Vec3d to = vertices[(i + 1) % vertices.size()].at;
        if (!(norm(to - from.at) > kLeastLength)) {
            continue;
        }
        Curve curve = bulged_curve(in_plan(from.at), in_plan(to), from.bulge);
        for (Vec3d& p : curve.points) {
            p.z = from.at.z;
        }
        curve.points.back().z = to.z;
        for (Vec3d& p : curve.points) {
            p = axes.of(p);
        }
        path.curves.push_back(std::move(curve));
    }
    return path;
}

constexpr unsigned kClosed = 1U;

DrawingPath drawn_light_polyline(const DxfDrawing& drawing, const DxfEntity& entity)
{
    const double elevation = drawing.unit() * drawing.value(entity, 38, 0);
    std::vector<Vertex> vertices;
    for (const DxfGroup& group : entity.groups) {
        if (group.code == 10) {
            vertices.push_back({{drawing.unit() * drawing.number(group), 0, elevation}, 0});
        } else if (group.code == 20 && !vertices.empty()) {
            vertices.back().at.y = drawing.unit() * drawing.number(group);
        } else if (group.code == 42 && !vertices.empty()) {
            vertices.back().bulge = drawing.number(group);
        }
    }
    return path_through(vertices, (drawing.flags(entity, 70) & kClosed) != 0,
                        object_axes(extrusion_of(drawing, entity)));
}

}  // namespace

Vec3d extrusion_of(const DxfDrawing& drawing, const DxfEntity& entity)
{
    return {drawing.value(entity, 210, 0), drawing.value(entity, 220, 0),
            drawing.value(entity, 230, 1)};
}

Vec3d point_of(const DxfDrawing& drawing, const DxfEntity& entity, int code)
{
    return drawing.unit() * Vec3d{drawing.required(entity, code),
                                  drawing.required(entity, code + 10),
                                  drawing.value(entity, code + 20, 0)};
}

DrawingPath drawn_place(const DxfDrawing& drawing, const DxfEntity& entity, bool in_object)
{
    Vec3d at = point_of(drawing, entity, 10);
    if (in_object) {
        at = object_axes(extrusion_of(drawing, entity)).of(at);
    }
    return {{Curve{1, {0, 0, 1, 1}, {at, at}, {1, 1}}}, false};
}

std::optional<DrawingPath> drawn_polyline(const DxfDrawing& drawing,
                                          const DxfEntity& head,
                                          const std::vector<const DxfEntity*>& vertices)
{
    constexpr unsigned kInSpace = 8U;
    constexpr unsigned kMesh = 16U | 64U;
    constexpr unsigned kControlPoint = 16U;  // of a spline that the other vertices follow
    const unsigned flags = drawing.flags(head, 70);
    if ((flags & kMesh) != 0) {
        return std::nullopt;
    }
    const bool in_space = (flags & kInSpace) != 0;
    std::vector<Vertex> corners;
    for (const DxfEntity* vertex : vertices) {
        if ((drawing.flags(*vertex, 70) & kControlPoint) == 0) {
            Vec3d at = point_of(drawing, *vertex, 10);
            at.z = in_space ? at.z : drawing.unit() * drawing.value(head, 30, 0);
            corners.push_back({at, in_space ? 0 : drawing.value(*vertex, 42, 0)});
        }
    }
    return path_through(corners, (flags & kClosed) != 0,
                        in_space ? Similarity{} : object_axes(extrusion_of(drawing, head)));
}

std::optional<DrawingPath> drawn_path(const DxfDrawing& drawing,
                                      const DxfEntity& entity,
                                      std::size_t& interpolated)
{
    if (entity.type == "LINE") {
        return drawn_line(drawing, entity);
    }
    if (entity.type == "ARC" || entity.type == "CIRCLE") {
        return drawn_arc(drawing, entity);
    }
    if (entity.type == "LWPOLYLINE") {
        return drawn_light_polyline(drawing, entity);
    }
    if (entity.type == "ELLIPSE") {
        return drawn_ellipse(drawing, entity);
    }
    if (entity.type == "SPLINE") {
        return drawn_spline(drawing, entity, interpolated);
    }
    return std::nullopt;
}

}  // namespace cusp::import
