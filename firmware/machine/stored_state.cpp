// Plain bytes and short texts.
#include "firmware/machine/stored_state.hpp"

#include <algorithm>
#include <cstddef>

#include "firmware/base/assert.hpp"

namespace cusp::machine {
namespace {

constexpr std::size_t kRest = offsetof(StoredState, parameters);  // all behind the settings

// The byte at which the rest begins behind so many settings.
constexpr std::size_t rest_behind(std::size_t settings) noexcept
{
    constexpr std::size_t kAlign = alignof(gcode::Parameters);
    return (settings * sizeof(float) + kAlign - 1) / kAlign * kAlign;
}
// Layout of a record without the rotary axis: its positions are of three numbers.
constexpr std::size_t rest_size(std::uint8_t layout) noexcept
{
    const bool lacks_rotary = kHasRotaryAxis && layout < kLayoutWithRotary;
    return sizeof(StoredState) - kRest -
           (lacks_rotary ? gcode::Parameters::kPositions * sizeof(std::int64_t) : 0U);
}
static_assert(sizeof(Settings) == kSettingCount * sizeof(float));
static_assert(rest_behind(kSettingCount) == kRest);

}  // namespace

std::string_view StoredText::view() const noexcept
{
    const auto* const end = std::find(characters.begin(), characters.end() - 1, '\0');
    return {characters.data(), static_cast<std::size_t>(end - characters.begin())};
}

void StoredText::set(std::string_view text) noexcept
{
    CUSP_ASSERT(text.size() <= kStoredTextLength);
    characters.fill('\0');
    std::copy(text.begin(), text.end(), characters.begin());
}

// NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): trivially copyable, read as bytes only.
Span<std::uint8_t> StoredState::bytes() noexcept
{
    return {reinterpret_cast<std::uint8_t*>(this), sizeof(StoredState)};
}

Span<const std::uint8_t> StoredState::bytes() const noexcept
{
    return {reinterpret_cast<const std::uint8_t*>(this), sizeof(StoredState)};
}

// The positions at the begin of the rest get a rotary axis at 0. From the last on.
void widen_positions(std::uint8_t* rest, std::size_t size) noexcept
{
    constexpr std::size_t kThree = sizeof(Vec3<std::int64_t>);
    constexpr std::size_t kAll = gcode::Parameters::kPositions;
    __builtin_memmove(rest + kAll * sizeof(Position), rest + kAll * kThree, size - kAll * kThree);
    for (std::size_t i = kAll; i-- > 0;) {
        __builtin_memmove(rest + i * sizeof(Position), rest + i * kThree, kThree);
        __builtin_memset(rest + i * sizeof(Position) + kThree, 0, sizeof(Position) - kThree);
    }
}

// From the last on: nothing is overwritten before it is read.
void widen(Settings& settings, std::uint8_t layout, const Settings& standard) noexcept
{
    std::uint8_t* const bytes = settings.bytes().begin();
    const auto* const defaults = reinterpret_cast<const std::uint8_t*>(&standard);
    std::size_t held = settings_in_layout(layout);
    for (std::size_t i = kSettingCount; i > 0; --i) {
        const std::size_t place = (i - 1) * sizeof(float);
        const bool is_held = holds(layout, setting_entry(i - 1));
        held -= is_held ? 1U : 0U;
        __builtin_memmove(bytes + place, is_held ? bytes + held * sizeof(float) : defaults + place,
                          sizeof(float));
    }
}

void StoredState::widen(std::uint8_t layout, const Settings& standard) noexcept
{
    std::uint8_t* const all = bytes().begin();
    __builtin_memmove(all + kRest, all + rest_behind(settings_in_layout(layout)),
                      rest_size(layout));
    if (rest_size(layout) != sizeof(StoredState) - kRest) {
        widen_positions(all + kRest, rest_size(layout));
    }
    machine::widen(settings, layout, standard);
}
// NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)

RecordLayout earlier_layout(std::size_t place) noexcept
{
    const auto version = static_cast<std::uint8_t>(kLatestEarlier - place);
    const std::size_t rest = rest_behind(settings_in_layout(version));
    return {version, static_cast<std::uint32_t>(rest + rest_size(version))};
}

EarlierLayouts earlier_layouts() noexcept
{
    EarlierLayouts layouts{};
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        layouts[i] = earlier_layout(i);
    }
    return layouts;
}

}  // namespace cusp::machine
