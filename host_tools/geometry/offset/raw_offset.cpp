// Offsets edge by edge; arcs around outer corners close the gaps.
#include "host_tools/geometry/offset/raw_offset.hpp"

#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::offset {

namespace {

// The offset of an edge. An arc may shrink to its centre, which still joins its neighbours, or turn
// inside out.
enum class Fate { kKept, kPoint, kLost };

Fate fate_of(const Edge& edge, double distance)
{
    if (edge.turn <= 0 || edge.radius - distance > kSamePoint) {
        return Fate::kKept;
    }
    return edge.radius - distance > -kSamePoint ? Fate::kPoint : Fate::kLost;
}

Edge moved(const Edge& edge, Vec2d start, Vec2d end, double distance)
{
    return {start, end, edge.centre, edge.radius - edge.turn * distance, edge.turn};
}

// Adds the arc around a corner from one offset end to the next start, in two halves if it is long.
void add_corner(std::vector<RawPiece>& pieces,
                Vec2d corner,
                Vec2d from,
                Vec2d to,
                double distance,
                std::uint32_t origin)
{
    const Vec2d a = unit(from - corner);
    const Vec2d b = unit(to - corner);
    if (dot(a, b) < -0.5) {
        // Half way round clockwise; for an exact reversal the sum of a and b has no direction.
        const Vec2d ahead = left_normal(a) * -1.0;
        const double turned = elementary::atan2(cross(b, a), dot(a, b));
        const double half = 0.5 * (turned < 0.0 ? turned + 2 * kPi : turned);
        const Vec2d middle =
            corner + (a * elementary::cos(half) + ahead * elementary::sin(half)) * distance;
        pieces.push_back({{from, middle, corner, distance, -1}, true, false, origin});
        pieces.push_back({{middle, to, corner, distance, -1}, true, false, origin + 1});
        return;
    }
    pieces.push_back({{from, to, corner, distance, -1}, true, false, origin});
}

class ContourOffset {
public:
    // origin  of the first edge's piece
    ContourOffset(const Contour& contour,
                  double distance,
                  std::uint32_t origin,
                  std::vector<RawPiece>& pieces)
        : contour_{contour},
          distance_{distance},
          origin_{origin},
          pieces_{pieces},
          first_{pieces.size()}
    {
    }

    void run()
    {
        for (std::size_t i = 0; i < contour_.size(); ++i) {
            const std::size_t size = contour_.size();
            add_edge(contour_[(i + size - 1) % size], contour_[i], contour_[(i + 1) % size]);
            origin_ += kOrigins;
        }
        if (pieces_.size() > first_) {
            pieces_.back().last = true;
            // The joint at its end is that with the contour's first edge.
            pieces_.back().joined =
                pieces_.back().joined && fate_of(contour_[0], distance_) != Fate::kLost;
        }
    }

private:
    // The ends at which the pieces of an edge and of the next one meet.
    struct Junction {
        Vec2d end;
        Vec2d onward;
        bool smooth;  // at one point
        bool corner;  // an arc around the corner closes the gap
    };

    Junction joint_of(const Edge& edge, const Edge& next) const
    {
        const Vec2d leaving = tangent_at_end(edge);
        const Vec2d entering = tangent_at_start(next);
        const Vec2d end = edge.end + left_normal(leaving) * distance_;
        const Vec2d onward = next.start + left_normal(entering) * distance_;
        if (cusp::offset::distance(end, onward) < kSamePoint) {
            return {onward, onward, true, false};
        }
        if (const auto meet = nearly_smooth(edge, next, end, onward)) {
            return {*meet, *meet, true, false};
        }
        const bool corner = cross(leaving, entering) < 0.0 || dot(leaving, entering) < -0.9999;
        return {end, onward, false, corner};
    }

