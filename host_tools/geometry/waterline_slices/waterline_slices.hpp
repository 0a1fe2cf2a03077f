// Waterline slices: the region of a tool's axis with its tip at a height, by contours that are
// proved to keep their distance from the model.
//
//     SliceSettings settings{0.3, 0.01, 0.2, {0, 0, 80, 60}};  // mm: clearance, excess, pitch, field
//     const WaterlineSlices slices{model, tool, settings};
//     slices.at(-4.0, 0.0);        // where the axis may be with the tip at z = -4
//
// Their contours have many short edges: fitted_edges() makes few lines and arcs of them.
#pragma once

#include <algorithm>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::waterline_slices {

struct SliceSettings {
    double clearance{};    // mm >= 0: least distance of the tool from the model
    double excess{};       // mm > 0: how much larger the distance may be at smooth walls
    double least_pitch{};  // mm > 0: finest pitch of the lattice, whatever `excess` requires
    offset::Box2d field;   // limits of the axis
};

// Slices on one lattice of triangles, from the distances of the tool from the model at its nodes.
//
// Proof: let D be the distance of the model from the tool's core (the tool offset inward by its
// corner radius), with the axis at x in the plane. D^2 - |x|^2 is a minimum of functions linear in
// x, hence concave. Thus in a triangle D^2 is at least its linear interpolation less a quarter of
// the squared longest side. Contours are level lines of the linear interpolation, higher by that
// much, so no later check is necessary. D grows with the height, so a slice lies exactly in the one
// above it, on any lattice.
//
// If the nearest part of the model changes, as in the middle of a valley, a slice may be smaller
// than the true one by up to a side of the lattice.
class WaterlineSlices {
public:
    WaterlineSlices(const part_model::PartModel& model,
                    const toolpath::Tool& tool,
                    const SliceSettings& settings);

    // The region of the axis with the tip at height z, at least `clearance` + `extra` (mm >= 0) off
    // the model. A slice of greater `extra` lies in one of less.
    offset::Region2d at(double z, double extra) const;

    // mm: how much too low the distances may be; contours keep so much more.
    double max_excess() const;

    double pitch() const { return std::max(pitch_x_, pitch_y_); }

private:
    struct Levels;
    struct Block;
    void fill(Levels& levels) const;
    void fill_block(const Block& whole, Levels& levels) const;
    bool buried(Vec2d middle, double reach, const Levels& levels) const;
    Vec2d node(std::size_t i, std::size_t j) const;

    const part_model::PartModel& model_;
    toolpath::Tool tool_;
    SliceSettings settings_;
    std::size_t nx_{};
    std::size_t ny_{};
    double pitch_x_{};
    double pitch_y_{};
};

}  // namespace cusp::waterline_slices
