// SettingsLog: keeps one record of bytes in two sectors of flash, so that it survives a power cut
// at any write.
//
// A record is a slot: its bytes, then sequence, size, CRC-32 of those three, and a mark, written in
// this order: without the mark it does not count. The good record of the highest sequence is the
// one in force. Records are appended; when a sector is full the other one is erased, so the newest
// record is never in the sector being erased.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/base/span.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/protocol/crc32.hpp"

namespace cusp::machine {

enum class LogState : std::uint8_t {
    kEmpty,        // never written
    kGood,         // the newest record is in force
    kInterrupted,  // a write was cut short; the record before it is in force
    kDamaged,      // the newest record is spoilt; an older one is in force
    kLost,         // something was written and nothing of it is good
};

// A layout of the record that an earlier version wrote.
struct RecordLayout {
    std::uint8_t version;
    std::uint32_t size;  // of the record, bytes; no more than that of the present one
};

// A Store as hal/contract/board.hpp describes it. Context: main loop, with no frame in flight.
template <class Store>
class SettingsLog {
public:
    explicit SettingsLog(Store& store) noexcept : store_{store} {}

    // Reads the record in force into `record`, and finds the place for the next one. Leaves
    // `record` alone where there is none.
    //
    //   earlier  layouts to try, the latest first, where no record of the present one is good: the
    //            record is then the first bytes of `record`, and layout() says which
    LogState load(Span<std::uint8_t> record, Span<const RecordLayout> earlier = {}) noexcept;

    // The newest record of a layout by its mark alone, with nothing checked: its place. Quick: for the
    // first instructions after a reset.
    struct Place {
        unsigned sector;
        std::uint32_t offset;
    };
    std::optional<Place> find_newest(RecordLayout layout) const noexcept;
    // Nothing is written where the first record would be.
    bool looks_empty() const noexcept;

    // The layout of the record that load() has read.
    std::uint8_t layout() const noexcept { return layout_; }

    // Appends the record. Returns false where that failed: the record before it stays in force.
    // Precondition: load() was called with a record of the same size.
    bool append(Span<const std::uint8_t> record) noexcept;

private:
    struct Trailer {
        std::uint32_t sequence;
        std::uint32_t size;
        std::uint32_t crc;
        std::uint32_t mark;
    };
    // "CUS", and in the last byte the version of the record's layout.
    static constexpr std::uint32_t kMark = 0x43555300;
    static constexpr std::uint32_t kErased = 0xFFFFFFFF;
    static constexpr std::uint32_t kChunk = 64;
    static constexpr unsigned kSectors = 2;

    enum class Slot : std::uint8_t { kErased, kGood, kUnfinished, kSpoilt };

    static RecordLayout present(std::size_t record) noexcept
    {
        return {kSettingsLayout, static_cast<std::uint32_t>(record)};
    }
    static std::uint32_t slot_size(RecordLayout layout) noexcept
    {
        return layout.size + static_cast<std::uint32_t>(sizeof(Trailer));
    }
    std::uint32_t slots(RecordLayout layout) const noexcept
    {
        return store_.sector_size() / slot_size(layout);
    }
    LogState load_layout(RecordLayout layout, Span<std::uint8_t> record, bool& spoilt) noexcept;
    Trailer read_trailer(unsigned sector, std::uint32_t slot, RecordLayout layout) const noexcept;
    Slot inspect(unsigned sector, std::uint32_t slot, RecordLayout layout) const noexcept;
    bool erased(unsigned sector, std::uint32_t slot, RecordLayout layout) const noexcept;
    static void add_word(protocol::Crc32& crc, std::uint32_t word) noexcept;
    bool write_slot(Span<const std::uint8_t> record) noexcept;

