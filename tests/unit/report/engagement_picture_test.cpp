// The drawing of each part of a path: the figures are made up.
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/judge/report/colour_scale.hpp"
#include "host_tools/judge/report/report.hpp"

using namespace cusp;
using namespace cusp::report;
using namespace cusp::verify;

TEST_GROUP(EngagementPicture)
{
    Verification result;
    const job::Job job{};

    // Along x, a step of 1 mm for each angle.
    void setup() override
    {
        result.grid = {0, 0, 1, 10, 10, true};
        ToolPositions run;
        run.tool.shape = toolpath::ToolShape::kFlat;
        run.tool.radius = 3;
        EngagementRun found;
        const auto add = [&](StepKind kind, float angle) {
            run.tips.push_back({static_cast<double>(run.tips.size()), 5, -1});
            found.kinds.push_back(kind);
            found.angles.push_back(angle);
        };
        add(StepKind::kRapid, 0);
        add(StepKind::kEntry, 0);
        add(StepKind::kCut, 30);
        add(StepKind::kCut, 62);
        add(StepKind::kCut, 180);
        add(StepKind::kAir, 0);
        result.positions = {run};
        result.engagement = {found};
        result.figures.engagement.emplace();
    }
    std::string picture() const { return engagement_picture(job, result); }
    bool draws(const std::string& stroke, const std::string& path) const
    {
        const std::string text = picture();
        const std::size_t found = text.find("d=\"" + path + "\"");
        if (found == std::string::npos) {
            return false;
        }
        const std::size_t tag = text.rfind('<', found);
        return text.substr(tag, found - tag).find("stroke=\"" + stroke + "\"") != std::string::npos;
    }
};

TEST(EngagementPicture, ColoursCutsOnTheScaleOfHalfATurn)
{
    const auto colour = [](double angle) {
        return colour_of_step(step_of(angle, 0, 180));
    };
    CHECK(draws(colour(30), "M1.00,4.00L2.00,4.00"));
    CHECK(draws(colour(62), "M2.00,4.00L3.00,4.00"));
    CHECK(draws(colour(180), "M3.00,4.00L4.00,4.00"));
    CHECK(draws("#b0b0b0", "M4.00,4.00L5.00,4.00"));
    CHECK(draws("black", "M0.00,4.00L1.00,4.00"));
    CHECK(picture().find(">180</text>") != std::string::npos);
    CHECK(picture().find("#d7191c") == std::string::npos);
}

TEST(EngagementPicture, MarksTheLimitAndWhatIsOverIt)
{
    result.figures.engagement->limit = 60;
    result.figures.engagement->over_length = 1;
    result.engagement.front().counts_over = 65;
    CHECK(draws("#d7191c", "M3.00,4.00L4.00,4.00"));
    CHECK_FALSE(draws("#d7191c", "M2.00,4.00L3.00,4.00"));
    CHECK(picture().find(">over 60°</text>") != std::string::npos);
}
