// The paths that entities of a drawing draw by themselves: all but references to blocks.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/dxf_drawing.hpp"

namespace cusp::import {

// In the coordinates of the drawing, mm. Empty where the entity is a curve without length.
//
// interpolated  as of drawn_spline()
//
// Returns nothing where the entity is of a kind that draws no curve.
// Errors: InputError with the line, where the entity is a curve with values that make none.
std::optional<DrawingPath> drawn_path(const DxfDrawing& drawing,
                                      const DxfEntity& entity,
                                      std::size_t& interpolated);

// The old POLYLINE, with its VERTEX entities. Nothing of a mesh.
std::optional<DrawingPath> drawn_polyline(const DxfDrawing& drawing,
                                          const DxfEntity& head,
                                          const std::vector<const DxfEntity*>& vertices);

// A place as a path without length, mm: groups 10, 20 and 30.
//
// in_object  the groups are in the coordinates of the object, not of the drawing
DrawingPath drawn_place(const DxfDrawing& drawing, const DxfEntity& entity, bool in_object);

// The direction of extrusion: groups 210, 220 and 230.
Vec3d extrusion_of(const DxfDrawing& drawing, const DxfEntity& entity);

// The point of the groups code, code + 10 and code + 20, mm; z may be left out.
// Errors: InputError where x or y is.
Vec3d point_of(const DxfDrawing& drawing, const DxfEntity& entity, int code);

}  // namespace cusp::import
