// Writes the moves of all layers: each cutter clears its layers and the rest of earlier cutters.
#include <algorithm>
#include <utility>

#include "host_tools/clearing/layer_toolpath_writer.hpp"
#include "host_tools/clearing/rest_between_tools.hpp"
#include "host_tools/hull_rough/roughing.hpp"

namespace cusp::hull_rough {

using clearing::LayerRun;
using clearing::LayerSpace;
using clearing::LayerToolpathWriter;
using clearing::leaves_no_rest;
using clearing::rest_offset_between_tools;
using job::OutputForm;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::Toolpath;

namespace {

// The cutters that have cleared each layer so far, in order. The first leaves scallops; the others
// leave rest_height() in addition.
using Cutters = std::vector<std::vector<std::size_t>>;

// Writes layers of one cutter from the first on, after what other cutters have cleared.
class GroupWriter {
public:
    GroupWriter(const Roughing& work, std::size_t first, std::size_t tool)
        : work_{work},
          tool_{tool},
          moves_{path_, work.clearings[first][tool].zone->radius(), settings(work)}
    {
        set_tool(path_, work.job, work.tools[tool]);
    }

    void clear(std::size_t layer) { add(work_.clearings[layer][tool_].runs, layer); }

    // Clears the rest of a layer that earlier cutters have left, so that this one can cut below;
    // false where they left nothing.
    bool clear_uncut(std::size_t layer, const std::vector<std::size_t>& before)
    {
        const Tool& tool = work_.tools[tool_];
        std::vector<ClearedBy> cleared;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const Tool& other = work_.tools[before[i]];
            const double scallop_height = i == 0 ? work_.rest_height(layer) : 0.0;
            if (before[i] == tool_ || leaves_no_rest(other, tool, scallop_height)) {
                return false;
            }
            if (const auto nested = rest_offset_between_tools(other, tool, scallop_height)) {
                cleared.push_back({&work_.clearings[layer][before[i]], *nested});
            }
        }
        add(uncut_runs(work_.clearings[layer][tool_], tool.radius, cleared), layer);
        return true;
    }

    PlannedOperation finish()
    {
        moves_.retract();
        PlannedOperation out;
        out.path = std::move(path_);
        out.stats.passes = passes_;
        out.stats.retracts = moves_.retracts();
        out.stats.cl_points = static_cast<int>(out.path.moves.size());
        if (moves_.steep_plunges() > 0) {
            out.stats.warnings.push_back(std::to_string(moves_.steep_plunges()) +
                                         " entries had no room for a ramp and plunge");
        }
        return out;
    }

private:
    const Roughing& work_;
    std::size_t tool_;
    Toolpath path_;
    LayerToolpathWriter moves_;
    int passes_{0};

    static LayerToolpathWriter::Settings settings(const Roughing& work)
    {
        return {std::max(work.stock.top, work.job.stock_top) + work.job.clearance,
                work.operation.entry, work.operation.output == OutputForm::kArcs,
                std::max(work.operation.plan_tolerance, kLeastTolerance) / 2};
    }

    void add(const std::vector<LayerRun>& runs, std::size_t layer)
    {
        const ClearZone& zone = *work_.clearings[layer][tool_].zone;
        LayerSpace space{work_.top(layer), work_.bottom(layer), zone.radius(), {}, {}, {}};
        space.has_room = [&zone](Vec2d place, double extra) {
            return zone.room(place, extra);
        };
        space.beside_stock = [&](Vec2d place) {
            return distance(place, place, work_.stock.plan) >= zone.radius();
        };
        if (layer > 0) {
            space.cleared_above = [&](Vec2d from, Vec2d to) {
                return work_.clearings[layer - 1][tool_].zone->clear(from, to);
            };
        }
        space.scallop_height =
            std::max(work_.left_over(layer), layer > 0 ? work_.left_over(layer - 1) : 0);
        for (const LayerRun& run : runs) {
            moves_.add(run, space);
            ++passes_;
        }
    }
};

}  // namespace

std::vector<PlannedOperation> write_layers(const Roughing& work)
{
    std::vector<PlannedOperation> out;
    const auto& of_layer = work.choice.of_layer;
    Cutters cutters(work.layers());
    for (std::size_t first = 0; first < work.layers();) {
        const std::size_t tool = of_layer[first];
        GroupWriter writer{work, first, tool};
        for (std::size_t layer = 0; layer < first; ++layer) {
            if (writer.clear_uncut(layer, cutters[layer])) {
                cutters[layer].push_back(tool);
            }
        }
        std::size_t last = first;
        for (; last < work.layers() && of_layer[last] == tool; ++last) {
            writer.clear(last);
            cutters[last].push_back(tool);
        }
        out.push_back(writer.finish());
        out.back().stats.levels = static_cast<int>(last - first);
        first = last;
    }
    return out;
}

}  // namespace cusp::hull_rough
