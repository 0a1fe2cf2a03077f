// Lines are set in the font's units first; then each letter is scaled, turned and moved to its place.
#include "host_tools/job/import/lettering.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/outline_font.hpp"
#include "host_tools/job/import/stroke_font.hpp"
#include "host_tools/job/import/svg_transform.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

struct SetText {
    std::vector<FontLine> lines;
    FontSize size;
};

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines(1);
    for (const char c : text) {
        if (c == '\n') {
            lines.emplace_back();
        } else if (c != '\r') {
            lines.back() += c;
        }
    }
    return lines;
}

SetText set_in_font(const Lettering& lettering, const std::string& place)
{
    std::optional<OutlineFont> font;
    if (!lettering.font_file.empty()) {
        font.emplace(lettering.font_file);
    }
    SetText set{{}, font ? font->size() : stroke_font_size()};
    for (const std::string& line : lines_of(lettering.text)) {
        set.lines.push_back(font ? font->line(line, place) : stroke_line(line, place));
    }
    return set;
}

// Where the point `along` mm behind the anchor and `up` mm over the first baseline lies, and how the letter stands.
class Baseline {
public:
    explicit Baseline(const Lettering& lettering)
        : at_{lettering.at}, angle_{lettering.angle * kPi / 180}, radius_{lettering.arc}
    {
    }

    PlaneMap map(double along, double up) const
    {
        if (radius_ == 0) {
            const PlaneMap turn = turned(angle_);
            return moved_by(at_ + turn.of({along, up})) * turn;
        }
        const PlaneMap turn = turned(angle_ - along / (radius_ + up));
        const Vec2d centre = at_ - turned(angle_).of({0, radius_});
        return moved_by(centre + turn.of({0, radius_ + up})) * turn;
    }

private:
    static PlaneMap turned(double angle)
    {
        const double cosine = elementary::cos(angle);
        const double sine = elementary::sin(angle);
        return {{cosine, sine}, {-sine, cosine}, {0, 0}};
    }

    Vec2d at_;
    double angle_;  // radians
    double radius_;
};

void check_fit(const Lettering& lettering, double width, double up, const std::string& place)
{
    const double radius = lettering.arc + up;
    if (lettering.arc == 0) {
        return;
    }
    if (radius * lettering.arc <= 0) {
        throw InputError(fmt::format(
            "{}: a further line lies {:.4g} mm inside the first, whose circle has a radius of "
            "{:.6g} mm",
            place, -up, lettering.arc));
    }
    if (width > 2 * kPi * std::abs(radius)) {
        throw InputError(
            fmt::format("{}: is {:.6g} mm long, the circle of radius {:.6g} mm only {:.6g} mm",
                        place, width, std::abs(radius), 2 * kPi * std::abs(radius)));
    }
}

}  // namespace

std::vector<DrawingPath> paths_of_text(const Lettering& lettering, const std::string& place)
{
    const SetText set = set_in_font(lettering, place);
    const double scale = lettering.size / set.size.capital;
    const Baseline baseline{lettering};
    std::vector<DrawingPath> out;
    double up = 0;
    for (const FontLine& line : set.lines) {
        const double width = scale * line.width;
        check_fit(lettering, width, up, place);
        const double begin = lettering.align == TextAlign::kLeft     ? 0
                             : lettering.align == TextAlign::kCentre ? -width / 2
                                                                     : -width;
        for (const PlacedLetter& letter : line.letters) {
            const double half = scale * letter.width / 2;
            const PlaneMap map = baseline.map(begin + scale * letter.x + half, up) *
                                 moved_by({-half, 0}) * stretched_by(scale, scale);
            for (DrawingPath path : letter.paths) {
                for (nurbs::Curve& curve : path.curves) {
                    curve = map.of(std::move(curve));
                }
                out.push_back(std::move(path));
            }
        }
        up -= scale * set.size.line;
    }
    if (out.empty()) {
        throw InputError(
            fmt::format("{}: \"{}\" has no letter that is drawn", place, lettering.text));
    }
    return out;
}

}  // namespace cusp::import
