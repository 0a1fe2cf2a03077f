// The engagement of paths for which it is known: straight cuts, slots, air, circles in a disc, and
// entries. Then random paths against a finer raster of one thread, cut disc by disc.
#include "host_tools/judge/verify/engagement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "tests/support/leaks_on_threads.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::verify;

namespace {

// The stock is 60 mm x 40 mm, its top at 0.
const std::string kSheet = R"({"shape": {"type": "surface", "count": 1, "data": [
    {"degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2, "knotvector_u": [0, 0, 1, 1],
     "knotvector_v": [0, 0, 1, 1], "control_points": {"points":
     [[0, 0, -5], [0, 40, -5], [60, 0, -5], [60, 40, -5]]}}]}})";

const std::string kFlatJob = R"(
[tool]
shape = "flat"
diameter = 6
[cutting]
feed = 1000
[[operation]]
strategy = "parallel_planes"
floor = "sheet.json"
step_over = 1
)";

constexpr double kRadius = 3;
constexpr double kPitch = 0.173;
constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kAccuracy = 0.7;   // pitches of a width
constexpr double kMeanError = 0.3;  // degrees, of the mean over a cut of many pitches

double width_of(double degrees) { return kRadius * (1 - std::cos(degrees * kDegree)); }
double angle_of(double width) { return std::acos(1 - width / kRadius) / kDegree; }

template <class... Numbers>
std::string words(const char* format, Numbers... numbers)
{
    char line[160];
    std::snprintf(line, sizeof line, format, numbers...);
    return line;
}

const std::string kHead = "G21 G90 F1000\nG0 Z5\n";

}  // namespace

TEST_GROUP(Engagement)
{
    cusp::test::TemporaryFolder folder;
    VerifySettings settings;
    Verification result;

    void setup() override { settings.engagement = true; }

    const EngagementFigures& figures(const std::string& program)
    {
        folder.with("sheet.json", kSheet);
        const job::Job job = read_job(folder.with("job.toml", kFlatJob), cusp::strategies::all());
        result = verify::verify(job, folder.with("p.ngc", kHead + program + "G0 Z5\nM30\n"),
                                settings, [](double) {});
        return *result.figures.engagement;
    }

    // Engagement of the cuts at these lines of the program (from 1), farther than 10 mm from both
    // their ends.
    void expect_width(int line, double width)
    {
        const ToolPositions& run = result.positions.front();
        const EngagementRun& found = result.engagement.front();
        double sum = 0;
        double count = 0;
        const auto of_line = [&](std::size_t k) {
            return static_cast<int>(run.lines[k]) == line;
        };
        for (std::size_t k = 101; k + 100 < run.tips.size(); ++k) {
            if (of_line(k - 101) && of_line(k + 100)) {
                CHECK(found.kinds[k] == StepKind::kCut);
                const auto angle = static_cast<double>(found.angles[k]);
                DOUBLES_EQUAL(width, width_of(angle), kAccuracy * kPitch);
                sum += angle;
                ++count;
            }
        }
        CHECK(count > 40);
        DOUBLES_EQUAL(angle_of(width), sum / count, kMeanError);
    }
};

TEST(Engagement, OfStraightCutsIsTheArcCosineOfTheirWidth)
{
    std::string program =
        "G0 X-5 Y5\nG1 Z-2\nG1 X65\nG1 Y6.5\nG1 X-5\nG1 Y6.8\nG1 X65\nG1 Y9.8\n"
        "G1 X-5\nG1 Y13.4\nG1 X65\n";
    figures(program);
    for (const auto& [line, width] :
         std::initializer_list<std::pair<int, double>>{{7, 1.5}, {9, 0.3}, {11, 3.0}, {13, 3.6}}) {
        expect_width(line, width);
    }
}

