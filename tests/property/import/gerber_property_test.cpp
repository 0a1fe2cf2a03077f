// Random Gerber files: circles, rectangles, obrounds, polygons, macros, strokes, arcs and regions, dark and clear, in
// blocks and repeats, mirrored, turned and scaled. The oracle asks of each point which objects cover it, by distances.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "host_tools/job/import/gerber_image.hpp"
#include "tests/generators/draw.hpp"
#include "tests/support/property_cases.hpp"

#include "fmt/format.h"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace import;

namespace {

constexpr double kPiOfTest = 3.14159265358979323846;
// How far inside a shape a point is, mm; negative: outside.
using Depth = std::function<double(Vec2d)>;

struct Shape {
    Depth depth;
    bool dark;
};

double depth_in_box(Vec2d p, double width, double height)
{
    return std::min(width / 2 - std::fabs(p.x), height / 2 - std::fabs(p.y));
}

double to_segment(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d way = b - a;
    const double length = dot(way, way);
    const double share =
        length > 0 ? std::fmax(0.0, std::fmin(1.0, dot(p - a, way) / length)) : 0.0;
    return norm(p - (a + way * share));
}

Depth in_polygon(std::vector<Vec2d> corners)
{
    return [corners](Vec2d p) {
        bool inside = false;
        double nearest = 1e9;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Vec2d a = corners[k];
            const Vec2d b = corners[(k + 1) % corners.size()];
            nearest = std::fmin(nearest, to_segment(p, a, b));
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
                inside = !inside;
            }
        }
        return inside ? nearest : -nearest;
    };
}

Depth moved(const Depth& depth, Vec2d by)
{
    return [depth, by](Vec2d p) {
        return depth(p - by);
    };
}

// Mirrored along x, turned, scaled.
Depth changed(const Depth& depth, bool mirror, double turn, double scale)
{
    return [=](Vec2d p) {
        const Vec2d back{(p.x * std::cos(turn) + p.y * std::sin(turn)) / scale,
                         (p.y * std::cos(turn) - p.x * std::sin(turn)) / scale};
        return depth({mirror ? -back.x : back.x, back.y}) * scale;
    };
}

Depth along_arc(Vec2d centre, double radius, double start, double sweep, double pen)
{
    return [=](Vec2d p) {
        const Vec2d out = p - centre;
        double turned = std::atan2(out.y, out.x) - start;
        turned -= 2 * kPiOfTest * std::floor(turned / (2 * kPiOfTest));
        double off = std::fabs(norm(out) - radius);
        if (turned > sweep) {
            const auto end = [&](double angle) {
                return norm(p - centre - Vec2d{std::cos(angle), std::sin(angle)} * radius);
            };
            off = std::fmin(end(start), end(start + sweep));
        }
        return pen - off;
    };
}

class RandomBoard {
public:
    explicit RandomBoard(unsigned seed) : random_{std::mt19937{seed}}
    {
        text =
            "G04 random*\n%FSLAX36Y36*%\n%MOMM*%\n"
            "%AMDONUT*1,1,$1,0,0*1,0,$1x0.5,0,0*%\n"
            "%AMBAR*0 a turned bar*$3=$1+1*21,1,$3,$2,0.2,-0.1,30*%\n"
            "%AMTRI*4,1,3,-0.6,-0.5,0.6,-0.5,0.1,0.7,-0.6,-0.5,$1*%\n"
            "%ADD10C,0.4*%\n%ADD11R,1.2X0.7*%\n%ADD12O,0.6X1.4*%\n%ADD13P,1.5X5X20*%\n%ADD14DONUT,"
            "1.6*%\n"
            "%ADD15BAR,1X0.5*%\n%ADD16TRI,40*%\n%ADD17C,1.1X0.5*%\n";
        const auto disc = [](double r) {
            return [r](Vec2d p) {
                return r - norm(p);
            };
        };
        std::vector<Vec2d> five;
        for (int k = 0; k < 5; ++k) {
            const double angle = (20 + 72 * k) * kPiOfTest / 180;
            five.push_back(Vec2d{std::cos(angle), std::sin(angle)} * 0.75);
        }
        apertures_ = {disc(0.2),
                      [](Vec2d p) { return depth_in_box(p, 1.2, 0.7); },
                      [](Vec2d p) {
                          return 0.3 - to_segment(p, {0, -0.4}, {0, 0.4});
                      },
                      in_polygon(five),
                      [](Vec2d p) { return std::fmin(0.8 - norm(p), norm(p) - 0.4); },
                      changed(
                          [](Vec2d p) {
                              return depth_in_box(p - Vec2d{0.2, -0.1}, 2, 0.5);
                          },
                          false, kPiOfTest / 6, 1),
                      changed(in_polygon({{-0.6, -0.5}, {0.6, -0.5}, {0.1, 0.7}}), false,
                              40 * kPiOfTest / 180, 1),
                      [](Vec2d p) {
                          return std::fmin(0.55 - norm(p), norm(p) - 0.25);
                      }};
        const int objects = 4 + static_cast<int>(random_.uniform(0, 12));
        for (int k = 0; k < objects; ++k) {
            add_object();
        }
        text += "M02*\n";
    }

    std::string text;
    std::vector<Shape> shapes;

private:
    Vec2d place()
    {
        return {std::round(random_.uniform(-3, 3) * 1e4) / 1e4,
                std::round(random_.uniform(-3, 3) * 1e4) / 1e4};
    }
    static std::string xy(Vec2d p, const char* x = "X", const char* y = "Y")
    {
        return fmt::format("{}{}{}{}", x, std::lround(p.x * 1e6), y, std::lround(p.y * 1e6));
    }
    void put(const Depth& depth) { shapes.push_back({depth, dark_}); }

