// The moves alone tell of a thread: heights in plan can't show it. Where the teeth are on the wall, height and azimuth
// belong to one helix; round the whole hole they come by in each pitch of the depth.
#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "host_tools/job/job/thread.hpp"
#include "host_tools/judge/verify/verdict.hpp"
#include "host_tools/judge/verify/verify_stages.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using job::Hole;
using job::Operation;
using job::Thread;

namespace {

constexpr std::size_t kSectors = 24;
constexpr double kOnWall = 0.01;       // mm, beside the tolerance
constexpr double kLeadOfPitch = 0.25;  // a half circle onto the wall rises by this much

// Finds the fault of one thread, in words; "": none.
class ThreadJudge {
public:
    ThreadJudge(const Verifying& work, const Operation& operation, const Hole& hole)
        : work_{work},
          operation_{operation},
          thread_{*thread_of(operation)},
          hole_{hole},
          bottom_{tip_in_hole(*operation.prismatic, hole, operation.tool)},
          wall_{thread_.axis_radius(thread_.wall(), operation.tool.radius)},
          allowed_{operation.tolerance.plan + kOnWall}
    {
    }

    std::string fault()
    {
        for (const ToolPositions& run : work_.runs) {
            for (std::size_t k = 0;
                 run.tool.number == operation_.tool.number && k < run.tips.size(); ++k) {
                const Vec3d tip = run.tips[k];
                const double from_wall = norm(in_plan(tip) - hole_.at) - wall_;
                if (!run.rapid[k] && tip.z < operation_.prismatic->top &&
                    std::abs(from_wall) <= allowed_) {
                    stretch_.push_back({tip, run.lines[k]});
                } else {
                    end_stretch();
                }
            }
            end_stretch();
        }
        return off_ > operation_.tolerance.floor + kOnWall
                   ? fmt::format("is {:.3f} mm off its helix of {:g} mm a turn, line {}", off_,
                                 thread_.form.pitch, line_)
                   : missing();
    }

private:
    struct OnWall {
        Vec3d tip;
        std::uint32_t line;
    };

    // Way along the wall that turns farther about the hole than a straight move can: the others cross it, as moves of
    // another operation by the same tool do.
    void end_stretch()
    {
        double turned = 0;
        for (std::size_t k = 1; k < stretch_.size(); ++k) {
            const Vec2d before = in_plan(stretch_[k - 1].tip) - hole_.at;
            const Vec2d after = in_plan(stretch_[k].tip) - hole_.at;
            turned += elementary::atan2(cross(before, after), dot(before, after));
        }
        const double inner = std::max(0.0, wall_ - allowed_);
        const double outer = wall_ + allowed_;
        const double straight =
            2 * elementary::atan2(std::sqrt(outer * outer - inner * inner), inner);
        if (std::abs(turned) > straight) {
            for (const OnWall& at : stretch_) {
                look_at(at.tip, at.line);
            }
        }
        stretch_.clear();
    }

    void look_at(Vec3d tip, std::uint32_t line)
    {
        const Vec2d from = in_plan(tip) - hole_.at;
        const double pitch = thread_.form.pitch;
        const double turn = elementary::atan2(from.y, from.x) / (2 * kPi);
        const double phase = tip.z / pitch - (thread_.left ? -turn : turn);
        const double against = phase - first_.value_or(phase);
        first_ = first_.value_or(phase);
        const double off = std::abs(against - std::round(against)) * pitch;
        if (off > off_) {
            off_ = off;
            line_ = line;
        }
        const auto sector = static_cast<std::size_t>((turn + 1) * kSectors) % kSectors;
        for (int tooth = 0; tooth < thread_.teeth; ++tooth) {
            heights_[sector].push_back(tip.z + tooth * pitch);
        }
    }

    // A stretch of the depth, longer than a pitch, in which no tooth comes by.
    std::string missing()
    {
        const double top = operation_.prismatic->top;
        const double most = thread_.form.pitch * (1 + 1.0 / kSectors) + allowed_;
        const double first = bottom_ + kLeadOfPitch * thread_.form.pitch;
        for (std::vector<double>& heights : heights_) {
            heights.push_back(top);
            std::sort(heights.begin(), heights.end());
            double below = first;
            for (const double z : heights) {
                if (z - below > most && below < top) {
                    return fmt::format("has no groove from z {:.3f} to {:.3f}", below,
                                       std::min(z, top));
                }
                below = std::max(below, z);
            }
        }
        return "";
    }

    const Verifying& work_;
    const Operation& operation_;
    const Thread& thread_;
    const Hole& hole_;
    double bottom_;
    double wall_;                  // mm: radius of the axis' way
    double allowed_;               // mm
    std::vector<OnWall> stretch_;  // positions along the wall, one after the other
    std::optional<double> first_;
    double off_{0};  // mm
    std::uint32_t line_{0};
    std::array<std::vector<double>, kSectors> heights_;
};

}  // namespace

void judge_threads(Verifying& work)
{
    for (const Operation& operation : work.job.operations) {
        const Thread* const thread = thread_of(operation);
        for (std::size_t k = 0; thread != nullptr && k < operation.prismatic->holes.size(); ++k) {
            const Hole& hole = operation.prismatic->holes[k];
            const std::string fault = ThreadJudge{work, operation, hole}.fault();
            if (!fault.empty()) {
                work.result.broken.push_back(
                    fmt::format("thread {} of operation {} at x {:.3f} y {:.3f} {}", thread->text,
                                operation.number, hole.at.x, hole.at.y, fault));
            }
        }
    }
}

}  // namespace cusp::verify
