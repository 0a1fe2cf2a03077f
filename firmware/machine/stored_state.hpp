// StoredState: everything kept over a power cycle, as one record of plain bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "firmware/base/span.hpp"
#include "firmware/gcode/modal_state.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/machine/settings_log.hpp"

namespace cusp::machine {

inline constexpr std::size_t kStoredTextLength = 79;
inline constexpr unsigned kStartupLineCount = 2;

// A short text, ended by 0.
struct StoredText {
    std::array<char, kStoredTextLength + 1> characters{};

    std::string_view view() const noexcept;
    // Precondition: text.size() <= kStoredTextLength.
    void set(std::string_view text) noexcept;
};

struct StoredState {
    Settings settings;
    gcode::Parameters parameters;
    std::array<StoredText, kStartupLineCount> startup;
    StoredText build;

    Span<std::uint8_t> bytes() noexcept;
    Span<const std::uint8_t> bytes() const noexcept;

    // The first bytes() are a record of an earlier layout: what it holds takes its place of today,
    // and the settings that it lacks have those of `standard`.
    void widen(std::uint8_t layout, const Settings& standard) noexcept;
};

static_assert(std::is_trivially_copyable_v<StoredState>);
static_assert(sizeof(StoredState) % 4 == 0, "the store is written in words");

// Layouts that differ from the present one by the settings that they lack, the latest first. The
// first of all had no table of tools either.
inline constexpr std::uint8_t kOldestLayout = 2;
// A build with the rotary axis reads all of those without it.
inline constexpr std::uint8_t kLatestEarlier = kHasRotaryAxis ? kLayoutNumber : kLayoutNumber - 1;
using EarlierLayouts = std::array<RecordLayout, kLatestEarlier - kOldestLayout + 1>;
EarlierLayouts earlier_layouts() noexcept;
// One of them. Precondition: place < the size of EarlierLayouts.
RecordLayout earlier_layout(std::size_t place) noexcept;

// The settings that are the first bytes of a record of an earlier layout, as widen().
void widen(Settings& settings, std::uint8_t layout, const Settings& standard) noexcept;

// The settings of the newest record, unchecked but for their ranges; the defaults where the store was
// never written. Nothing where there is no such record.
template <class Store>
std::optional<Settings> glimpse_settings(Store& store) noexcept
{
    const SettingsLog<Store> log{store};
    const Settings standard;
    if (log.looks_empty()) {
        return standard;
    }
    RecordLayout layout{kSettingsLayout, sizeof(StoredState)};
    for (std::size_t next = 0;; ++next) {
        if (const auto place = log.find_newest(layout)) {
            Settings settings;
            const std::size_t size = settings_in_layout(layout.version) * sizeof(float);
            store.read(place->sector, place->offset, settings.bytes().first(size));
            if (layout.version != kSettingsLayout) {
                widen(settings, layout.version, standard);
            }
            return settings.in_range() ? std::optional<Settings>{settings} : std::nullopt;
        }
        if (next == EarlierLayouts{}.size()) {
            break;
        }
        layout = earlier_layout(next);
    }
    return std::nullopt;
}

// Loads what the store holds into `state`; what it does not hold stays as it is.
template <class Store>
LogState load_state(SettingsLog<Store>& log, StoredState& state) noexcept
{
    const Settings standard = state.settings;
    const EarlierLayouts earlier = earlier_layouts();
    const LogState found =
        log.load(state.bytes(), Span<const RecordLayout>{earlier.data(), earlier.size()});
    if (log.layout() != kSettingsLayout) {
        state.widen(log.layout(), standard);
    }
    return found;
}

}  // namespace cusp::machine
