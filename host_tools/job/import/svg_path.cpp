// One reader for all commands: a command repeats for as long as numbers follow.
#include "host_tools/job/import/svg_path.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/svg_text.hpp"
#include "host_tools/job/import/svg_transform.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

char upper(char command)
{
    return command >= 'a' ? static_cast<char>(command - 'a' + 'A') : command;
}

class PathReader {
public:
    PathReader(std::string_view text, const std::string& place) : text_{text}, place_{place} {}

    std::vector<DrawingPath> read()
    {
        char command = '\0';
        for (text_.skip(); !text_.at_end(); text_.skip()) {
            const char next = text_.next();
            const bool letter = (next >= 'A' && next <= 'Z') || (next >= 'a' && next <= 'z');
            if (letter) {
                command = text_.take();
                named_ = command;
                if (!moved_ && upper(command) != 'M') {
                    refuse("it begins with a move, M");
                }
            } else if (command == '\0' || upper(command) == 'Z') {
                refuse("a command is needed here");
            }
            draw(command);
            command = command == 'M' ? 'L' : command == 'm' ? 'l' : command;
        }
        finish(false);
        return std::move(paths_);
    }

private:
    [[noreturn]] void refuse(const char* reason) const
    {
        throw InputError(fmt::format("{}: path data, character {}: \"{}\": {}", place_,
                                     text_.position() + 1, text_.rest(), reason));
    }

    double number()
    {
        const auto value = text_.number();
        if (!value) {
            refuse("a number is needed here");
        }
        return *value;
    }

    bool flag()
    {
        const auto value = text_.flag();
        if (!value) {
            refuse("a flag of an arc is 0 or 1");
        }
        return *value;
    }

    Vec2d point(bool relative)
    {
        const double x = number();
        const double y = number();
        return relative ? here_ + Vec2d{x, y} : Vec2d{x, y};
    }

    // Draws a Bezier curve from here; its last control points may be given or mirrored.
    void bezier_to(std::vector<Vec2d> points, char kind)
    {
        points.insert(points.begin(), here_);
        control_ = points[points.size() - 2];
        const Vec2d end = points.back();
        double extent = 0;
        for (const Vec2d p : points) {
            extent = std::max(extent, norm(p - here_));
        }
        if (extent > 0) {
            path_.curves.push_back(bezier_curve(points));
        }
        here_ = end;
        last_ = kind;
    }

    // The control point on the other side of here, where a curve of that kind came before.
    Vec2d mirrored(char kind) const { return last_ == kind ? 2 * here_ - control_ : here_; }

    void line_to(Vec2d to)
    {
        if (norm(to - here_) > 0) {
            path_.curves.push_back(line_curve(here_, to));
        }
        here_ = to;
    }

    void arc_to(bool relative)
    {
        const Vec2d radii{number(), number()};
        const double turn = number();
        const bool large = flag();
        const bool positive = flag();
        const Vec2d to = point(relative);
        if (norm(to - here_) > 0) {
            path_.curves.push_back(elliptic_arc(here_, to, radii, turn, large, positive));
        }
        here_ = to;
    }

    void draw(char command)
    {
        const bool relative = command >= 'a';
        const char kind = upper(command);
        if (kind != 'M' && kind != 'Z' && !begun_) {
            begin(here_);  // after a closed subpath the next one starts where that did
        }
        if (kind != 'C' && kind != 'S' && kind != 'Q' && kind != 'T') {
            last_ = '\0';
        }
        switch (kind) {
            case 'M': {
                const Vec2d to = point(relative);
                finish(false);
                begin(to);
                moved_ = true;
                break;
            }
            case 'Z':
                line_to(start_);
                finish(true);
                break;
            case 'L':
                line_to(point(relative));
                break;
            case 'H':
                line_to({number() + (relative ? here_.x : 0), here_.y});
                break;
            case 'V':
                line_to({here_.x, number() + (relative ? here_.y : 0)});
                break;
            case 'A':
                arc_to(relative);
                break;
            default:
                curve(kind, relative);
                break;
        }
    }

    void curve(char kind, bool relative)
    {
        std::vector<Vec2d> points;
        if (kind == 'C' || kind == 'S') {
            points.push_back(kind == 'S' ? mirrored('C') : point(relative));
            points.push_back(point(relative));
        } else if (kind == 'Q' || kind == 'T') {
            points.push_back(kind == 'T' ? mirrored('Q') : point(relative));
        } else {
            throw InputError(fmt::format("{}: path data, character {}: \"{}\" is no command",
                                         place_, text_.position(), named_));
        }
        points.push_back(point(relative));
        bezier_to(std::move(points), kind == 'C' || kind == 'S' ? 'C' : 'Q');
    }

    void begin(Vec2d at)
    {
        here_ = start_ = at;
        begun_ = true;
        last_ = '\0';
    }

    void finish(bool closed)
    {
        if (!path_.curves.empty()) {
            path_.closed = closed;
            paths_.push_back(std::move(path_));
        }
        path_ = {};
        begun_ = false;
        here_ = closed ? start_ : here_;
    }

    SvgText text_;
    const std::string& place_;
    std::vector<DrawingPath> paths_;
    DrawingPath path_;
    Vec2d here_{};
    Vec2d start_{};
    Vec2d control_{};   // the last but one of the curve before
    char last_{'\0'};   // 'C' or 'Q' after a curve of that kind
    char named_{'\0'};  // the command as written
    bool begun_{};      // a subpath
    bool moved_{};      // the first of all
};

}  // namespace

Curve elliptic_arc(Vec2d from, Vec2d to, Vec2d radii, double turn, bool large, bool positive)
{
    radii = {std::abs(radii.x), std::abs(radii.y)};
    if (!(radii.x > 0 && radii.y > 0)) {
        return line_curve(from, to);
    }
    const double c = elementary::cos(turn * kPi / 180);
    const double s = elementary::sin(turn * kPi / 180);
    // The ellipse is the unit circle of a turned and stretched plane.
    const auto into = [&](Vec2d p) {
        return Vec2d{(c * p.x + s * p.y) / radii.x, (c * p.y - s * p.x) / radii.y};
    };
    const Vec2d half = 0.5 * (into(to) - into(from));
    const double reach = norm(half);
    const double grown = std::max(1.0, reach);
    const Vec2d middle = into(from) + half;
    const double away = std::sqrt(std::max(0.0, grown * grown - reach * reach)) *
                        (large != positive ? 1 : -1) / reach;
    const Vec2d centre = middle + away * Vec2d{-half.y, half.x};
    const Vec2d first = into(from) - centre;
    const Vec2d last = into(to) - centre;
    const double start = elementary::atan2(first.y, first.x);
    double sweep = elementary::atan2(last.y, last.x) - start;
    if (positive && sweep <= 0) {
        sweep += 2 * kPi;
    } else if (!positive && sweep >= 0) {
        sweep -= 2 * kPi;
    }
    const PlaneMap out{{radii.x * c, radii.x * s}, {-radii.y * s, radii.y * c}, {0, 0}};
    Curve curve = out.of(arc_curve(centre, grown, start, sweep));
    curve.points.front() = {from.x, from.y, 0};
    curve.points.back() = {to.x, to.y, 0};
    return curve;
}

std::vector<DrawingPath> paths_of_data(std::string_view text, const std::string& place)
{
    return PathReader{text, place}.read();
}

}  // namespace cusp::import
