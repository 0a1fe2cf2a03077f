// PartInfo as lines for a terminal.
#include <cmath>

#include "firmware/base/inch.hpp"
#include "host_tools/job/part_info/feature_lines.hpp"
#include "host_tools/job/part_info/part_info.hpp"

#include "fmt/format.h"

namespace cusp::part_info {

using job::ClosedLoop;
using job::LoopNesting;
using job::OpenChain;
using job::PartLayer;

namespace {

constexpr std::size_t kMostListed = 40;  // loops or chains of a layer

std::string place(Vec3d p)
{
    return fmt::format("at x {} y {} z {} mm", number(p.x, 3), number(p.y, 3), number(p.z, 3));
}

std::string place(Vec2d p) { return fmt::format("x {} y {} mm", number(p.x), number(p.y)); }

std::string count(std::size_t n, const char* one, const char* many)
{
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

class Lines {
public:
    explicit Lines(const std::string& title) : text_{title + "\n"} {}
    void add(const char* label, const std::string& value)
    {
        text_ += fmt::format("  {:<14} {}\n", label, value);
    }
    std::string text() && { return std::move(text_); }

private:
    std::string text_;
};

std::string unit_text(const job::PartUnit& unit)
{
    if (unit.assumed) {
        return unit.name + fmt::format(", assumed: the file names none (--units {} for the other)",
                                       unit.millimetres == 1 ? "inch" : "mm");
    }
    const std::string name = unit.name.empty() ? "unknown" : unit.name;
    return name + (unit.millimetres == 0 ? ", as the file says; read in mm" : ", as the file says");
}

void add_box(const PartInfo& info, Lines& lines)
{
    const auto sizes = [&](double unit, const char* name) {
        const Vec3d size = info.part.box_high - info.part.box_low;
        return fmt::format("{} x {} x {} {}", number(size.x / unit), number(size.y / unit),
                           number(size.z / unit), name);
    };
    lines.add("box", fmt::format("x {} to {} mm, y {} to {} mm, z {} to {} mm",
                                 number(info.part.box_low.x), number(info.part.box_high.x),
                                 number(info.part.box_low.y), number(info.part.box_high.y),
                                 number(info.part.box_low.z), number(info.part.box_high.z)));
    std::string size = sizes(1, "mm");
    std::string name = info.part.unit.name;
    for (char& c : name) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    if (name.rfind("in", 0) == 0) {
        size += " = " + sizes(kMillimetresPerInch, "inch");
    }
    lines.add("size", size);
}

void add_loops(const LoopNesting& nesting, Lines& lines)
{
    for (std::size_t k = 0; k < nesting.loops.size() && k < kMostListed; ++k) {
        const ClosedLoop& loop = nesting.loops[k];
        std::string text(static_cast<std::size_t>(2 * loop.depth), ' ');
        text += fmt::format("{} {}: length {} mm, area {} mm2, {}, {}",
                            loop.depth % 2 == 0 ? "loop" : "hole", k + 1, number(loop.length),
                            number(loop.area), loop.counter_clockwise ? "ccw" : "cw",
                            count(loop.curves.size(), "curve", "curves"));
        text += loop.parent < 0 ? "" : fmt::format(", in {}", loop.parent + 1);
        if (loop.crossing) {
            text += ", crosses itself at " + place(*loop.crossing);
        }
        lines.add("", text);
    }
    if (nesting.loops.size() > kMostListed) {
        lines.add("", fmt::format("... and {} more (--stats lists all)",
                                  nesting.loops.size() - kMostListed));
    }
    for (std::size_t k = 0; k < nesting.open.size() && k < kMostListed; ++k) {
        const OpenChain& chain = nesting.open[k];
        lines.add("", fmt::format("open {}: length {} mm, {}, from {} to {}", k + 1,
                                  number(chain.length), count(chain.curves, "curve", "curves"),
                                  place(chain.begin), place(chain.end)));
        lines.add("", fmt::format("        gap {} mm, from {} to {}", number(chain.gap),
                                  place(chain.gap_from), place(chain.gap_to)));
    }
    if (nesting.open.size() > kMostListed) {
        lines.add("", fmt::format("... and {} more (--stats lists all)",
                                  nesting.open.size() - kMostListed));
    }
}

void add_layer(const PartLayer& layer, Lines& lines)
{
    const LoopNesting& nesting = layer.loops;
    std::string text = count(nesting.curves, "curve", "curves");
    text += ", " + count(nesting.loops.size(), "closed loop", "closed loops");
    text += ", " + count(nesting.open.size(), "open chain", "open chains");
    if (!layer.name.empty()) {
        text = fmt::format("\"{}\"{}: {}", layer.name, layer.hidden ? " (hidden)" : "", text);
    }
    lines.add(layer.name.empty() ? "loops" : "layer", text);
    if (!layer.problem.empty()) {
        lines.add("", "can't be read: " + layer.problem);
    }
    if (nesting.repeated > 0) {
        lines.add("", count(nesting.repeated, "curve", "curves") + " drawn twice, left out");
    }
    if (nesting.bridged > 0) {
        lines.add("", fmt::format("{} of up to {} mm joined", count(nesting.bridged, "gap", "gaps"),
                                  number(nesting.widest_gap)));
    }
    if (nesting.crossing) {
        lines.add("", "loops cross each other at " + place(*nesting.crossing));
    }
    add_loops(nesting, lines);
}

void add_mesh(const PartInfo& info, Lines& lines)
{
    const MeshHealth& mesh = *info.mesh;
    lines.add("facets",
              fmt::format("{} in {}", info.pieces, count(mesh.shells, "shell", "shells")));
    if (info.part.degenerate > 0) {
        lines.add("", count(info.part.degenerate, "facet", "facets") + " without area, left out");
    }
    if (mesh.open_edges > 0) {
        lines.add("holes", fmt::format("{} of {}, one {}", count(mesh.holes, "border", "borders"),
                                       count(mesh.open_edges, "open edge", "open edges"),
                                       place(*mesh.hole_at)));
    } else {
        lines.add("holes", "none");
    }
    const std::vector<job::OpenHole>& above = info.part.holes_above;
    for (std::size_t k = 0; k < above.size() && k < kMostListed; ++k) {
        const job::OpenHole& hole = above[k];
        lines.add("", fmt::format("open above, {} x {} mm {}: plan closes it", number(hole.size.x),
                                  number(hole.size.y), place(hole.middle)));
    }
    if (above.size() > kMostListed) {
        lines.add("", fmt::format("and {} more open above", above.size() - kMostListed));
    }
    if (mesh.non_manifold_edges > 0) {
        lines.add("faults", count(mesh.non_manifold_edges, "edge", "edges") +
                                " with more than two facets, one " + place(*mesh.non_manifold_at));
    }
    if (mesh.inverted_facets > 0) {
        lines.add("faults", count(mesh.inverted_facets, "facet", "facets") +
                                " oriented against their neighbours");
    }
    if (mesh.inside_out_shells > 0) {
        lines.add("faults", count(mesh.inside_out_shells, "closed shell", "closed shells") +
                                " inside out, or a hollow space");
    }
}

std::string area_and_share(double part, double whole)
{
    return fmt::format("{} mm2, {} % of the area", number(part, 2),
                       number(whole > 0 ? 100 * part / whole : 0, 2));
}

void add_ground(const PartInfo& info, Lines& lines)
{
    const Ground& ground = *info.ground;
    // Surfaces of a union may continue under each other.
    const char* const by = info.part.format == "JSON surfaces"
                               ? " hidden from above, by overhangs or other surfaces, as "
                               : " hidden from above, as ";
    lines.add("area", number(ground.area, 2) + " mm2");
    lines.add("steepest", fmt::format("{} degrees from horizontal, {}", number(ground.steepest, 2),
                                      place(ground.steepest_at)));
    if (ground.vertical_area > 0) {
        lines.add("", "vertical walls: " + area_and_share(ground.vertical_area, ground.area));
        if (ground.steepest_slope) {
            lines.add("", fmt::format("apart from walls {} degrees, {}",
                                      number(*ground.steepest_slope, 2),
                                      place(ground.steepest_slope_at)));
        }
    }
    lines.add("level ground", ground.level_at ? area_and_share(ground.level_area, ground.area) +
                                                    ", highest " + place(*ground.level_at)
                                              : "none");
    lines.add("undercuts",
              ground.hidden_at && ground.hidden_area > 0
                  ? area_and_share(ground.hidden_area, ground.area) + by + place(*ground.hidden_at)
                  : "none: everything is visible from above");
}

void add_ball(const PartInfo& info, Lines& lines)
{
    if (!info.is_mesh()) {
        lines.add("hollow radius", info.hollow ? fmt::format("{} mm, the smallest of the faces, {}",
                                                             number(info.hollow->radius),
                                                             place(info.hollow->place.point))
                                               : "none: no face is concave");
    }
    const BallReach& ball = *info.ball;
    if (!ball.radius) {
        lines.add("largest ball", "every ball reaches everything");
        return;
    }
    const std::string diameter = number(2 * *ball.radius, 3) + " mm diameter";
    const std::string leaves = number(ball.leaves, 5) + " mm";
    if (ball.corner) {
        lines.add("largest ball", "no ball reaches the corner " + place(ball.at));
        lines.add("", fmt::format("a ball of {} leaves {} there", diameter, leaves));
    } else {
        lines.add("largest ball", fmt::format("{}, leaves at most {}", diameter, leaves));
        lines.add("", "larger ones leave more " + place(ball.at));
    }
}

}  // namespace

std::string text_of(const PartInfo& info)
{
    Lines lines{info.part.file};
    lines.add("format", info.part.format);
    lines.add("unit", unit_text(info.part.unit));
    add_box(info, lines);
    for (const PartLayer& layer : info.part.layers) {
        add_layer(layer, lines);
    }
    if (info.is_mesh()) {
        add_mesh(info, lines);
    } else if (!info.is_drawing()) {
        std::string faces = fmt::format("{}", info.pieces);
        if (info.part.solids > 0) {
            faces += ", of " + count(info.part.solids, "solid", "solids");
        }
        if (info.part.unread_faces > 0) {
            faces +=
                fmt::format("; {} more face down and have broken edges", info.part.unread_faces);
        }
        lines.add("faces", faces);
    }
    for (const std::string& note : info.part.notes) {
        lines.add("note", note);
    }
    if (info.part.features) {
        for (const auto& [label, value] : feature_lines(*info.part.features)) {
            lines.add(label.c_str(), value);
        }
    }
    if (info.ground) {
        add_ground(info, lines);
        add_ball(info, lines);
    }
    return std::move(lines).text();
}

}  // namespace cusp::part_info
