// The offset of a model cut by a horizontal plane: where a tool's axis may stand with its tip at
// that height, as contours that are proved to keep their distance.
#pragma once

#include <algorithm>

#include "host_tools/offset/contour.hpp"
#include "host_tools/part_model/part_model.hpp"

namespace cusp::adaptive_isocurve {

struct SliceSettings {
    double clearance{};    // mm >= 0: least distance of the tool from the model
    double excess{};       // mm > 0: what the contours may keep more than that, on smooth walls
    double least_pitch{};  // mm > 0: no finer lattice, whatever `excess` asks for
    offset::Box2d field;   // where the axis may stand at all
};

// Slices on one lattice of triangles, by the distance of the tool from the model at its nodes.
//
// Proof: let D be the distance of the model from the tool's core (the tool less its corner radius
// all round, which only shifts as the tool goes in the plane). D^2 - |x|^2 is the least of
// functions that are linear in x, hence concave: between the corners of a triangle D^2 is at least
// its linear interpolation less a quarter of the squared longest side. Contours are the linear
// interpolation's, so much higher; there is nothing to check afterwards. And because D grows with
// the height, a slice lies in the one above it, exactly, whatever the lattice.
//
// What this loses lies across places where the nearest part of the model changes (the middle of a
// valley): at most a side of the lattice.
class WaterlineSlices {
public:
    WaterlineSlices(const part_model::PartModel& model,
                    const toolpath::Tool& tool,
                    const SliceSettings& settings);

    // The places whose axis keeps `clearance` + `more` (mm >= 0; slices of greater `more` lie in
    // those of less) with the tip at height z.
    offset::Region2d at(double z, double more) const;

    // How far below the truth the distances are at most, mm: contours keep so much more.
    double max_excess() const;

    double pitch() const { return std::max(pitch_x_, pitch_y_); }

private:
    struct Levels;
    void fill(Levels& levels) const;
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

}  // namespace cusp::adaptive_isocurve
