// Programs for other controllers: their words, their frames, and that rounding stays within its
// bound, judged by a reader of this file's own.
#include "host_tools/geometry/toolpath/post.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <sstream>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "tests/unit/toolpath/straight_moves.hpp"

using namespace cusp;
using namespace cusp::toolpath;

namespace {

PlannedOperation named_operation(std::vector<ToolMove> moves, int tool = 1, std::string name = "")
{
    PlannedOperation planned;
    planned.path.tool = {tool, ToolShape::kBall, 6, 6};
    planned.path.feed = 1200;
    planned.path.plunge_feed = 300;
    planned.path.spindle = 12000;
    planned.path.tool_name = std::move(name);
    planned.path.moves = std::move(moves);
    return planned;
}

std::string posted(const std::vector<PlannedOperation>& operations,
                   const Post& post,
                   bool inch = false,
                   std::optional<double> blend = {})
{
    std::ostringstream out;
    write_program(out, {"cusp job.toml", inch, 5.0, blend, post}, operations);
    return out.str();
}

std::vector<PlannedOperation> two_tools()
{
    return {named_operation({rapid({1, 2, 5}), cut({1, 2, 1})}, 1, "6mm ball"),
            named_operation({rapid({1, 2, 5}), cut({1, 2, 0})}, 2)};
}

// Words of a line without comments, by their letters.
std::map<char, double> words_of(const std::string& line)
{
    std::map<char, double> words;
    std::istringstream in{line.substr(0, line.find_first_of("(;%O"))};
    char letter{};
    double value{};
    while (in >> letter >> value) {
        if (letter != 'G' || value <= 3) {  // G17 G2 keeps the 2
            words[letter] = value;
        }
    }
    return words;
}

// Points of the program's path in the XY plane, close together, and the ends of its moves.
struct Path {
    std::vector<Vec3d> ends;
    std::vector<std::vector<Vec3d>> between;
};

Vec2d centre_of(const std::map<char, double>& words, Vec3d from, Vec3d to, bool clockwise)
{
    if (words.count('R') == 0) {
        const auto offset = [&](char letter) {
            return words.count(letter) != 0 ? words.at(letter) : 0.0;
        };
        return {from.x + offset('I'), from.y + offset('J')};
    }
    const double dx = (to.x - from.x) / 2;
    const double dy = (to.y - from.y) / 2;
    const double half = std::hypot(dx, dy);
    const double h = std::sqrt(std::max(0.0, words.at('R') * words.at('R') - half * half));
    const double side = clockwise ? -1 : 1;
    return {from.x + dx - side * h * dy / half, from.y + dy + side * h * dx / half};
}

Path read_path(const std::string& program)
{
    Path path;
    Vec3d at{};
    std::istringstream lines{program};
    for (std::string line; std::getline(lines, line);) {
        const auto words = words_of(line);
        if (words.count('G') == 0 || words.at('G') > 3) {
            continue;
        }
        Vec3d to = at;
        for (const auto& [letter, value] : words) {
            (letter == 'X'   ? to.x
             : letter == 'Y' ? to.y
             : letter == 'Z' ? to.z
                             : at.z) = letter >= 'X' ? value : at.z;
        }
        std::vector<Vec3d> points;
        if (words.at('G') >= 2) {
            const bool clockwise = words.at('G') == 2;
            const Vec2d c = centre_of(words, at, to, clockwise);
            const double begin = std::atan2(at.y - c.y, at.x - c.x);
            double sweep = std::remainder(std::atan2(to.y - c.y, to.x - c.x) - begin, 2 * kPi);
            if (clockwise ? sweep >= -1e-12 : sweep <= 1e-12) {
                sweep += clockwise ? -2 * kPi : 2 * kPi;
            }
            const double r0 = std::hypot(at.x - c.x, at.y - c.y);
            const double r1 = std::hypot(to.x - c.x, to.y - c.y);
            for (int k = 1; k < 64; ++k) {
                const double t = k / 64.0;
                const double r = r0 + t * (r1 - r0);
                points.push_back({c.x + r * std::cos(begin + t * sweep),
                                  c.y + r * std::sin(begin + t * sweep), at.z + t * (to.z - at.z)});
            }
        }
        path.between.push_back(points);
        path.ends.push_back(to);
        at = to;
    }
    return path;
}

double distance_to_arc(Vec3d p, Vec2d centre, double radius)
{
    return std::abs(std::hypot(p.x - centre.x, p.y - centre.y) - radius);
}

struct RandomArc {
    Vec2d centre;
    double radius;
    double begin;
    double sweep;

    Vec3d at(double t) const
    {
        const double angle = begin + t * sweep;
        return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle), -1};
    }
};

