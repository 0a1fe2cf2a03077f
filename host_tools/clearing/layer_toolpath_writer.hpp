// Moves of the cutter through one layer: the way in, along, over to the next run, and out.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/job/job.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::clearing {

// A run of the cutter on one level; it begins where the axis stands at edges.front().start.
struct LayerRun {
    std::vector<offset::Edge> edges;
    bool starts_in_cleared_stock{false};  // this layer is already cleared where the run starts
};

// One layer and what its moves ask of it; places are of the cutter's axis, in plan.
struct LayerSpace {
    double top{};  // z: no metal stands higher where the layer above was cleared
    double bottom{};
    double radius{};  // of the cutter, with what it keeps from the part
    // Whether the axis may stand, at `bottom`, everywhere within `extra` mm of the place.
    std::function<bool(Vec2d place, double extra)> has_room;
    // Whether all of the straight way was cleared down to `top`; empty where nothing was yet.
    std::function<bool(Vec2d from, Vec2d to)> cleared_above;
    // Whether the cutter stands beside the stock there.
    std::function<bool(Vec2d place)> beside_stock;
    // mm that ridges may stand over what counts as cleared, at `top` and at `bottom`.
    double scallop_height{};
};

// Writes runs to a tool path. Rapid moves happen at the clearance height or straight down to 1 mm
// above metal that is cut; links below it cross only what the layer above has cleared.
class LayerToolpathWriter {
public:
    struct Settings {
        double clearance_z{};
        job::EntryKind entry{};
        bool arcs{};               // write arcs as arcs; else as chords
        double chord_tolerance{};  // mm, > 0
    };

    LayerToolpathWriter(toolpath::Toolpath& path, Settings settings)
        : path_{path}, settings_{settings}
    {
    }

    void add(const LayerRun& run, const LayerSpace& layer);
    void retract();

    int retracts() const { return retracts_; }
    int steep_plunges() const { return steep_plunges_; }
    Vec2d place() const { return {at_.x, at_.y}; }
    bool started() const { return started_; }

private:
    toolpath::Toolpath& path_;
    Settings settings_;
    Vec3d at_{};
    bool started_{false};
    int retracts_{0};
    int steep_plunges_{0};

    void line(toolpath::MoveKind kind, Vec3d end);
    void cut(const offset::Edge& edge, double z);
    bool link(Vec2d start, const LayerSpace& layer);
    void enter(const LayerRun& run, const LayerSpace& layer);
    bool helix(Vec2d start, const LayerSpace& layer);
    void ramp(const std::vector<Vec2d>& way, double length, double from, double bottom);
};

}  // namespace cusp::clearing
