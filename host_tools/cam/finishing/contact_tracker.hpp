// A tool dropped at neighbouring points. Over surfaces it is a ball: its contact is tracked and proved to
// be the only one. If that fails, and over a mesh, the whole model is searched.
#pragma once

#include <optional>

#include "host_tools/cam/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// Not for use by two threads at once.
class ContactTracker {
public:
    explicit ContactTracker(const GougeFreePathFitter& path_fitter) : path_fitter_{path_fitter} {}

    struct Position {
        Vec3d tip;
        CcParameters contact;
        // Cosine of the angle between the normal at the contact and the direction into the tool: less
        // than 1 on a rim or a crease, 0 on a trimmed edge.
        double facing{1};
        Vec3d point{};  // of the model, where it touches
        Vec3d lean{};   // unit, from there into the tool
    };

    // The tool of `GougeFreePathFitter::drop`, with its contact where it touches one smooth point
    // only. Quickest near the last point.
    std::optional<Position> at(double x, double y);

private:
    std::optional<Position> beside(double x, double y);

    const GougeFreePathFitter& path_fitter_;
    CcParameters last_;
};

}  // namespace cusp::finishing
