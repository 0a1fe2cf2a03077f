// Writes the runs of an adaptive path at a height: entries, links at depth, lifts and cuts.
#pragma once

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/cam/adaptive_clearing/standing_slivers.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

namespace cusp::adaptive_clearing {

class AdaptivePathWriter {
public:
    struct Settings {
        bool arcs;               // as arcs; else as chords
        double chord_tolerance;  // mm, > 0
        bool plunges;            // entries go straight down
        double scallops{};       // mm: of the stock left between passes by a round end
    };

    // writer  outlives this
    AdaptivePathWriter(toolpath::ToolpathWriter& writer, const Settings& settings)
        : writer_{writer}, settings_{settings}
    {
    }

    // Levels are written from the top down. Entries begin over what slivers of those before are left.
    //
    // above  z: stock begins there at most, but for these
    void write(const AdaptivePath& path, double above, double z);

    int entries() const { return entries_; }
    int plunges() const { return plunges_; }
    int points() const { return points_; }

private:
    toolpath::ToolpathWriter& writer_;
    Settings settings_;
    int entries_{0};
    int plunges_{0};
    int points_{0};
    StandingSlivers slivers_{};

    double top_at(Vec2d place, double above) const;
    void enter(const EntryHelix& helix, double above, double z);
    void link(const std::vector<LinkLeg>& legs, double z);
    void cut(const offset::Edge& edge, double z, double tolerance);
};

}  // namespace cusp::adaptive_clearing