// Beside slots in random directions.
TEST(Engagement, OfSlantedCutsIsThatOfStraightOnes)
{
    std::mt19937 random{601};
    for (int n = 0; n < 6; ++n) {
        const double turn = std::uniform_real_distribution<double>{0, 360}(random)*kDegree;
        const double width = std::uniform_real_distribution<double>{0.3, 5.7}(random);
        const Vec2d along{16 * std::cos(turn), 16 * std::sin(turn)};
        const Vec2d aside{-width * std::sin(turn), width * std::cos(turn)};
        const auto pass = [&](Vec2d by) {
            return words("G0 X%.5f Y%.5f\nG1 Z-2\nG1 X%.5f Y%.5f\nG0 Z5\n", 30 + by.x - along.x,
                         20 + by.y - along.y, 30 + by.x + along.x, 20 + by.y + along.y);
        };
        figures(pass({}) + pass(aside));
        expect_width(9, width);
    }
}

// Such as roughing by one tool and a finish by another.
TEST(Engagement, IsHeldAgainstTheLimitForToolsThatHaveOne)
{
    const auto add = [](int number, std::optional<double> limit, float angle,
                        EngagementFigures& to) {
        cusp::verify::ToolPositions run;
        run.tool.number = number;
        run.tool.radius = 3;
        run.tips = {{0, 0, 0}, {1, 0, 0}};
        run.rapid = {true, false};
        run.lines = {1, 2};
        EngagementRun found{{StepKind::kRapid, StepKind::kCut}, {0, angle}};
        cusp::verify::set_limit(run.tool, limit, 0.01, found);
        cusp::verify::add_engagement(run, limit, found, to);
    };
    EngagementFigures sum;
    add(1, 60, 58, sum);
    add(2, std::nullopt, 95, sum);
    DOUBLES_EQUAL(95, sum.angle_max, 1e-4);
    DOUBLES_EQUAL(58, *sum.limited_max, 1e-4);
    DOUBLES_EQUAL(0, *sum.over_length, 0);
    add(1, 60, 70, sum);
    DOUBLES_EQUAL(70, *sum.limited_max, 1e-4);
    DOUBLES_EQUAL(1, *sum.over_length, 1e-9);
}

TEST(Engagement, OfASlotIsHalfATurn)
{
    const EngagementFigures& found = figures("G0 X-5 Y20\nG1 Z-2\nG1 X65\n");
    DOUBLES_EQUAL(180, found.angle_max, 1e-3);
    LONGS_EQUAL(5, found.line);
    DOUBLES_EQUAL(20, found.place.y, 1e-9);
    CHECK(found.place.x > -1 && found.place.x < 60);
    // the air before the sheet and behind it; the first and last slivers slip through the grid
    DOUBLES_EQUAL(7 + (5 - kRadius) + 5, found.air_length, 6 * kPitch);
}

TEST(Engagement, OfAPassThatWasCutBeforeIsAir)
{
    const EngagementFigures& found =
        figures("G0 X-5 Y20\nG1 Z-2\nG1 X65\nG1 X-5\nG1 Z-1\nG1 X65\n");
    const double first = 7 + (5 - kRadius) + 5;
    DOUBLES_EQUAL(first + 70 + 1 + 70, found.air_length, 6 * kPitch);
}

namespace {

// From the disc's middle.
std::string circle(double radius)
{
    return words("G1 X%.4f Y20\nG3 X%.4f Y20 I%.4f\n", 30 + radius, 30 + radius, -radius);
}

}  // namespace

// A disc of radius C is cleared. On a circle of radius c in it the places of the tool's front half
// that lie outside the disc are those up to the angle a from the outward normal:
// c^2 + R^2 + 2 c R cos a = C^2.
TEST(Engagement, InACircleWidenedByACircleIsThatOfTwoCircles)
{
    std::string program = "G0 X30 Y20\nG1 Z-2\n";
    const double opened = 5;
    for (double c = 0.5; c <= opened; c += 0.5) {
        program += circle(c);
    }
    const double c = 6;
    figures(program + circle(c));
    const double disc = opened + kRadius;
    const double known =
        std::acos((disc * disc - c * c - kRadius * kRadius) / (2 * c * kRadius)) / kDegree;
    const ToolPositions& run = result.positions.front();
    double sum = 0;
    double count = 0;
    for (std::size_t k = 0; k + 1 < run.tips.size(); ++k) {
        const Vec2d p{run.tips[k].x - 30, run.tips[k].y - 20};
        const bool away_from_begin = p.x < 0;
        if (run.lines[k] == 26 && away_from_begin) {
            const auto angle = static_cast<double>(result.engagement.front().angles[k]);
            DOUBLES_EQUAL(width_of(known), width_of(angle), kPitch);
            sum += angle;
            ++count;
        }
    }
    CHECK(count > 100);
    // walls bent by the disc instead of straight ones: within a tenth of a pitch over the radius
    DOUBLES_EQUAL(known, sum / count, 1.5);
}

