// Writes the moves of all layers: each cutter clears its layers and the rest of earlier cutters.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "host_tools/cam/adaptive_clearing/adaptive_path_writer.hpp"
#include "host_tools/cam/adaptive_clearing/engagement_report.hpp"
#include "host_tools/cam/clearing/layer_toolpath_writer.hpp"
#include "host_tools/cam/clearing/rest_between_tools.hpp"
#include "host_tools/cam/hull_rough/roughing.hpp"

namespace cusp::hull_rough {

using adaptive_clearing::AdaptivePath;
using adaptive_clearing::AdaptivePathWriter;
using adaptive_clearing::EngagementReport;
using clearing::LayerRun;
using clearing::LayerSpace;
using clearing::LayerToolpathWriter;
using clearing::leaves_no_rest;
using clearing::rest_offset_between_tools;
using job::EntryKind;
using job::OutputForm;
using toolpath::PlannedOperation;
using toolpath::Tool;
using toolpath::Toolpath;
using toolpath::ToolpathWriter;

namespace {

// The cutters that have cleared each layer so far, in order. The first leaves scallops; the others
// leave rest_height() in addition.
using Cutters = std::vector<std::vector<std::size_t>>;

double clearance_height(const Roughing& work)
{
    return std::max(work.stock.top, work.job.stock_top) + work.job.clearance;
}

double chord_tolerance(const Roughing& work)
{
    return std::max(work.operation.tolerance.plan, kLeastTolerance) / 2;
}

// Writes the moves of one cutter, layer by layer.
class LayersOfCutter {
public:
    LayersOfCutter(const Roughing& work, std::size_t tool) : work_{work}, tool_{tool}
    {
        set_tool(path_, work.job, work.tools[tool]);
    }
    LayersOfCutter(const LayersOfCutter&) = delete;
    LayersOfCutter& operator=(const LayersOfCutter&) = delete;
    virtual ~LayersOfCutter() = default;

    virtual void clear(std::size_t layer) = 0;
    // Only what the cutters before have left, so that this one can cut below.
    virtual void clear_uncut(std::size_t layer, const std::vector<ClearedBy>& before) = 0;
    virtual PlannedOperation finish() = 0;

protected:
    const Roughing& work_;
    std::size_t tool_;
    Toolpath path_;
};

// Runs of the zigzag or of loops.
class RunWriter final : public LayersOfCutter {
public:
    RunWriter(const Roughing& work, std::size_t first, std::size_t tool)
        : LayersOfCutter{work, tool},
          moves_{path_,
                 work.clearings[first][tool].zone->radius(),
                 {clearance_height(work), work.operation.passes.entry,
                  work.operation.output == OutputForm::kArcs, chord_tolerance(work)}}
    {
    }

    void clear(std::size_t layer) override { add(work_.clearings[layer][tool_].runs, layer); }

    void clear_uncut(std::size_t layer, const std::vector<ClearedBy>& before) override
    {
        add(uncut_runs(work_.clearings[layer][tool_], work_.tools[tool_].radius, before), layer);
    }

    PlannedOperation finish() override
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
    LayerToolpathWriter moves_;
    int passes_{0};

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

// Passes of bounded engagement.
class AdaptiveLayerWriter final : public LayersOfCutter {
public:
    AdaptiveLayerWriter(const Roughing& work, std::size_t tool)
        : LayersOfCutter{work, tool},
          writer_{path_.moves,
                  {clearance_height(work), work.operation.passes.entry, work.tools[tool].radius}},
          cutter_{writer_,
                  {work.operation.output == OutputForm::kArcs, chord_tolerance(work),
                   work.operation.passes.entry == EntryKind::kPlunge, scallops(work)}},
          report_{*work.operation.passes.max_engagement}
    {
    }

    void clear(std::size_t layer) override
    {
        write(*work_.clearings[layer][tool_].adaptive, layer);
    }

    void clear_uncut(std::size_t layer, const std::vector<ClearedBy>& before) override
    {
        const Tool& tool = work_.tools[tool_];
        write(adaptive_layer(work_.clearings[layer][tool_], work_.stock.plan, tool.radius,
                             layer_settings(work_, layer, tool), before),
              layer);
    }

    PlannedOperation finish() override
    {
        writer_.retract();
        PlannedOperation out;
        out.path = std::move(path_);
        out.stats.passes = passes_;
        out.stats.retracts = writer_.retracts();
        out.stats.cl_points = static_cast<int>(out.path.moves.size());
        out.stats.counts = {{"entries", static_cast<double>(cutter_.entries())},
                            {"lifts", static_cast<double>(writer_.retracts())}};
        report_.write(out.stats);
        if (cutter_.plunges() > 0) {
            out.stats.warnings.push_back(std::to_string(cutter_.plunges()) +
                                         " entries had no room for a helix and plunge");
        }
        return out;
    }

private:
    ToolpathWriter writer_;
    AdaptivePathWriter cutter_;
    EngagementReport report_;
    int passes_{0};

    // mm: the most of any layer.
    static double scallops(const Roughing& work)
    {
        double most = 0;
        for (std::size_t layer = 0; layer < work.layers(); ++layer) {
            most = std::max(most, work.left_over(layer));
        }
        return most;
    }

    void write(const AdaptivePath& path, std::size_t layer)
    {
        cutter_.write(path, work_.top(layer) + (layer > 0 ? work_.left_over(layer - 1) : 0.0),
                      work_.bottom(layer));
        report_.add(path, 1, work_.bottom(layer));
        passes_ += static_cast<int>(path.runs.size());
    }
};

std::unique_ptr<LayersOfCutter> writer_of(const Roughing& work, std::size_t first, std::size_t tool)
{
    if (work.operation.passes.max_engagement) {
        return std::make_unique<AdaptiveLayerWriter>(work, tool);
    }
    return std::make_unique<RunWriter>(work, first, tool);
}

// The cutters that have cleared a layer before this one, if they left a rest for it.
std::optional<std::vector<ClearedBy>> leavers(const Roughing& work,
                                              std::size_t layer,
                                              std::size_t tool,
                                              const std::vector<std::size_t>& before)
{
    std::vector<ClearedBy> cleared;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Tool& other = work.tools[before[i]];
        const double scallop_height = i == 0 ? work.rest_height(layer) : 0.0;
        if (before[i] == tool || leaves_no_rest(other, work.tools[tool], scallop_height)) {
            return std::nullopt;
        }
        if (const auto nested =
                rest_offset_between_tools(other, work.tools[tool], scallop_height)) {
            cleared.push_back({&work.clearings[layer][before[i]], *nested});
        }
    }
    return cleared;
}

}  // namespace

std::vector<PlannedOperation> write_layers(const Roughing& work)
{
    std::vector<PlannedOperation> out;
    const auto& of_layer = work.choice.of_layer;
    Cutters cutters(work.layers());
    for (std::size_t first = 0; first < work.layers();) {
        const std::size_t tool = of_layer[first];
        const std::unique_ptr<LayersOfCutter> writer = writer_of(work, first, tool);
        for (std::size_t layer = 0; layer < first; ++layer) {
            if (const auto before = leavers(work, layer, tool, cutters[layer])) {
                writer->clear_uncut(layer, *before);
                cutters[layer].push_back(tool);
            }
        }
        std::size_t last = first;
        for (; last < work.layers() && of_layer[last] == tool; ++last) {
            writer->clear(last);
            cutters[last].push_back(tool);
        }
        out.push_back(writer->finish());
        out.back().stats.levels = static_cast<int>(last - first);
        first = last;
    }
    return out;
}

}  // namespace cusp::hull_rough
