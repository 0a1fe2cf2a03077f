// Homing and probing with an input shaper: contacts are where they are without one.
#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"
#include "tests/support/property_cases.hpp"

using namespace cusp;

namespace {

constexpr double kPlateHeight = -40.0;  // machine mm
constexpr double kStepLength = 1.0 / 800;
constexpr double kHomingFeed = 120;  // mm/min, at the second touch
constexpr int kShapedMills = 60;

struct AxisShaper {
    unsigned type{0};
    double frequency{30};
    double damping{0};
};

hal::MillGeometry geometry_with_plate()
{
    hal::MillGeometry geometry;
    geometry.plate_above_start = kPlateHeight - geometry.start.z;
    return geometry;
}

machine::Settings settings_of(const PerAxis<AxisShaper>& shapers)
{
    machine::Settings settings;
    CHECK(!settings.put(22, 1));
    CHECK(!settings.put(24, static_cast<float>(kHomingFeed)));
    CHECK(!settings.put(25, 3000));
    CHECK(!settings.put(26, 1));
    for (unsigned i = 0; i < 3; ++i) {
        CHECK(!settings.put(820 + i, static_cast<float>(shapers[i].frequency)));
        CHECK(!settings.put(830 + i, static_cast<float>(shapers[i].damping)));
        CHECK(!settings.put(810 + i, static_cast<float>(shapers[i].type)));
    }
    return settings;
}

// A mill of the same geometry each time, homed.
class HomedMill : public ControllerBench {
public:
    explicit HomedMill(const PerAxis<AxisShaper>& shapers)
        : ControllerBench{geometry_with_plate(), settings_of(shapers)}
    {
        (void)exchange("$X\n");
        CHECK(say("$H\n").find("ALARM") == std::string::npos);
    }
    std::string say(const std::string& text)
    {
        board.byte_link.send(text);
        return finish();
    }
};

// The height in "[PRB:x,y,z:1]".
double probed_height(const std::string& said)
{
    const std::size_t begin = said.find("[PRB:");
    CHECK(begin != std::string::npos && said.find(":1]", begin) != std::string::npos);
    const std::size_t z = said.find(',', said.find(',', begin) + 1) + 1;
    return std::atof(said.c_str() + z);
}

}  // namespace

TEST_GROUP(ShapedContacts){};

TEST(ShapedContacts, HomingAndProbingFindTheSamePlacesWithAnyShaper)
{
    std::mt19937 random{20261124};
    const auto uniform = [&](double least, double most) {
        return std::uniform_real_distribution<double>{least, most}(random);
    };
    const Vec3d plain = HomedMill{{}}.board.mill.place();
    for (int trial = 0; trial < test::property_cases(kShapedMills); ++trial) {
        PerAxis<AxisShaper> shapers{};
        for (unsigned i = 0; i < 3; ++i) {
            shapers[i] = {static_cast<unsigned>(random() % 4), uniform(45, 120), uniform(0, 0.2)};
        }
        HomedMill mill{shapers};
        // Within the travel of a servo tick at the second touch, and a step.
        const Vec3d home = mill.board.mill.place();
        for (unsigned i = 0; i < 3; ++i) {
            DOUBLES_EQUAL(plain[i], home[i], kHomingFeed / 60000 + kStepLength);
        }
        const double feed = uniform(60, 1500);
        const std::string said =
            mill.say("G21G90G53G0X-10Y-20Z-30\nG38.2Z-60F" + std::to_string(feed) + "\n");
        const double tick = feed / 60000;
        DOUBLES_EQUAL(kPlateHeight, probed_height(said), tick + kStepLength);
        // The next move starts where the tool is.
        const Vec3d rest = mill.position();
        const double apart = mill.board.mill.place().z - rest.z;
        mill.board.byte_link.send("G91G1Z7F2000\n");
        double lowest = rest.z;
        do {
            mill.run(1);
            lowest = std::min(lowest, mill.position().z);
        } while (!(mill.app.machine().idle() && mill.board.byte_link.unread() == 0));
        DOUBLES_EQUAL(rest.z, lowest, 1e-6);
        DOUBLES_EQUAL(rest.z + 7, mill.position().z, 1e-6);
        DOUBLES_EQUAL(mill.position().z + apart, mill.board.mill.place().z, kStepLength);
    }
}