TEST(Engagement, LeavesOutEntriesAndCountsTheRest)
{
    // a plunge, a ramp of 2 mm down in 20 mm, and the way back along it
    settings.max_engagement = 60;
    const EngagementFigures& plunge = figures("G0 X10 Y10\nG1 Z-4\nG0 Z5\n");
    DOUBLES_EQUAL(0, plunge.angle_max, 0);
    DOUBLES_EQUAL(0, *plunge.over_length, 0);
    DOUBLES_EQUAL(5, plunge.air_length, 0.2);
    DOUBLES_EQUAL(kRadius * kRadius * 3.14159 * 4, plunge.removed_volume, 2);
    LONGS_EQUAL(0, plunge.line);
    const EngagementFigures& ramp = figures("G0 X10 Y10 Z0\nG1 X30 Z-2\n");
    DOUBLES_EQUAL(0, *ramp.over_length, 0);
    DOUBLES_EQUAL(0, ramp.angle_max, 0);
    const EngagementFigures& level = figures("G0 X10 Y10 Z0\nG1 X30 Z-2\nG1 X10\n");
    // the ramp's floor is over the way back, all along
    DOUBLES_EQUAL(20, *level.over_length, 0.5);
    // a turn about the foot, near it and not so near
    const std::string foot = "G0 X10 Y10\nG1 Z-2\nG1 X";
    DOUBLES_EQUAL(0, *figures(foot + "10.14\nG3 X10.14 I-0.14\n").over_length, 0);
    CHECK(*figures(foot + "10.5\nG3 X10.5 I-0.5\n").over_length > 1.0);
}

TEST(Engagement, IsOverTheLimitByMoreThanAShareAndTheGrid)
{
    const std::string slot = "G0 X-5 Y5\nG1 Z-2\nG1 X65\nG0 Z5\nG0 X-5 Y6.5\nG1 Z-2\nG1 X65\n";
    CHECK_FALSE(figures(slot).over_length.has_value());
    CHECK_FALSE(result.figures.engagement->limit.has_value());
    settings.max_engagement = 60;  // that of the second pass: of the slot's way 66 mm are in stock
    DOUBLES_EQUAL(63, *figures(slot).over_length, 4);
    DOUBLES_EQUAL(60, *result.figures.engagement->limit, 0);
    settings.max_engagement = 50;
    DOUBLES_EQUAL(63 + 63, *figures(slot).over_length, 8);
}

TEST(Engagement, LimitIsThatOfTheToolsOperations)
{
    job::Job job;
    job::Operation wide;
    wide.tool.number = 1;
    wide.passes.max_engagement = 90;
    job::Operation narrow = wide;
    narrow.passes.max_engagement = 45;
    job::Operation other;
    other.tool.number = 2;
    job.operations = {wide, narrow, other};
    DOUBLES_EQUAL(45, *engagement_limit(job, wide.tool, {}), 0);
    CHECK_FALSE(engagement_limit(job, other.tool, {}).has_value());
    DOUBLES_EQUAL(70, *engagement_limit(job, wide.tool, 70.0), 0);
    DOUBLES_EQUAL(70, *engagement_limit(job, other.tool, 70.0), 0);
}

// 60 mm at 1000 mm/min; 30 mm in x at 100 mm/s beside 20 mm in z at 50 mm/s.
TEST(Engagement, TimeIsThatOfFeedAndRapidRates)
{
    folder.with("p.ngc", "G21 G90 F1000\nG0 X0 Y0 Z20\nG1 X60\nG0 X30 Z40\nM30\n");
    DOUBLES_EQUAL(3.6 + 0.4, programmed_seconds(read_program({}, folder.file("p.ngc"), 1000)),
                  1e-6);
}

namespace {

// Stock as cells in rows and columns, cut disc by disc.
class PlainRaster {
public:
    static constexpr double kCell = 0.04;

