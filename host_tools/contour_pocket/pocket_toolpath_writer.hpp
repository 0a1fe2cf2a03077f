// Writes the moves of one tool through a pocket: entries into metal, links, cuts and retracts.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/contour_pocket/cl_path.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::contour_pocket {

// Over the start of a pass: where rapid moves end and where metal may begin, z in mm.
struct EntryHeights {
    double rapid;
    double stock_top;

    void raise_over(const EntryHeights& other);
};

// Over metal that stands up to z, mm.
EntryHeights heights_over(double stock_top);

// Of ramps and helices: 4.6 degrees.
inline constexpr double kEntrySlope = 0.08;

toolpath::ToolMove tool_move(toolpath::MoveKind kind, const ClMove& move);

class PocketToolpathWriter {
public:
    // clearance: z at which rapid moves run, mm.
    explicit PocketToolpathWriter(double clearance) : clearance_{clearance} {}

    // Down to the start of a pass of straight moves: round it again and again on a gentle slope
    // until it lies wholly at its depth, to and fro along the beginning of an open one or where
    // that is shorter; straight down where `plunge`. From where the tool stands, where it
    // stands over the start.
    void enter_along(const ClPath& path, const EntryHeights& heights, bool plunge);

    Vec3d place() const { return at_; }

    // Whether the tool stands somewhere below the clearance, and how far.
    bool is_down() const { return below_clearance() > 0.0; }
    double below_clearance() const { return moves_.empty() ? 0.0 : clearance_ - at_.z; }

    // Whether the tool stands straight over the place, on it or under it, below the clearance.
    bool is_over(Vec3d place) const;

    // Down on a helix about the start of a pass, to somewhere over it; to the start itself where
    // that is little lower, or `whole`. lowest(at) is the lowest the tip may stand there, gap(a, b)
    // the room of a straight move, negative where it would cut too deep. Returns the height it
    // ends at.
    double enter_by_helix(Vec3d centre,
                          double radius,
                          bool whole,
                          const EntryHeights& heights,
                          const std::function<double(Vec2d)>& lowest,
                          const std::function<double(Vec3d, Vec3d)>& clearance);

    void cut(const ClPath& pass) { follow(toolpath::MoveKind::kCut, pass); }
    void link(const ClPath& path) { follow(toolpath::MoveKind::kLink, path); }
    void retract();

    const std::vector<toolpath::ToolMove>& moves() const { return moves_; }
    std::vector<toolpath::ToolMove> take() { return std::move(moves_); }
    int retracts() const { return retracts_; }
    int points() const { return points_; }
    // Entries that had no room for a slope and went down by more than a helix leaves.
    int steep_plunges() const { return steep_plunges_; }

private:
    void line(toolpath::MoveKind kind, Vec3d end);
    void approach(Vec2d at, const EntryHeights& heights);
    void plunge_over(Vec3d end, const std::function<double(Vec3d, Vec3d)>& clearance);
    void follow(toolpath::MoveKind kind, const ClPath& path);

    double clearance_;
    std::vector<toolpath::ToolMove> moves_;
    Vec3d at_{};
    int retracts_{};
    int points_{};
    int steep_plunges_{};
};

}  // namespace cusp::contour_pocket
