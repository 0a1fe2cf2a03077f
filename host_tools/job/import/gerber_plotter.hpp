// A photoplotter of Gerber files: flashes, strokes and regions become objects in order.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/gerber_aperture.hpp"
#include "host_tools/job/import/gerber_shapes.hpp"
#include "host_tools/job/import/svg_transform.hpp"

namespace cusp::import {

struct GerberObject {
    offset::Region2d region;
    bool dark{true};
};

// How the next objects are put down: by the commands LP, LM, LR and LS.
struct PlotState {
    bool dark{true};
    bool mirror_x{};
    bool mirror_y{};
    double turn{};  // radians
    double scale{1};
};

// Errors of all members: InputError that begins with the place.
class GerberPlotter {
public:
    // place  file and line of what is read now; it outlives this
    explicit GerberPlotter(const std::string& place) : place_{place} {}

    PlotState& state() { return state_; }
    bool in_region() const { return in_region_; }

    void define(int code, Aperture aperture);
    void select(int code);
    void flash(Vec2d at);
    // way  nothing: a straight one
    void stroke(Vec2d from, Vec2d to, const std::optional<CircularWay>& way);

    void begin_region() { in_region_ = true; }
    void add_edge(Vec2d from, Vec2d to, const std::optional<CircularWay>& way);
    void end_contour();
    void end_region();

    // All that is drawn until its end is an aperture.
    void begin_block(int code);
    void end_block();
    // All that is drawn until its end, or the end of the file, is drawn that often: copies in all lines and rows.
    void begin_repeat(int across, int up, Vec2d step);
    void end_repeat();
    void end_file();

    std::vector<GerberObject>& objects() { return objects_; }
    // The middles of strokes, outside regions.
    std::vector<DrawingPath>& lines() { return lines_; }

private:
    struct Stamp {
        std::vector<GerberObject> objects;
        double diameter{};  // mm, of a solid circle
        std::vector<Vec2d> corners;
    };
    // A block or a repeat that has begun.
    struct Group {
        int code{};  // of a block
        int across{1};
        int up{1};
        Vec2d step;
        std::size_t first{};  // of the objects
        std::size_t first_line{};
    };

    [[noreturn]] void refuse(const std::string& what) const;
    void add(GerberObject object);
    PlaneMap stamp_map(Vec2d at) const;
    void draw_line(Vec2d from, Vec2d to, const std::optional<CircularWay>& way);

    const std::string& place_;
    PlotState state_;
    std::map<int, Stamp> apertures_;
    const Stamp* aperture_{};
    std::vector<Group> blocks_;
    std::optional<Group> repeat_;
    bool in_region_{};
    offset::Contour contour_;
    std::vector<GerberObject> objects_;
    std::vector<DrawingPath> lines_;
};

// All dark objects laid together, without what is clear after them.
offset::Region2d dark_region(const std::vector<GerberObject>& objects);

}  // namespace cusp::import