    Store& store_;
    unsigned sector_{0};     // being filled
    std::uint32_t next_{0};  // slot in it where the next may go
    // Sector of the record in force; kSectors where there is none. It is never erased.
    unsigned newest_sector_{kSectors};
    std::uint32_t sequence_{0};
    std::uint8_t layout_{kSettingsLayout};
};

template <class Store>
auto SettingsLog<Store>::read_trailer(unsigned sector,
                                      std::uint32_t slot,
                                      RecordLayout layout) const noexcept -> Trailer
{
    std::array<std::uint8_t, sizeof(Trailer)> bytes{};
    store_.read(sector, slot * slot_size(layout) + layout.size, bytes);
    const auto word = [&bytes](std::size_t at) {
        return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8U |
               std::uint32_t{bytes[at + 2]} << 16U | std::uint32_t{bytes[at + 3]} << 24U;
    };
    return {word(0), word(4), word(8), word(12)};
}

template <class Store>
void SettingsLog<Store>::add_word(protocol::Crc32& crc, std::uint32_t word) noexcept
{
    for (unsigned shift = 0; shift < 32; shift += 8) {
        crc.add(static_cast<std::uint8_t>(word >> shift));
    }
}

template <class Store>
bool SettingsLog<Store>::erased(unsigned sector,
                                std::uint32_t slot,
                                RecordLayout layout) const noexcept
{
    std::array<std::uint8_t, kChunk> chunk{};
    const std::uint32_t size = slot_size(layout);
    for (std::uint32_t at = 0; at < size; at += kChunk) {
        const std::uint32_t count = size - at < kChunk ? size - at : kChunk;
        store_.read(sector, slot * size + at, Span<std::uint8_t>{chunk.data(), count});
        for (std::uint32_t i = 0; i < count; ++i) {
            if (chunk[i] != 0xFF) {
                return false;
            }
        }
    }
    return true;
}

template <class Store>
auto SettingsLog<Store>::find_newest(RecordLayout layout) const noexcept -> std::optional<Place>
{
    std::optional<Place> newest;
    std::uint32_t sequence = 0;
    for (unsigned sector = 0; sector < kSectors; ++sector) {
        for (std::uint32_t slot = 0; slot < slots(layout); ++slot) {
            std::array<std::uint8_t, 1> version{};
            const std::uint32_t offset = slot * slot_size(layout);
            // The lowest byte of the mark; the rest only where that is right.
            store_.read(sector, offset + slot_size(layout) - 4, version);
            if (version[0] != layout.version) {
                continue;
            }
            const Trailer trailer = read_trailer(sector, slot, layout);
            if (trailer.mark == (kMark | layout.version) &&
                (!newest || trailer.sequence > sequence)) {
                newest = Place{sector, offset};
                sequence = trailer.sequence;
            }
        }
    }
    return newest;
}

template <class Store>
bool SettingsLog<Store>::looks_empty() const noexcept
{
    for (unsigned sector = 0; sector < kSectors; ++sector) {
        std::array<std::uint8_t, 4> first{};
        store_.read(sector, 0, first);
        for (const std::uint8_t byte : first) {
            if (byte != 0xFF) {
                return false;
            }
        }
    }
    return true;
}

template <class Store>
auto SettingsLog<Store>::inspect(unsigned sector,
                                 std::uint32_t slot,
                                 RecordLayout layout) const noexcept -> Slot
{
    const Trailer trailer = read_trailer(sector, slot, layout);
    if (trailer.mark != (kMark | layout.version)) {
        return erased(sector, slot, layout) ? Slot::kErased : Slot::kUnfinished;
    }
    protocol::Crc32 crc;
    std::array<std::uint8_t, kChunk> chunk{};
    for (std::uint32_t at = 0; at < layout.size; at += kChunk) {
        const auto rest = layout.size - at;
        const std::uint32_t count = rest < kChunk ? rest : kChunk;
        store_.read(sector, slot * slot_size(layout) + at, Span<std::uint8_t>{chunk.data(), count});
        crc.add(Span<const std::uint8_t>{chunk.data(), count});
    }
    add_word(crc, trailer.sequence);
    add_word(crc, trailer.size);
    return trailer.size == layout.size && trailer.crc == crc.value() ? Slot::kGood : Slot::kSpoilt;
}

template <class Store>
LogState SettingsLog<Store>::load(Span<std::uint8_t> record,
                                  Span<const RecordLayout> earlier) noexcept
{
    layout_ = kSettingsLayout;
    bool spoilt = false;
    const LogState state = load_layout(present(record.size()), record, spoilt);
    if (state != LogState::kEmpty && state != LogState::kLost) {
        return state;
    }
    for (const RecordLayout& layout : earlier) {
        bool ignored = false;
        const LogState before = load_layout(layout, record.first(layout.size), ignored);
        if (before != LogState::kEmpty && before != LogState::kLost) {
            layout_ = layout.version;
            // The first place of the present size behind it.
            const std::uint32_t size = slot_size(present(record.size()));
            next_ = (next_ * slot_size(layout) + size - 1) / size;
            return spoilt ? LogState::kDamaged : before;
        }
    }
    return state;
}

template <class Store>
LogState SettingsLog<Store>::load_layout(RecordLayout layout,
                                         Span<std::uint8_t> record,
                                         bool& spoilt) noexcept
{
    bool found = false;
    bool any_unfinished = false;
    bool any_spoilt = false;
    std::uint32_t newest_slot = 0;
    for (unsigned sector = 0; sector < kSectors; ++sector) {
        for (std::uint32_t slot = 0; slot < slots(layout); ++slot) {
            const Slot kind = inspect(sector, slot, layout);
            any_unfinished = any_unfinished || kind == Slot::kUnfinished;
            any_spoilt = any_spoilt || kind == Slot::kSpoilt;
            const std::uint32_t sequence = read_trailer(sector, slot, layout).sequence;
            if (kind == Slot::kGood && (!found || sequence > sequence_)) {
                found = true;
                sequence_ = sequence;
                sector_ = sector;
                newest_sector_ = sector;
                newest_slot = slot;
            }
        }
    }
    spoilt = any_spoilt;
    if (!found) {
        return any_unfinished || any_spoilt ? LogState::kLost : LogState::kEmpty;
    }
    store_.read(sector_, newest_slot * slot_size(layout), record);
    next_ = newest_slot + 1;
    // Old spoilt slots do not matter; one behind the newest good record was newer.
    bool newer_spoilt = false;
    bool newer_unfinished = false;
    const auto look = [&](unsigned sector, std::uint32_t slot) {
        const Slot kind = inspect(sector, slot, layout);
        newer_spoilt = newer_spoilt || kind == Slot::kSpoilt;
        newer_unfinished = newer_unfinished || kind == Slot::kUnfinished;
    };
    for (std::uint32_t slot = next_; slot < slots(layout); ++slot) {
        look(sector_, slot);
    }
    if (next_ == slots(layout)) {
        look(1 - sector_, 0);
    }
    if (newer_spoilt) {
        return LogState::kDamaged;
    }
    return newer_unfinished ? LogState::kInterrupted : LogState::kGood;
}

template <class Store>
bool SettingsLog<Store>::append(Span<const std::uint8_t> record) noexcept
{
    const RecordLayout layout = present(record.size());
    const std::uint32_t count = slots(layout);
    while (next_ < count && !erased(sector_, next_, layout)) {
        ++next_;
    }
    if (next_ >= count) {
        if (newest_sector_ == 1 - sector_ || !store_.erase(1 - sector_)) {
            return false;
        }
        sector_ = 1 - sector_;
        next_ = 0;
    }
    const bool written = write_slot(record);
    // A slot that failed is not tried again; its sector still holds the record in force.
    ++next_;
    return written;
}

template <class Store>
bool SettingsLog<Store>::write_slot(Span<const std::uint8_t> record) noexcept
{
    const std::uint32_t sequence = sequence_ + 1;
    protocol::Crc32 crc;
    crc.add(record);
    add_word(crc, sequence);
    add_word(crc, static_cast<std::uint32_t>(record.size()));
    const std::array<std::uint32_t, 4> words{sequence, static_cast<std::uint32_t>(record.size()),
                                             crc.value(), kMark | kSettingsLayout};
    std::array<std::uint8_t, sizeof(Trailer)> trailer{};
    for (std::size_t i = 0; i < trailer.size(); ++i) {
        trailer[i] = static_cast<std::uint8_t>(words[i / 4] >> 8U * (i % 4));
    }
    const RecordLayout layout = present(record.size());
    const std::uint32_t offset = next_ * slot_size(layout);
    constexpr std::size_t kMarkSize = 4;
    const std::size_t before_mark = trailer.size() - kMarkSize;
    const auto place = static_cast<std::uint32_t>(offset + record.size());
    const bool written =
        store_.write(sector_, offset, record) &&
        store_.write(sector_, place, Span<const std::uint8_t>{trailer.data(), before_mark}) &&
        store_.write(sector_, static_cast<std::uint32_t>(place + before_mark),
                     Span<const std::uint8_t>{trailer.data() + before_mark, kMarkSize}) &&
        inspect(sector_, next_, layout) == Slot::kGood;
    if (written) {
        sequence_ = sequence;
        newest_sector_ = sector_;
    }
    return written;
}

}  // namespace cusp::machine
