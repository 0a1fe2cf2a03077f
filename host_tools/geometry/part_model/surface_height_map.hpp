// The height of surfaces over a point in plan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::part_model {

// Each surface is divided into small pieces with nine samples. A query solves the equations of the
// pieces that may lie over the point by Newton's method, from a sample. Vertical surfaces have no
// height.
//
// Accuracy: 1e-7 mm in x and y. Folds that the samples do not show (narrower than a 100th of the
// surfaces' box) may be missed.
class SurfaceHeightMap {
public:
    // edge_error  mm: of trims, as `TrimRegion` takes it
    SurfaceHeightMap(const std::vector<nurbs::Surface>& surfaces, double edge_error);

    // The highest point at (x, y): its z, mm; none beside the surfaces.
    std::optional<double> at(double x, double y) const;

private:
    struct Sample {
        double u;
        double v;
        Vec3d point;
        bool can_start;  // not too steep to start Newton's method
    };
    struct Piece {
        std::size_t patch;
        Vec2d low;
        Vec2d high;
        std::array<Sample, 9> samples;
        bool folds;  // its samples face up and down, or are too steep
    };
    struct Patch {
        std::size_t surface;
        nurbs::Surface bezier;
    };

    void add_pieces(std::size_t patch, double width);
    void make_bins();
    std::size_t column(double x) const;
    std::size_t row(double y) const;
    void raise(const Piece& piece, const Sample& from, double x, double y, double& height) const;

    std::vector<TrimRegion> regions_;  // of the surfaces
    std::vector<Patch> patches_;
    std::vector<Piece> pieces_;
    Vec2d low_;
    Vec2d high_;
    // Pieces over each square of the plan, column by column.
    std::vector<std::vector<std::uint32_t>> bins_;
};

}  // namespace cusp::part_model
