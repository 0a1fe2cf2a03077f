// Steps of one and of ten per cent.
#include "firmware/machine/overrides.hpp"

#include <algorithm>

namespace cusp::machine {
namespace {

constexpr int kFineStep = 1;
constexpr int kCoarseStep = 10;
constexpr int kLeast = 10;
constexpr int kMost = 200;
constexpr unsigned kAsProgrammed = 100;

unsigned stepped(unsigned percent, int step) noexcept
{
    return static_cast<unsigned>(std::clamp(static_cast<int>(percent) + step, kLeast, kMost));
}

}  // namespace

Overrides overridden(Overrides overrides, protocol::RealtimeCommand command) noexcept
{
    using protocol::RealtimeCommand;
    constexpr unsigned kRapidMedium = 50;
    constexpr unsigned kRapidLow = 25;
    switch (command) {
        case RealtimeCommand::kFeedOverrideReset:
            overrides.feed = kAsProgrammed;
            break;
        case RealtimeCommand::kFeedOverrideCoarsePlus:
            overrides.feed = stepped(overrides.feed, kCoarseStep);
            break;
        case RealtimeCommand::kFeedOverrideCoarseMinus:
            overrides.feed = stepped(overrides.feed, -kCoarseStep);
            break;
        case RealtimeCommand::kFeedOverrideFinePlus:
            overrides.feed = stepped(overrides.feed, kFineStep);
            break;
        case RealtimeCommand::kFeedOverrideFineMinus:
            overrides.feed = stepped(overrides.feed, -kFineStep);
            break;
        case RealtimeCommand::kRapidOverrideReset:
            overrides.rapid = kAsProgrammed;
            break;
        case RealtimeCommand::kRapidOverrideMedium:
            overrides.rapid = kRapidMedium;
            break;
        case RealtimeCommand::kRapidOverrideLow:
            overrides.rapid = kRapidLow;
            break;
        case RealtimeCommand::kSpindleOverrideReset:
            overrides.spindle = kAsProgrammed;
            break;
        case RealtimeCommand::kSpindleOverrideCoarsePlus:
            overrides.spindle = stepped(overrides.spindle, kCoarseStep);
            break;
        case RealtimeCommand::kSpindleOverrideCoarseMinus:
            overrides.spindle = stepped(overrides.spindle, -kCoarseStep);
            break;
        case RealtimeCommand::kSpindleOverrideFinePlus:
            overrides.spindle = stepped(overrides.spindle, kFineStep);
            break;
        case RealtimeCommand::kSpindleOverrideFineMinus:
            overrides.spindle = stepped(overrides.spindle, -kFineStep);
            break;
        case RealtimeCommand::kReset:
        case RealtimeCommand::kStatusReport:
        case RealtimeCommand::kFeedHold:
        case RealtimeCommand::kCycleStart:
        case RealtimeCommand::kSafetyDoor:
        case RealtimeCommand::kJogCancel:
        case RealtimeCommand::kSpindleStopToggle:
        case RealtimeCommand::kFloodToggle:
        case RealtimeCommand::kMistToggle:
            break;
    }
    return overrides;
}

}  // namespace cusp::machine
