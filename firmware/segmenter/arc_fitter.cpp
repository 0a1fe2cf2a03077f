// The search for the longest move: doubling, then bisection.
#include "firmware/segmenter/arc_fitter.hpp"

#include <algorithm>
#include <array>

#include "firmware/segmenter/line_run.hpp"

namespace cusp::segmenter {

ArcFitter::ArcFitter(const FitSettings& settings, Span<Vec3d> buffer) noexcept
    : settings_{settings}, buffer_{buffer}
{
    CUSP_ASSERT(buffer.size() >= 4);
}

void ArcFitter::start(Vec3d point) noexcept
{
    begin_ = 0;
    end_ = 1;
    buffer_[0] = point;
    finished_ = false;
}

void ArcFitter::push(Vec3d vertex) noexcept
{
    CUSP_ASSERT(end_ > 0 && has_room());
    buffer_[end_] = vertex;
    ++end_;
}

bool ArcFitter::fit(std::size_t count, FittedMove& move) const noexcept
{
    const Span<const Vec3d> vertices{buffer_.data() + begin_, count + 1};
    if (count == 1) {
        move = {};
        move.end = vertices[1];
        move.lines = 1;
        return true;
    }
    if (fit_line(vertices, settings_, move)) {
        return true;
    }
    if (!settings_.arcs) {
        return false;
    }
    if (fit_arc(vertices, path::Plane::kXY, settings_, move)) {
        return true;
    }
    // Most runs are level: the other planes see only a line from its end.
    const double height = vertices[0].z;
    return (height != vertices[count / 2].z || height != vertices[count].z) &&
           (fit_arc(vertices, path::Plane::kZX, settings_, move) ||
            fit_arc(vertices, path::Plane::kYZ, settings_, move));
}

// The largest count that fits, as far as doubling, bisection and a few probes beyond see: what fits
// is nearly always fitted by less, too, but an arc through a vertex that was rounded badly fits
// later than its neighbours. The probes save 1 % of the moves of a pocket with rounded vertices.
std::size_t ArcFitter::farthest(FittedMove& move) const noexcept
{
    const std::size_t most = waiting();
    std::size_t good = 1;
    (void)fit(1, move);
    std::size_t bad = most + 1;
    FittedMove trial{};
    for (std::size_t count = 2; count <= most; count *= 2) {
        if (!fit(count, trial)) {
            bad = count;
            break;
        }
        good = count;
        move = trial;
    }
    while (bad - good > 1) {
        const std::size_t middle = good + (bad - good) / 2;
        if (fit(middle, trial)) {
            good = middle;
            move = trial;
        } else {
            bad = middle;
        }
    }
    constexpr std::array<std::size_t, 7> kProbes = {3, 6, 12, 18, 24, 30, 36};
    const std::size_t found = good;
    for (const std::size_t probe : kProbes) {
        if (found + probe <= most && fit(found + probe, trial)) {
            good = found + probe;
            move = trial;
        }
    }
    return good;
}

bool ArcFitter::next(FittedMove& move) noexcept
{
    if (end_ == 0 || waiting() == 0 || (!finished_ && has_room())) {
        return false;
    }
    begin_ += farthest(move);
    const bool half_done = begin_ >= buffer_.size() / 2;
    if (half_done && !finished_) {
        std::copy(buffer_.begin() + begin_, buffer_.begin() + end_, buffer_.begin());
        end_ -= begin_;
        begin_ = 0;
    }
    return true;
}

}  // namespace cusp::segmenter