// most  radians, of its sweep; some are tiny, and some nearly full turns where they may be
RandomArc random_arc(std::mt19937& random, double most)
{
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<>{low, high}(random);
    };
    const double radius = std::pow(10.0, between(-2, 3));
    const double tiny = std::pow(10.0, between(-7, -2));
    const double kind = between(0, 1);
    const double size = kind < 0.2 ? tiny : kind < 0.4 ? most - tiny : between(0, most);
    return {{between(-50, 50), between(-50, 50)},
            radius,
            between(-kPi, kPi),
            between(0, 1) < 0.5 ? size : -size};
}

void check_arcs(
    const Post& post, bool inch, unsigned seed, double bound, double most_sweep = 2 * kPi)
{
    std::printf(" seed %u", seed);
    std::mt19937 random{seed};
    const double unit = inch ? 25.4 : 1.0;
    for (int i = 0; i < 2000; ++i) {
        const RandomArc arc = random_arc(random, most_sweep);
        const ArcTo to{arc.at(1), {arc.centre.x, arc.centre.y, 0}, ArcPlane::kXY, arc.sweep < 0};
        const std::string program = posted({named_operation({rapid({arc.at(0).x, arc.at(0).y, 5}),
                                                             {MoveKind::kPlunge, LineTo{arc.at(0)}},
                                                             {MoveKind::kCut, to}})},
                                           post, inch);
        const Path path = read_path(program);
        double most = 0;
        double length = 0;
        Vec3d last{};
        for (std::size_t k = 0; k < path.ends.size(); ++k) {
            for (const Vec3d p : path.between[k]) {
                most = std::max(most, distance_to_arc(unit * p, arc.centre, arc.radius));
                length += norm(unit * p - last);
                last = unit * p;
            }
            if (k >= 3 && k + 1 < path.ends.size()) {  // after the plunge, before the retract
                length += norm(unit * path.ends[k] - last);
            }
            last = unit * path.ends[k];
        }
        CHECK_TEXT(most <= bound, program.c_str());
        // The same way round, the whole of it: no half became a circle, no circle a point.
        const double wanted = arc.radius * std::abs(arc.sweep);
        CHECK_TEXT(length <= 1.01 * wanted + 8 * bound, program.c_str());
        CHECK_TEXT(length >= 0.9 * wanted - 8 * bound, program.c_str());
        const Vec3d end = unit * path.ends[path.ends.size() - 2];  // before the retract
        CHECK_TEXT(norm(Vec3d{end.x - arc.at(1).x, end.y - arc.at(1).y, 0}) <= bound,
                   program.c_str());
    }
}

}  // namespace

TEST_GROUP(Post){};

TEST(Post, FramesOfAFanuc)
{
    Post post;
    post.point = true;
    post.mm_decimals = 3;
    post.line_numbers = 10;
    post.begin = {"%", "O1000"};
    post.modes = {"G17 {units} G90"};
    post.header = {"G5.1 Q1"};
    post.first_tool = {"T{tool} M6 {comment}"};
    post.next_tool = {"M5", "T{tool} M6 {comment}"};
    post.after_tool = {"G0 G43 Z{clearance} H{tool}"};
    post.footer = {"G28 G91 Z0."};
    post.end = {"M30", "%"};
    const std::string expected =
        "%\nO1000\n(cusp job.toml)\nN10 G17 G21 G90\nN20 G61\nN30 G5.1 Q1\n"
        "(tool 1 ball diameter 12 mm)\nN40 T1 M6 (6mm ball)\nN50 M3 S12000\nN60 G0 G43 Z5. H1\nN70 "
        "G0 X1. Y2.\n"
        "N80 G1 Z1. F1200.\nN90 G0 Z5.\nN100 M5\nN110 T2 M6 (tool 2 ball diameter 12 mm)\n"
        "N120 M3 S12000\nN130 G0 G43 Z5. H2\nN140 G0 X1. Y2.\nN150 G1 Z0.\nN160 G0 Z5.\n"
        "N170 G28 G91 Z0.\nN180 M30\n%\n";
    STRCMP_EQUAL(expected.c_str(), posted(two_tools(), post).c_str());
}

TEST(Post, NamesToolsInTheirComments)
{
    STRCMP_CONTAINS("(tool 1 ball diameter 12 mm: 6mm ball)\nT1\n",
                    posted(two_tools(), {}).c_str());
}

TEST(Post, CommentsBehindSemicolonsOrNone)
{
    Post post;
    post.comments = CommentForm::kSemicolon;
    STRCMP_CONTAINS("; cusp job.toml\nG17", posted(two_tools(), post).c_str());
    STRCMP_CONTAINS("; tool 2 ball diameter 12 mm\nT2\n", posted(two_tools(), post).c_str());
    post.comments = CommentForm::kNone;
    post.next_tool = {"T{tool} M6 {comment}"};
    const std::string text = posted(two_tools(), post);
    CHECK(text.find_first_of("(;") == std::string::npos);
    STRCMP_CONTAINS("\nT2 M6\n", text.c_str());
}

