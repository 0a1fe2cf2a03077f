// Polylines of one colour each: a path of many moves stays a small file.
#include <array>
#include <limits>
#include <vector>

#include "host_tools/report/colour_scale.hpp"
#include "host_tools/report/picture_frame.hpp"
#include "host_tools/report/pictures.hpp"
#include "host_tools/verify/part_heights.hpp"

namespace cusp::report {

using job::Job;
using job::Operation;
using nurbs::Surface;
using verify::append_points;
using verify::part_box;
using verify::PartBox;
using verify::Program;

namespace {

constexpr double kSpacing = 0.5;  // mm along arcs and curves

std::vector<Vec3d> points_of(const path::Move& move)
{
    std::vector<Vec3d> points{to_millimetres(move.start)};
    const bool straight = std::holds_alternative<path::Line>(move.path);
    append_points(move, straight ? std::numeric_limits<double>::infinity() : kSpacing, points);
    return points;
}

struct Extent {
    PictureFrame frame;
    double z_low, z_high;
};

Extent extent_of(const Job& job, const Program& program)
{
    std::vector<Surface> surfaces;
    std::vector<std::array<Vec3d, 3>> mesh;
    for (const Operation& operation : job.operations) {
        surfaces.insert(surfaces.end(), operation.floor.begin(), operation.floor.end());
        mesh.insert(mesh.end(), operation.mesh.begin(), operation.mesh.end());
    }
    const PartBox box = part_box(surfaces, mesh);
    Extent extent{{box.x_low, box.x_high, box.y_low, box.y_high}, 1e9, -1e9};
    for (std::size_t k = 1; k < program.moves.size(); ++k) {
        const path::Move& move = program.moves[k].move;
        if (move.kind == path::MoveKind::kRapid) {
            continue;
        }
        for (const Vec3d p : points_of(move)) {
            PictureFrame& f = extent.frame;
            f = {std::min(f.x_low, p.x), std::max(f.x_high, p.x), std::min(f.y_low, p.y),
                 std::max(f.y_high, p.y)};
            extent.z_low = std::min(extent.z_low, p.z);
            extent.z_high = std::max(extent.z_high, p.z);
        }
    }
    return extent;
}

constexpr int kRapid = -1;

class PathLines {
public:
    PathLines(const PictureFrame& frame, std::string& out) : frame_{frame}, out_{out} {}

    // From a to b, in the colour of a step, or dashed for kRapid.
    void add(Vec3d a, Vec3d b, int step)
    {
        if (!open_ || step != step_) {
            close();
            out_ += step == kRapid
                        ? fmt::format(
                              "<polyline fill=\"none\" stroke=\"#c03030\" "
                              "stroke-width=\"{:.3f}\" stroke-dasharray=\"{:.3f}\" points=\"",
                              frame_.line(), 5 * frame_.line())
                        : fmt::format(
                              "<polyline fill=\"none\" stroke=\"{}\" "
                              "stroke-width=\"{:.3f}\" points=\"",
                              colour_of_step(step), frame_.line());
            point(a);
            open_ = true;
            step_ = step;
        }
        point(b);
    }
    void close()
    {
        out_ += open_ ? "\"/>\n" : "";
        open_ = false;
    }

private:
    void point(Vec3d p) { out_ += fmt::format("{:.2f},{:.2f} ", p.x, frame_.flipped(p.y)); }

    const PictureFrame& frame_;
    std::string& out_;
    bool open_{false};
    int step_{0};
};

}  // namespace

std::string path_picture(const Job& job, const Program& program)
{
    const Extent extent = extent_of(job, program);
    const PictureFrame& frame = extent.frame;
    std::string out = frame.head() + walls(job, frame);
    PathLines lines{frame, out};
    // the first move comes from where the machine happens to stand
    for (std::size_t k = 2; k < program.moves.size(); ++k) {
        const path::Move& move = program.moves[k].move;
        const std::vector<Vec3d> points = points_of(move);
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double z = (points[i - 1].z + points[i].z) / 2;
            const int step = move.kind == path::MoveKind::kRapid
                                 ? kRapid
                                 : step_of(z, extent.z_low, extent.z_high);
            lines.add(points[i - 1], points[i], step);
        }
    }
    lines.close();
    out += scale_bar(frame.x_high + frame.margin(), frame.y_low, 0.8 * frame.height(), extent.z_low,
                     extent.z_high, "tip z, mm");
    return out + "</svg>\n";
}

}  // namespace cusp::report
