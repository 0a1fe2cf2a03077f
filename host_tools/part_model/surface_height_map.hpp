// Heights of surfaces over single places, seen from above.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_model/trim_region.hpp"

namespace cusp::part_model {

// Roots of the surfaces' equations (Newton) from a net of samples: each surface is walked in small
// pieces, and the pieces that may lie over a place are asked. Upright surfaces have no height.
//
// Accuracy: 1e-7 mm in x and y. What a piece hides from its nine samples (folds narrower than a
// 100th of the surfaces' box) may be missed.
class SurfaceHeightMap {
public:
    // edge_error  mm: of trims, as `TrimRegion` takes it
    SurfaceHeightMap(const std::vector<nurbs::Surface>& surfaces, double edge_error);

    // The highest; none beside the surfaces.
    std::optional<double> at(double x, double y) const;

private:
    struct Sample {
        double u;
        double v;
        Vec3d point;
        bool leans_little;  // far enough from upright to start from
    };
    struct Piece {
        std::size_t patch;
        Vec2d low;
        Vec2d high;
        std::array<Sample, 9> samples;
        bool folds;  // seen from both sides, or upright somewhere
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