TEST(Post, WordsThatItLacksAreNotWritten)
{
    Post post;
    post.exact_path = {};
    post.first_tool = post.next_tool = {"{comment}"};
    const std::string text = posted(two_tools(), post);
    CHECK(text.find("G61") == std::string::npos && text.find("\nT") == std::string::npos);
}

TEST(Post, BlendsWithItsOwnWord)
{
    Post post;
    STRCMP_CONTAINS("\nG64 P0.02\n", posted(two_tools(), post, false, 0.02).c_str());
    post.blend = {"G64"};
    STRCMP_CONTAINS("\nG64\n", posted(two_tools(), post, false, 0.02).c_str());
}

TEST(Post, CoolantAndSpeedFollowTheOperation)
{
    auto operations = two_tools();
    operations[1].path.tool.number = 1;
    operations[1].path.spindle = 8000;
    operations[1].path.tool.coolant = Coolant::kFlood;
    STRCMP_CONTAINS("G1 Z1 F1200\nM3 S8000\nM8\nG0 Z5\nG1 Z0\nG0 Z5\nM9\nM5\nM30\n",
                    posted(operations, {}).c_str());
    operations[0].path.tool.coolant = Coolant::kMist;
    STRCMP_CONTAINS("M3 S12000\nM7\nG0 X1", posted(operations, {}).c_str());
    STRCMP_CONTAINS("M9\nM8\n", posted(operations, {}).c_str());
    operations[1].path.tool.number = 2;
    STRCMP_CONTAINS("G0 Z5\nM9\nM5\n(tool 2", posted(operations, {}).c_str());
}

TEST(Post, LineNumbersBeginAgain)
{
    Post post;
    post.line_numbers = 1000;
    std::vector<ToolMove> moves{rapid({0, 0, 5})};
    for (int i = 1; i <= 120; ++i) {
        moves.push_back(cut({static_cast<double>(i), 0, 5}));
    }
    const std::string text = posted({named_operation(moves)}, post);
    STRCMP_CONTAINS("\nN99000 ", text.c_str());
    CHECK(text.find("N100000") == std::string::npos);
}

TEST(Post, ArcsByRadiusAreQuartersAtMost)
{
    Post post;
    post.arcs = ArcForm::kRadius;
    const std::string text = posted(
        {named_operation({rapid({10, 0, 5}),
                          {MoveKind::kCut, ArcTo{{10, 0, 5}, {0, 0, 0}, ArcPlane::kXY, true}}})},
        post);
    STRCMP_CONTAINS("G2 X0 Y-10 R10 F1200\nG2 X-10 Y0 R10\nG2 X0 Y10 R10\nG2 X10 Y0 R10\n",
                    text.c_str());
}

// The default is not measured: its radii differ by 0.0005 mm at most, and over half a turn the far
// side moves by more. No planner makes such.
TEST(Post, ArcsOfTheDefaultKeepTheirSweep)
{
    check_arcs({}, false, 8, 6e-4, kPi);
    check_arcs({}, true, 9, 6e-4 * 2.54, kPi);
}

TEST(Post, RoundedArcsStayWithinTheirBound)
{
    const auto check = [](const Post& post, bool inch, unsigned seed) {
        check_arcs(post, inch, seed, rounding_of(post, inch));
    };
    Post radius;
    radius.arcs = ArcForm::kRadius;
    check(radius, false, 1);
    check(radius, true, 2);
    Post coarse;
    coarse.mm_decimals = 3;
    coarse.inch_decimals = 4;
    check(coarse, false, 3);
    check(coarse, true, 4);
    coarse.arcs = ArcForm::kRadius;
    check(coarse, false, 5);
    check(coarse, true, 6);
}

TEST(Post, RoundedLinesStayWithinTheirBound)
{
    constexpr unsigned kSeed = 7;
    std::printf(" seed %u", kSeed);
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<> place{-100, 100};
    Post post;
    post.mm_decimals = 3;
    std::vector<ToolMove> moves{rapid({0, 0, 5})};
    for (int i = 0; i < 5000; ++i) {
        moves.push_back(cut({place(random), place(random), place(random)}));
    }
    const Path path = read_path(posted({named_operation(moves)}, post));
    double most = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        most = std::max(most, norm(path.ends[i + 1] - end_of(moves[i])));
    }
    CHECK(most <= rounding_of(post, false));
    CHECK(most > 0);
}
