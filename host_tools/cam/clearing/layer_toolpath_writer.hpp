// Moves of the cutter through one layer: entry, cut, link to the next run, and retract.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::clearing {

// A run of the cutter at one height; it begins with the axis at edges.front().start.
struct LayerRun {
    std::vector<offset::Edge> edges;
    bool starts_in_cleared_stock{false};  // this layer is already cleared where the run starts
};

// One layer, with the queries that its moves need; places are of the cutter's axis, in plan.
struct LayerSpace {
    double top{};  // z: limit of the stock's height where the layer above was cleared
    double bottom{};
    double radius{};  // of the cutter, with its clearance from the part
    // True if the axis may be, at `bottom`, everywhere within `extra` mm of the place.
    std::function<bool(Vec2d place, double extra)> has_room;
    // True if all of the straight line was cleared down to `top`; empty if nothing is cleared yet.
    std::function<bool(Vec2d from, Vec2d to)> cleared_above;
    // True if the cutter is beside the stock there.
    std::function<bool(Vec2d place)> beside_stock;
    // mm: scallops above cleared planes, at `top` and at `bottom`.
    double scallop_height{};
};

// Writes runs to a tool path. Rapid moves are at the clearance height or straight down to 1 mm
// above cut stock; links below it cross only stock cleared by the layer above.
class LayerToolpathWriter {
public:
    struct Settings {
        double clearance_z{};
        job::EntryKind entry{};
        bool arcs{};               // write arcs as arcs; else as chords
        double chord_tolerance{};  // mm, > 0
    };

    // tool_radius  mm: with the tool's clearance from the part
    LayerToolpathWriter(toolpath::Toolpath& path, double tool_radius, Settings settings)
        : writer_{path.moves, {settings.clearance_z, settings.entry, tool_radius}},
          settings_{settings}
    {
    }

    void add(const LayerRun& run, const LayerSpace& layer);
    void retract() { writer_.retract(); }

    int retracts() const { return writer_.retracts(); }
    int steep_plunges() const { return writer_.steep_plunges(); }
    Vec2d place() const { return in_plan(writer_.at()); }
    bool started() const { return writer_.started(); }

private:
    toolpath::ToolpathWriter writer_;
    Settings settings_;

    void cut(const offset::Edge& edge, double z);
    bool link(Vec2d start, const LayerSpace& layer);
    void enter(const LayerRun& run, const LayerSpace& layer);
};

}  // namespace cusp::clearing
