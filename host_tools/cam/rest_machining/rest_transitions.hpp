// From the end of one kept stretch to the start of the next: along a link in proven air, or over
// the clearance height and down where the ground is open.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/rest_machining/swept_stock.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::rest_machining {

class RestTransitions {
public:
    // stock, job, path  must outlive this; the path gives tool and feeds
    // inner             the tool less the tolerance by which the path may touch stock
    // moves             output
    RestTransitions(const SweptStock& stock,
                    const job::Job& job,
                    const toolpath::Toolpath& path,
                    const EndProfile& inner,
                    std::vector<toolpath::ToolMove>& moves);

    // Writes the moves that lead to a place which the tool may reach through air.
    //
    // at_rest_height  the path came down to it by a rapid
    void go_to(Vec3d place, bool at_rest_height);

    // Writes feed moves and removes what they cut from the stock of later descents.
    void cut(const std::vector<toolpath::ToolMove>& moves);

    void retract() { writer_.retract(); }
    int retracts() const { return writer_.retracts(); }

    // s: time of a transition between two places by the clearance height
    double seconds_over(Vec3d from, Vec3d to) const;

private:
    struct Entry {
        Vec2d place;
        double rapid_z;  // the rapid ends here
    };

    const SweptStock& stock_;
    const job::Job& job_;
    const toolpath::Toolpath& path_;
    EndProfile inner_;
    toolpath::ToolpathWriter writer_;
    SweptStock cut_;  // what was cut so far is taken from it

    // True if a rapid may go down to z: in the earlier stock, and in what was cut of it so far.
    bool is_open_at_first(Vec2d place, double z) const;
    bool is_open(Vec2d place, double z) const;
    bool is_link_clear(Vec3d from, Vec3d to) const;
    bool is_way_in_clear(Vec3d beside, Vec3d place) const;
    bool keeps_off_fixtures(Vec2d place, double z) const;
    Entry entry_to(Vec3d place, bool at_rest_height) const;
    std::optional<Entry> entry_beside(Vec3d place) const;
};

}  // namespace cusp::rest_machining
