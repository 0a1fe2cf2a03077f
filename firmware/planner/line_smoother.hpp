// LineSmoother: runs of short lines become arcs that pass their ends with the same direction.
//
// Dense programs describe smooth curves by short lines; taken literally each vertex is a jump of
// direction that costs speed. Within its share of the path tolerance a run is replaced by biarcs
// (two arcs with a common tangent; Bolton, 1975) between vertices chosen as far apart as the
// tolerance allows, with tangents estimated from the neighbours. Streaming, fixed memory.
#pragma once

#include <cstdint>

#include "firmware/base/static_vector.hpp"
#include "firmware/path/move.hpp"

namespace cusp::planner {

class LineSmoother {
public:
    // Part of a move's tolerance that the arcs may leave the lines by.
    static constexpr float kShareOfTolerance = 0.45F;

    // Lines longer than this, mm, are no part of a curve.
    static constexpr float kLongestLine = 2.0F;

    // Whether the move may be part of a run: a short feed line with a tolerance.
    static bool accepts(const path::Move& move) noexcept;

    // Whether the move continues the run: same feed and tolerance, no corner. An empty run takes
    // any.
    bool continues(const path::Move& move) const noexcept;

    bool empty() const noexcept { return vertices_.size() < 2 && !has_second_; }
    bool full() const noexcept { return vertices_.full(); }

    // Precondition: accepts(move), continues(move), !full().
    void add(const path::Move& move) noexcept;

    // How long next() may wait for more vertices: the longer, the longer the arcs.
    enum class Patience : std::uint8_t {
        kFull,   // until the vertices fill the memory
        kShort,  // the tool comes near: take what is known, but for what the tangents need
        kNone,   // the run ends with its last vertex
    };

    // The next piece of the curve.
    //
    // Returns false where more vertices are needed, or none is left.
    bool next(Patience patience, path::Move& piece) noexcept;

    void clear() noexcept;

private:
    struct Vertex {
        Position at;
        std::uint32_t line;
    };
    static constexpr std::size_t kVertices = 40;
    // A piece replaces at most this many lines; tangents need a few vertices beyond.
    static constexpr std::size_t kMostLines = 24;
    static constexpr std::size_t kBeyond = 8;

    // One arc of a biarc, relative to the first vertex.
    struct Arc {
        Vec3f start, end;
        Vec3f tangent;  // unit, at the start
        Vec3f normal;   // unit, to the centre; zero for a line
        float radius;
    };
    struct Biarc {
        Arc first, second;
    };

    Vec3f place(std::size_t index) const noexcept;
    Vec3f tangent_at(std::size_t index) const noexcept;
    bool fit(std::size_t last, Biarc& biarc) const noexcept;
    bool within_tolerance(const Biarc& biarc, std::size_t last) const noexcept;
    static Arc tangent_arc(Vec3f start, Vec3f tangent, Vec3f end) noexcept;
    static float distance(const Arc& arc, Vec3f point) noexcept;
    path::Move as_move(const Arc& arc, Position end) const noexcept;
    void drop(std::size_t count) noexcept;

    StaticVector<Vertex, kVertices> vertices_;
    path::Move model_{};  // feed, tolerance and kind of the run
    Vec3f tangent_{};     // at the first vertex, where a piece ended there
    bool has_tangent_{false};
    Position at_{};        // where the next piece starts
    path::Move second_{};  // the other half of the last biarc
    bool has_second_{false};
};

}  // namespace cusp::planner