    void add_object()
    {
        if (random_.uniform(0, 1) < 0.35) {
            dark_ = random_.uniform(0, 1) < 0.6;
            text += dark_ ? "%LPD*%\n" : "%LPC*%\n";
        }
        const double kind = random_.uniform(0, 6);
        if (kind < 2) {
            add_flash();
        } else if (kind < 3) {
            const Vec2d a = place();
            const Vec2d b = place();
            text += "D10*\n" + xy(a) + "D02*\nG01" + xy(b) + "D01*\n";
            put([a, b](Vec2d p) { return 0.2 - to_segment(p, a, b); });
        } else if (kind < 4) {
            add_arc();
        } else if (kind < 5) {
            add_region();
        } else if (kind < 5.5) {
            add_repeat();
        } else {
            add_block();
        }
    }

    void add_flash()
    {
        const auto which = static_cast<std::size_t>(random_.uniform(0, 7.99));
        const bool mirror = random_.uniform(0, 1) < 0.3;
        const double turn = random_.uniform(0, 1) < 0.3 ? 35 : 0;
        const double scale = random_.uniform(0, 1) < 0.3 ? 1.5 : 1;
        const Vec2d at = place();
        text += fmt::format("%LM{}*%\n%LR{}*%\n%LS{}*%\nD{}*\n", mirror ? "X" : "N", turn, scale,
                            10 + which) +
                xy(at) + "D03*\n%LMN*%\n%LR0*%\n%LS1*%\n";
        put(moved(changed(apertures_[which], mirror, turn * kPiOfTest / 180, scale), at));
    }

    void add_arc()
    {
        const Vec2d centre = place();
        const double radius = random_.uniform(0.05, 1.5);
        const double start = random_.uniform(0, 6);
        const double sweep = random_.uniform(0.2, 6.2);
        const auto on = [&](double angle) {
            return centre + Vec2d{std::cos(angle), std::sin(angle)} * radius;
        };
        const bool counter_clockwise = random_.uniform(0, 1) < 0.5;
        const Vec2d a = on(counter_clockwise ? start : start + sweep);
        const Vec2d b = on(counter_clockwise ? start + sweep : start);
        text += "D10*\nG75*\n" + xy(a) + "D02*\n" + (counter_clockwise ? "G03" : "G02") + xy(b) +
                xy(centre - a, "I", "J") + "D01*\nG01*\n";
        put(along_arc(centre, radius, start, sweep, 0.2));
    }

    void add_region()
    {
        std::vector<Vec2d> corners;
        const Vec2d middle = place();
        const bool clockwise = random_.uniform(0, 1) < 0.5;
        for (int k = 0; k < 7; ++k) {
            const double angle = (clockwise ? -1 : 1) * 2 * kPiOfTest * k / 7;
            corners.push_back(middle +
                              Vec2d{std::cos(angle), std::sin(angle)} * random_.uniform(0.4, 1.5));
        }
        text += "G36*\n" + xy(corners.front()) + "D02*\nG01*\n";
        for (std::size_t k = 1; k <= corners.size(); ++k) {
            text += xy(corners[k % corners.size()]) + "D01*\n";
        }
        text += "G37*\n";
        put(in_polygon(corners));
    }

    void add_repeat()
    {
        const Vec2d at = place();
        text += "%SRX3Y2I1.3J0.9*%\nD10*\n" + xy(at) + "D03*\n%SR*%\n";
        for (int k = 0; k < 6; ++k) {
            put(moved(apertures_[0], at + Vec2d{1.3 * (k % 3), 0.9 * (k / 3)}));
        }
    }

    // A disc with a bite, flashed: clear flashes swap both.
    void add_block()
    {
        const Vec2d at = place();
        text += fmt::format(
                    "%ABD{}*%\n%LPD*%\nD14*\nX0Y0D03*\n%LPC*%\nD10*\nX400000Y0D03*\n%AB*%\n%LP{}*%"
                    "\nD{}*\n",
                    30, dark_ ? "D" : "C", 30) +
                xy(at) + "D03*\n";
        shapes.push_back({moved(apertures_[4], at), dark_});
        shapes.push_back({moved(apertures_[0], at + Vec2d{0.4, 0}), !dark_});
    }

    Draw random_;
    std::vector<Depth> apertures_;
    bool dark_{true};
};

std::string wrong_board(unsigned seed)
{
    const RandomBoard board{seed};
    const offset::Region2d dark = dark_region(gerber_image("random.gbr", board.text).objects);
    Draw random{std::mt19937{seed + 1000000}};
    for (int k = 0; k < 400; ++k) {
        const Vec2d p{random.uniform(-4, 6), random.uniform(-4, 5)};
        bool wanted = false;
        bool near_border = false;
        for (const Shape& shape : board.shapes) {
            const double depth = shape.depth(p);
            near_border = near_border || std::fabs(depth) < 1e-3;
            wanted = depth > 0 ? shape.dark : wanted;
        }
        if (!near_border && offset::contains(dark, p) != wanted) {
            return fmt::format("seed {}: at x {} y {} it is {}", seed, p.x, p.y,
                               wanted ? "clear" : "dark");
        }
    }
    return {};
}

}  // namespace

TEST_GROUP(RandomGerber){};

TEST(RandomGerber, IsDarkWhereItsObjectsSay)
{
    STRCMP_EQUAL("", broken_cases(property_seed(1), property_cases(300), wrong_board).c_str());
}

}  // namespace cusp::test
