// LineSmoother: runs of short lines become curves that meet with the same direction and curvature.
//
// Dense programs describe smooth curves by short lines; taken literally each vertex is a jump of
// direction that costs speed. Within its share of the path tolerance a run is replaced by quintic
// Hermite pieces between vertices as far apart as the tolerance allows. At their joints place,
// direction and curvature are those of a cubic by least squares through the vertices around
// (orthogonal polynomials; Forsythe, 1957). Streaming, fixed memory.
#pragma once

#include <cstdint>

#include "firmware/base/static_vector.hpp"
#include "firmware/path/move.hpp"
#include "firmware/planner/quintic.hpp"

namespace cusp::planner {

class LineSmoother {
public:
    // Lines longer than this, mm, are no part of a curve.
    static constexpr float kLongestLine = 2.0F;

    // True if the move may be part of a run: a short feed line with a tolerance.
    static bool accepts(const path::Move& move) noexcept;

    // True if the move continues the run: same feed, tolerance and power, no corner. An empty run takes
    // any.
    bool continues(const path::Move& move) const noexcept;

    bool empty() const noexcept { return vertices_.size() < 2; }
    bool full() const noexcept { return vertices_.full(); }

    // Precondition: accepts(move), continues(move), !full().
    //
    //   departure  mm, that the curve may leave the lines by; that of the run's first move counts.
    void add(const path::Move& move, float departure) noexcept;

    // Time that next() may wait for more vertices: the longer, the longer the pieces.
    enum class Patience : std::uint8_t {
        kFull,   // until the vertices fill the memory
        kShort,  // the tool comes near: take what is known, but for what the knots need
        kNone,   // the run ends with its last vertex
    };

    // The next piece of the curve.
    //
    // Returns false where more vertices are needed, or none is left.
    bool next(Patience patience, path::Move& piece) noexcept;

    void clear() noexcept;

private:
    struct Vertex {
        AxisVec<std::int32_t> at;  // nm from origin_
        std::uint32_t line;
        std::int32_t travel;  // nm, from the vertex before: of the axis that travels farthest
    };
    static constexpr std::size_t kVertices = 80;
    // A piece replaces at most this many lines. A knot takes vertices on either side: at most so
    // many, and none beyond a travel of kKnotTravel, so that long lines need not wait for as many.
    static constexpr std::size_t kMostLines = 48;
    static constexpr std::size_t kBeyond = 16;
    static constexpr std::int32_t kKnotTravel = 3'000'000;  // nm, of the axis that travels farthest
    // nm: the first vertex becomes the origin where it is farther from it. The others are within
    // 160 mm of the first.
    static constexpr std::int32_t kFarthest = 1'000'000'000;

    // The joint of two pieces: the curve through the vertices around it.
    struct Knot {
        AxisVecf at;  // mm from its vertex
        PathEnd end;
    };
    struct Fit {
        Knot end;
        path::Quintic piece;
        AxisVecf chord;  // mm
    };

    AxisVecf between(std::size_t from, std::size_t to) const noexcept;
    std::size_t knot_lines_before(std::size_t index) const noexcept;
    std::size_t knot_lines_after(std::size_t index) const noexcept;
    Knot knot_at(std::size_t index) const noexcept;
    float fit_knot(std::size_t index, std::size_t from, std::size_t to, Knot& knot) const noexcept;
    bool fit(std::size_t last, Fit& fit) const noexcept;
    std::size_t longest_fit(std::size_t most, Fit& best) const noexcept;
    bool within_tolerance(const Fit& fit, std::size_t last) const noexcept;
    void make_curve(const Fit& fit,
                    bool begins,
                    std::size_t passed,
                    path::Move& piece) const noexcept;
    void drop(std::size_t count) noexcept;

    Position origin_{};
    StaticVector<Vertex, kVertices> vertices_;
    path::MoveKind kind_{path::MoveKind::kFeed};  // of the run, as feed and tolerance
    float feed_{0};                               // mm/s
    float tolerance_{0};                          // mm
    float departure_{0};                          // mm
    path::LaserPower power_;
    Knot start_{};  // at the first vertex, where a piece ended there
    bool has_start_{false};
    std::uint8_t lines_before_{1};  // that the piece before replaced
    Position at_{};                 // where the next piece starts
};

}  // namespace cusp::planner