    // The place where two pieces with a small kink between them meet: a point at the distance from
    // the joint that lies on both to within rounding. Their crossing, the other way to close the
    // joint, is not known so exactly where they are nearly tangent. None where the kink shows, or a
    // piece is too short.
    std::optional<Vec2d> nearly_smooth(const Edge& edge,
                                       const Edge& next,
                                       Vec2d end,
                                       Vec2d onward) const
    {
        constexpr double kOff = 5e-9;    // mm
        constexpr double kShare = 0.25;  // of a piece that may change
        if (fate_of(edge, distance_) != Fate::kKept || fate_of(next, distance_) != Fate::kKept) {
            return std::nullopt;
        }
        const double gap = cusp::offset::distance(end, onward);
        const Vec2d joint = edge.end;
        const Vec2d meet = joint + unit((end - joint) + (onward - joint)) * distance_;
        const auto fits = [&](const Edge& source, Vec2d from) {
            const double size =
                length(source) * (source.turn == 0 ? 1.0 : offset_radius(source) / source.radius);
            const double off =
                source.turn == 0
                    ? dot(meet - from, left_normal(unit(source.end - source.start)))
                    : cusp::offset::distance(meet, source.centre) - offset_radius(source);
            return gap <= kShare * size && std::abs(off) <= kOff;
        };
        if (gap > 0.1 * distance_ || !fits(edge, end) || !fits(next, onward)) {
            return std::nullopt;
        }
        return meet;
    }

    double offset_radius(const Edge& arc) const { return arc.radius - arc.turn * distance_; }

    void add_edge(const Edge& before, const Edge& edge, const Edge& next)
    {
        const Junction joint = joint_of(edge, next);
        const bool next_lost = fate_of(next, distance_) == Fate::kLost;
        switch (fate_of(edge, distance_)) {
            case Fate::kKept: {
                pieces_.push_back({moved(edge, joint_of(before, edge).onward, joint.end, distance_),
                                   (joint.corner || joint.smooth) && !(joint.smooth && next_lost),
                                   false, origin_});
                break;
            }
            case Fate::kPoint:
                if (pieces_.size() > first_ && !(joint.corner || (joint.smooth && !next_lost))) {
                    pieces_.back().joined = false;
                }
                break;
            case Fate::kLost:
                break;
        }
        if (joint.corner) {
            add_corner(pieces_, edge.end, joint.end, joint.onward, distance_, origin_ + 1);
            pieces_.back().joined = !next_lost;
        }
    }

    const Contour& contour_;
    double distance_;
    std::uint32_t origin_;
    std::vector<RawPiece>& pieces_;
    std::size_t first_;
};

}  // namespace

std::vector<RawPiece> raw_offset(const Region2d& source, double distance)
{
    std::vector<RawPiece> pieces;
    std::size_t count = 0;
    for (const Contour& contour : source.contours) {
        count += contour.size();
    }
    pieces.reserve(count + count / 2);
    std::uint32_t origin = 0;
    for (const Contour& contour : source.contours) {
        ContourOffset{contour, distance, origin, pieces}.run();
        origin += kOrigins * static_cast<std::uint32_t>(contour.size());
    }
    return pieces;
}

std::vector<RawPiece> living_pieces(std::vector<RawPiece> pieces,
                                    const std::vector<double>& gone,
                                    double distance)
{
    std::size_t count = 0;
    std::size_t contour = 0;  // where the contour begins among those
    bool first = true;
    bool starts = false;  // the contour's first piece is among them
    bool before = false;  // the piece before is
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const RawPiece piece = pieces[i];
        const bool lives = gone[piece.origin] > distance;
        if (first) {
            contour = count;
            starts = lives;
        } else if (count > contour && !lives) {
            pieces[count - 1].joined = false;
        }
        if (lives) {
            pieces[count++] = piece;
        }
        before = lives;
        first = piece.last;
        if (piece.last && count > contour) {
            pieces[count - 1].last = true;
            pieces[count - 1].joined = pieces[count - 1].joined && before && starts;
        }
    }
    pieces.resize(count);
    return pieces;
}

}  // namespace cusp::offset