    PlainRaster() : stock_(kColumns * kRows, true) {}

    // Degrees of the front half circle, a cell outside the tool, that are in stock.
    double engagement(Vec2d at, double heading) const
    {
        int found = 0;
        for (int degree = -90; degree < 90; ++degree) {
            const double angle = heading + (degree + 0.5) * kDegree;
            const double out = kRadius + kCell;
            const int i = cell(at.x + out * std::cos(angle));
            const int j = cell(at.y + out * std::sin(angle));
            const bool inside = i >= 0 && i < kColumns && j >= 0 && j < kRows;
            found += inside && stock_[static_cast<std::size_t>(i * kRows + j)] ? 1 : 0;
        }
        return found;
    }
    // True if any stock was there.
    bool cut(Vec2d at)
    {
        bool any = false;
        for (int i = std::max(0, cell(at.x - kRadius)); i < kColumns; ++i) {
            const double dx = (i + 0.5) * kCell - at.x;
            if (dx > kRadius) {
                break;
            }
            const double half = std::sqrt(std::max(0.0, kRadius * kRadius - dx * dx));
            const int high = std::min(kRows - 1, cell(at.y + half - kCell / 2));
            for (int j = std::max(0, cell(at.y - half + kCell / 2)); j <= high; ++j) {
                const auto k = static_cast<std::size_t>(i * kRows + j);
                any = any || stock_[k];
                stock_[k] = false;
            }
        }
        return any;
    }

private:
    static constexpr int kColumns = 1500;
    static constexpr int kRows = 1000;
    static int cell(double mm) { return static_cast<int>(std::floor(mm / kCell)); }
    std::vector<bool> stock_;
};

// Level moves in and beside the sheet.
std::string random_way(std::mt19937& random)
{
    const auto within = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(random);
    };
    // Drawn one by one: arguments of a call have no order.
    const double first_x = within(0, 60);
    std::string program = words("G0 X%.3f Y%.3f\nG1 Z-2\n", first_x, within(0, 40));
    for (int n = 0; n < 12; ++n) {
        const double x = within(-2, 62);
        program += words("G1 X%.3f Y%.3f\n", x, within(-2, 42));
    }
    return program;
}

}  // namespace

// Both look at one place of the tool; where the load changes within the reach of the mean they
// differ. Most of the way has to agree, and all sums. The limits guard what was measured on 50 such
// paths, the worst of each: 84 % of it within a pitch of width, the mean off by 1.7 degrees, the
// way over the limit by 3.5 % of all and air by 7 %.
TEST(Engagement, OfRandomPathsIsThatOfAFinerRaster)
{
    std::mt19937 random{20261123};
    settings.max_engagement = 60;
    for (int path = 0; path < 2; ++path) {
        const EngagementFigures& found = figures(random_way(random));
        const ToolPositions& run = result.positions.front();
        PlainRaster raster;
        double way = 0;
        double agreed = 0;
        double signed_sum = 0;
        double over = 0;
        double air = 0;
        raster.cut({run.tips[1].x, run.tips[1].y});
        for (std::size_t k = 2; k < run.tips.size(); ++k) {
            const Vec3d step = run.tips[k] - run.tips[k - 1];
            const double length = norm(step);
            const Vec2d at{run.tips[k - 1].x, run.tips[k - 1].y};
            if (run.rapid[k] || run.tips[k].z > -1.9) {
                air += run.rapid[k] ? 0 : length;
                continue;
            }
            const double known = raster.engagement(at, std::atan2(step.y, step.x));
            const bool cuts = raster.cut({run.tips[k].x, run.tips[k].y});
            air += cuts ? 0 : length;
            if (cuts) {
                const auto angle = static_cast<double>(result.engagement.front().angles[k]);
                way += length;
                agreed += std::abs(width_of(angle) - width_of(known)) < kPitch ? length : 0;
                signed_sum += length * (angle - known);
                over += known > 63 ? length : 0;
            }
        }
        CHECK(agreed / way > 0.8);
        DOUBLES_EQUAL(0, signed_sum / way, 2);
        DOUBLES_EQUAL(over, *found.over_length, 0.04 * way);
        DOUBLES_EQUAL(air, found.air_length, 0.08 * way);
    }
}
