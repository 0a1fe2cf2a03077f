// The requests of realtime bytes and of the panel.
#include "firmware/machine/realtime_requests.hpp"

namespace cusp::machine {

using protocol::RealtimeCommand;

unsigned request_of(RealtimeCommand command) noexcept
{
    switch (command) {
        case RealtimeCommand::kReset:
            return kRequestReset;
        case RealtimeCommand::kStatusReport:
            return kRequestStatus;
        case RealtimeCommand::kFeedHold:
            return kRequestHold;
        case RealtimeCommand::kCycleStart:
            return kRequestStart;
        case RealtimeCommand::kSafetyDoor:
            return kRequestDoor;
        case RealtimeCommand::kJogCancel:
            return kRequestJogCancel;
        case RealtimeCommand::kSpindleStopToggle:
            return kRequestSpindleStop;
        case RealtimeCommand::kFloodToggle:
        case RealtimeCommand::kMistToggle:
        case RealtimeCommand::kFeedOverrideReset:
        case RealtimeCommand::kFeedOverrideCoarsePlus:
        case RealtimeCommand::kFeedOverrideCoarseMinus:
        case RealtimeCommand::kFeedOverrideFinePlus:
        case RealtimeCommand::kFeedOverrideFineMinus:
        case RealtimeCommand::kRapidOverrideReset:
        case RealtimeCommand::kRapidOverrideMedium:
        case RealtimeCommand::kRapidOverrideLow:
        case RealtimeCommand::kSpindleOverrideReset:
        case RealtimeCommand::kSpindleOverrideCoarsePlus:
        case RealtimeCommand::kSpindleOverrideCoarseMinus:
        case RealtimeCommand::kSpindleOverrideFinePlus:
        case RealtimeCommand::kSpindleOverrideFineMinus:
            break;
    }
    return 0;
}

unsigned requests_of(std::uint16_t inputs) noexcept
{
    unsigned requests = 0;
    requests |= (inputs & kResetButton) != 0 ? unsigned{kRequestReset} : 0U;
    requests |= (inputs & kHoldButton) != 0 ? unsigned{kRequestHold} : 0U;
    requests |= (inputs & kStartButton) != 0 ? unsigned{kRequestStart} : 0U;
    requests |= (inputs & kDoor) != 0 ? unsigned{kRequestDoor} : 0U;
    return requests;
}

}  // namespace cusp::machine
