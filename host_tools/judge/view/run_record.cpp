// Passes each tick to all encoders.
#include "host_tools/judge/view/run_record.hpp"

#include <algorithm>
#include <cstdlib>

#include "firmware/base/axis.hpp"

namespace cusp::view {

void RunRecord::add(const RunPiece& batch)
{
    auto event = batch.path.begin();
    for (std::size_t k = 0; k < batch.points.size(); ++k) {
        for (; event != batch.path.end() && event->before == k; ++event) {
            if (event->move) {
                deviation_.add_move(*event->move);
            } else {
                deviation_.restart();
            }
        }
        add(batch.points[k]);
    }
}

void RunRecord::add(const program_run::SetPoint& point)
{
    const auto known = [&](std::uint32_t line) {
        return std::min<std::size_t>(line, reading_.rapid.size() - 1);
    };
    const std::size_t now = known(point.line);
    const std::size_t before = known(line_);
    const bool corner = reading_.rapid[now] != reading_.rapid[before] ||
                        reading_.section[now] != reading_.section[before];
    if (ticks() == 0) {
        start_ = point.microseconds;
        start_at_ = point.at;
    } else if (point.line != line_) {
        end_line_run();
    }
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        farthest_ = std::max(farthest_, std::abs(point.at[axis] - start_at_[axis]));
    }
    line_ = point.line;
    ++run_ticks_;
    const int tool = reading_.sections[reading_.section[now]].tool;
    path_.add(xyz(to_millimetres(point.at)), ticks(), tool, reading_.rapid[now] != 0);
    vertices_.add(point.at, point.on_path ? deviation_.add_set_point(point.at) : 0.0, corner);
    samples_.add(point.at);
    if (engagement_) {
        engagement_->add(xyz(to_millimetres(point.at)), point.line);
    }
}

void RunRecord::end_line_run()
{
    runs_.put_varint(run_ticks_);
    runs_.put_varint(zigzag(static_cast<std::int64_t>(line_) - written_line_));
    written_line_ = line_;
    run_ticks_ = 0;
    ++run_count_;
}

Bytes RunRecord::line_runs()
{
    end_line_run();
    Bytes out;
    out.put_u32(run_count_);
    out.put(runs_.text());
    return out;
}

}  // namespace cusp::view
