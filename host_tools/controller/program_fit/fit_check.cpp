// The distance of vertices from arcs and lines, measured apart from the fitting.
#include "host_tools/controller/program_fit/fit_check.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "firmware/gcode/interpreter.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::program_fit {
namespace {

double distance_to_line(AxisVecd p, AxisVecd end)
{
    const double square = dot(end, end);
    const double t = square > 0 ? std::clamp(dot(p, end) / square, 0.0, 1.0) : 0;
    return norm(p - end * t);
}

// To the point of the arc at the same angle; to the nearer end beyond its ends.
double distance_to_arc(AxisVecd p, const path::Arc& arc, AxisVecd end)
{
    const AxisVecd from_centre = p - arc.centre;
    const double x = dot(from_centre, arc.u);
    const double y = dot(from_centre, arc.v);
    double angle = elementary::atan2(y, x);
    angle += angle < 0 ? 2 * elementary::acos(-1.0) : 0;
    if (angle > arc.sweep) {
        return std::min(norm(p), norm(p - end));
    }
    const double share = angle / arc.sweep;
    const AxisVecd on_arc = arc.centre +
                            (arc.radius + share * arc.radius_change) *
                                (elementary::cos(angle) * arc.u + elementary::sin(angle) * arc.v) +
                            share * arc.axial;
    return norm(p - on_arc);
}

class Checker {
public:
    Checker(const std::vector<Position>& vertices, const std::vector<Replacement>& replacements)
        : vertices_{vertices}, replacements_{replacements}
    {
    }

    void run(std::string_view text)
    {
        const Status status = interpreter_.execute(text, static_cast<std::uint32_t>(line_ + 1));
        if (!status) {
            throw std::logic_error("the fitted program is refused at its line " +
                                   std::to_string(line_ + 1) + ": " + std::string{text});
        }
        const bool replaces =
            next_ < replacements_.size() && replacements_[next_].text_line == line_;
        gcode::Action action;
        while (interpreter_.next(action)) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                count(*move);
                if (replaces) {
                    measure(replacements_[next_], *move);
                }
            }
        }
        next_ += replaces ? 1 : 0;
        ++line_;
    }
    const MeasuredFit& measured() const { return measured_; }

private:
    void count(const path::Move& move)
    {
        if (move.kind == path::MoveKind::kRapid) {
            ++measured_.rapids;
        } else if (std::holds_alternative<path::Line>(move.path)) {
            ++measured_.lines;
        } else if (std::holds_alternative<path::Arc>(move.path)) {
            ++measured_.arcs;
        } else {
            ++measured_.other_moves;
        }
    }

    void measure(const Replacement& replacement, const path::Move& move)
    {
        if (vertices_[replacement.first + replacement.count] != move.end) {
            throw std::logic_error("the fitted program misses a vertex at its line " +
                                   std::to_string(line_ + 1));
        }
        const AxisVecd end = to_millimetres(move.end - move.start);
        const auto* arc = std::get_if<path::Arc>(&move.path);
        AxisVecd last{};
        for (std::uint32_t i = 1; i <= replacement.count; ++i) {
            const AxisVecd at = to_millimetres(vertices_[replacement.first + i] - move.start);
            const AxisVecd middle = 0.5 * (at + last);
            last = at;
            const auto distance = [&](AxisVecd p) {
                return arc != nullptr ? distance_to_arc(p, *arc, end) : distance_to_line(p, end);
            };
            measured_.vertices = std::max(measured_.vertices, distance(at));
            measured_.between = std::max(measured_.between, distance(middle));
        }
    }

    const std::vector<Position>& vertices_;
    const std::vector<Replacement>& replacements_;
    gcode::Interpreter interpreter_;
    MeasuredFit measured_;
    std::size_t line_{0};
    std::size_t next_{0};
};

}  // namespace

MeasuredFit measure_fit(std::string_view program,
                        const std::vector<Position>& vertices,
                        const std::vector<Replacement>& replacements)
{
    Checker checker{vertices, replacements};
    while (!program.empty()) {
        const std::size_t end = program.find('\n');
        checker.run(program.substr(0, end));
        program.remove_prefix(end == std::string_view::npos ? program.size() : end + 1);
    }
    return checker.measured();
}

}  // namespace cusp::program_fit
