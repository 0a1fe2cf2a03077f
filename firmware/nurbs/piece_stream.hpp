// Converts a NURBS of any length, point by point, to exact rational Bezier pieces in fixed memory.
//
//   PieceStream stream;
//   stream.open(KnotSource::kUniform, 4, start);  // cubic
//   for (const ControlPoint& point : rest) {
//       stream.add_point(point);
//       while (stream.next(piece)) { ... }
//   }
//   Status status = stream.close();
//   while (stream.next(piece)) { ... }
//
// A span of a curve of order k depends on k control points and 2 (k - 1) knots only, so a piece can
// leave as soon as those are known: 2 k points and knots are resident, however long the curve.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/result.hpp"
#include "firmware/base/vec.hpp"
#include "firmware/path/path.hpp"

namespace cusp::nurbs {

struct ControlPoint {
    Position position;  // machine nanometres
    double weight;      // > 0
};

// One piece of the curve. It starts where the piece before it ended, and has an ArcLengthTable.
struct Piece {
    path::BezierPiece bezier;
    Position end;
};

// No piece is longer than this, mm, so that float resolves half a nanometre along it.
inline constexpr double kMaxPieceLength = 8.0;

// |dP/du| of a piece, mm: the parameter is rounded to some 1e-7, so a place to about a nanometre.
inline constexpr float kMaxParametricSpeed = 16.0F;

// A piece shorter than this, mm, is replaced by its chord where the curve has a cusp or dP/du
// vanishes, so the path is off by at most half of it.
inline constexpr double kMaxChordLength = 0.001;

enum class KnotSource : std::uint8_t {
    kUniform,   // G5.2: clamped, uniform; the knots follow from the number of points
    kExplicit,  // G6.2: one knot a point, then `order` closing knots
};

// Points and knots go in, pieces come out. After each call that adds something, take pieces with
// next() until there is none.
class PieceStream {
public:
    // Starts a curve; the first control point is its start. With explicit knots add_knot() comes
    // next, once for each point. Precondition: order in 2 to 5, weight > 0.
    void open(KnotSource source, unsigned order, const ControlPoint& first) noexcept;

    // Adds a control point. Precondition: accepts_points(), weight > 0.
    void add_point(const ControlPoint& point) noexcept;

    // Adds the next knot: of the point just added, or a closing one where no point came before.
    // Precondition: explicit knots, is_open().
    //
    // Errors: kGcodeInvalidTarget: the knot is smaller than the one before; the first `order` knots
    // or the closing ones are not all equal; a knot inside is repeated more than order - 1 times;
    // fewer than `order` points when the first closing knot comes. The curve is then given up.
    Status add_knot(double knot) noexcept;

    // Ends a uniform curve. Errors: kGcodeInvalidTarget: fewer than `order` points; the curve is
    // then given up.
    Status close() noexcept;

    // The next piece: false where more points or knots are needed first.
    bool next(Piece& piece) noexcept;

    // Gives up the rest of the curve.
    void abandon() noexcept;

    // True from open() until the last knot or close() came, or the curve was given up.
    bool is_open() const noexcept { return is_open_; }

    // False once closing knots have begun.
    bool accepts_points() const noexcept { return is_open_ && closing_knots_ == 0; }

    // End of the last piece taken; before the first, the start of the curve.
    Position position() const noexcept { return position_; }

private:
    // A control point times its weight, relative to an origin, mm.
    struct Weighted {
        AxisVecd point;
        double weight;
    };
    using Net = std::array<Weighted, path::kMaxOrder>;

    static constexpr std::uint32_t kResident = 16;  // a power of two >= 2 kMaxOrder - 1

    Status check_knot(double knot) noexcept;
    double knot_at(std::uint32_t index) const noexcept;
    std::uint32_t ready_end() const noexcept;
    bool begin_span() noexcept;
    bool next_of_span(Piece& piece) noexcept;
    bool try_piece(double from, double to, Piece& piece) noexcept;
    Net part_of_span(double from, double to) const noexcept;

    KnotSource source_{KnotSource::kUniform};
    std::uint32_t order_{2};
    bool is_open_{false};
    bool closed_{false};
    std::uint32_t points_count_{0};
    std::uint32_t knots_count_{0};
    std::uint32_t closing_knots_{0};
    std::uint32_t multiplicity_{0};  // of the last knot
    std::array<ControlPoint, kResident> points_{};
    std::array<double, kResident> knots_{};
    Position position_;

    // The span that is being cut into pieces: done up to `done_`, in steps of `step_`.
    std::uint32_t next_span_{0};
    bool in_span_{false};
    Net span_{};
    Position span_origin_;
    double done_{0};
    double step_{1};
};

}  // namespace cusp::nurbs
