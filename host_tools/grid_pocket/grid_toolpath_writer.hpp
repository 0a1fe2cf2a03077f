// Ways in and out of the pocket: lifts, and ramps along the run that follows.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/grid_pocket/cl_path_fitter.hpp"

namespace cusp::grid_pocket {

// Rapids happen at the clearance height or straight down to 1 mm above metal.
class GridToolpathWriter {
public:
    // most_drop  mm: of a ramp's trip out and back, or of a helix's turn
    GridToolpathWriter(toolpath::Toolpath& path,
                       double clearance_z,
                       job::EntryKind entry,
                       double radius,
                       double most_drop)
        : tip_{path},
          clearance_z_{clearance_z},
          entry_{entry},
          radius_{radius},
          most_drop_{most_drop}
    {
    }

    // Where there is room for a helix: the least z of its tip all around, for a circle in plan;
    // none where it meets a wall.
    using CircleFloor = std::function<std::optional<double>(Vec2d centre, double radius)>;

    // To the start of a run over the floor, at its height there; `stock_top` is the z below which
    // metal may stand. The ramp goes out and back along the run, higher than the run all the way.
    // With `link` the start is reached without a lift to the clearance height, 1 mm above
    // `stock_top`.
    void enter(const ClPathFitter& floor,
               const std::vector<Vec2d>& corners,
               double stock_top,
               bool link,
               const CircleFloor& circle);

    // The same from where the tip stands at the start of the run, over `stock_top` or higher.
    void descend(const ClPathFitter& floor,
                 const std::vector<Vec2d>& corners,
                 double stock_top,
                 const CircleFloor& circle);

    void retract();

    GridMoveWriter& tip() { return tip_; }
    Vec3d tip_at() const { return tip_.at(); }
    bool is_retracted() const { return tip_.at().z >= clearance_z_; }
    int retracts() const { return retracts_; }
    int plunges() const { return plunges_; }
    int helices() const { return helices_; }
    // Entries that asked for a helix where none has room.
    int narrow_entries() const { return narrow_entries_; }
    double ramp_length() const { return 4 * radius_; }

private:
    GridMoveWriter tip_;
    double clearance_z_;
    job::EntryKind entry_;
    double radius_;
    double most_drop_;
    int retracts_{0};
    int plunges_{0};
    int helices_{0};
    int narrow_entries_{0};

    void go_down(const std::vector<Vec3d>& way, double stock_top, const CircleFloor& circle);
    bool helix(Vec3d start, double from, const CircleFloor& circle);
    void ramp(const std::vector<Vec3d>& way, double from);
};

}  // namespace cusp::grid_pocket
