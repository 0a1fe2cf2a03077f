// Moves of the cutter through one layer: the way in, along, over to the next run, and out.
#pragma once

#include <vector>

#include "host_tools/hull_rough/zigzag.hpp"
#include "host_tools/import/job.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::host {

// A run of the cutter on one level; it begins where the axis stands at edges.front().start.
struct LevelRun {
    std::vector<Edge> edges;
    bool starts_in_cut_metal{false};  // this layer is already cleared where the run starts
};

// One layer with where the axis may stand in it and, at its top, where the layer above was cleared.
struct LayerSpace {
    double top{};
    double bottom{};
    const ClearZone* zone{};
    const ClearZone* zone_above{};  // none: nothing stands above `top`
    Rectangle stock;
};

// Writes runs to a tool path. Rapid moves happen at the clearance height or straight down to 1 mm
// above metal that is cut; links below it cross only what the layer above has cleared.
class RoughMoves {
public:
    struct Settings {
        double clearance_z{};
        EntryKind entry{};
        bool arcs{};               // write arcs as arcs; else as chords
        double chord_tolerance{};  // mm, > 0
    };

    RoughMoves(Toolpath& path, Settings settings) : path_{path}, settings_{settings} {}

    void add(const LevelRun& run, const LayerSpace& layer);
    void retract();

    int retracts() const { return retracts_; }
    int steep_plunges() const { return steep_plunges_; }
    Vec2d place() const { return {at_.x, at_.y}; }
    bool started() const { return started_; }

private:
    Toolpath& path_;
    Settings settings_;
    Vec3d at_{};
    bool started_{false};
    int retracts_{0};
    int steep_plunges_{0};

    void line(MoveKind kind, Vec3d end);
    void cut(const Edge& edge, double z);
    bool link(Vec2d start, const LayerSpace& layer);
    void enter(const LevelRun& run, const LayerSpace& layer);
    bool helix(Vec2d start, const LayerSpace& layer);
    void ramp(const std::vector<Vec2d>& way, double length, double from, double bottom);
};

}  // namespace cusp::host
