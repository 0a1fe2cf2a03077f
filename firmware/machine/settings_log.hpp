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

#include "firmware/base/span.hpp"
#include "firmware/protocol/crc32.hpp"

namespace cusp::machine {

enum class LogState : std::uint8_t {
    kEmpty,        // never written
    kGood,         // the newest record is in force
    kInterrupted,  // a write was cut short; the record before it is in force
    kDamaged,      // the newest record is spoilt; an older one is in force
    kLost,         // something was written and nothing of it is good
};

// A Store as hal/contract/board.hpp describes it. Context: main loop, with no frame in flight.
template <class Store>
class SettingsLog {
public:
    explicit SettingsLog(Store& store) noexcept : store_{store} {}

    // Reads the record in force into `record`, and finds the place for the next one. Leaves
    // `record` alone where there is none.
    LogState load(Span<std::uint8_t> record) noexcept;

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
    // "CUS" and the version of the record's layout: another one's records do not count.
    static constexpr std::uint32_t kMark = 0x43555305;
    static constexpr std::uint32_t kErased = 0xFFFFFFFF;
    static constexpr std::uint32_t kChunk = 64;
    static constexpr unsigned kSectors = 2;

    enum class Slot : std::uint8_t { kErased, kGood, kUnfinished, kSpoilt };

    std::uint32_t slot_size(std::size_t record) const noexcept
    {
        return static_cast<std::uint32_t>(record + sizeof(Trailer));
    }
    std::uint32_t slots(std::size_t record) const noexcept
    {
        return store_.sector_size() / slot_size(record);
    }
    Trailer read_trailer(unsigned sector, std::uint32_t slot, std::size_t record) const noexcept;
    Slot inspect(unsigned sector, std::uint32_t slot, std::size_t record) const noexcept;
    bool erased(unsigned sector, std::uint32_t slot, std::size_t record) const noexcept;
    static void add_word(protocol::Crc32& crc, std::uint32_t word) noexcept;
    bool write_slot(Span<const std::uint8_t> record) noexcept;

    Store& store_;
    unsigned sector_{0};     // being filled
    std::uint32_t next_{0};  // slot in it where the next may go
    // Sector of the record in force; kSectors where there is none. It is never erased.
    unsigned newest_sector_{kSectors};
    std::uint32_t sequence_{0};
};

template <class Store>
auto SettingsLog<Store>::read_trailer(unsigned sector,
                                      std::uint32_t slot,
                                      std::size_t record) const noexcept -> Trailer
{
    std::array<std::uint8_t, sizeof(Trailer)> bytes{};
    store_.read(sector, slot * slot_size(record) + static_cast<std::uint32_t>(record), bytes);
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
                                std::size_t record) const noexcept
{
    std::array<std::uint8_t, kChunk> chunk{};
    const std::uint32_t size = slot_size(record);
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
auto SettingsLog<Store>::inspect(unsigned sector,
                                 std::uint32_t slot,
                                 std::size_t record) const noexcept -> Slot
{
    const Trailer trailer = read_trailer(sector, slot, record);
    if (trailer.mark != kMark) {
        return erased(sector, slot, record) ? Slot::kErased : Slot::kUnfinished;
    }
    protocol::Crc32 crc;
    std::array<std::uint8_t, kChunk> chunk{};
    for (std::uint32_t at = 0; at < record; at += kChunk) {
        const auto rest = static_cast<std::uint32_t>(record) - at;
        const std::uint32_t count = rest < kChunk ? rest : kChunk;
        store_.read(sector, slot * slot_size(record) + at, Span<std::uint8_t>{chunk.data(), count});
        crc.add(Span<const std::uint8_t>{chunk.data(), count});
    }
    add_word(crc, trailer.sequence);
    add_word(crc, trailer.size);
    return trailer.size == record && trailer.crc == crc.value() ? Slot::kGood : Slot::kSpoilt;
}

template <class Store>
LogState SettingsLog<Store>::load(Span<std::uint8_t> record) noexcept
{
    bool found = false;
    bool any_unfinished = false;
    bool any_spoilt = false;
    std::uint32_t newest_slot = 0;
    for (unsigned sector = 0; sector < kSectors; ++sector) {
        for (std::uint32_t slot = 0; slot < slots(record.size()); ++slot) {
            const Slot kind = inspect(sector, slot, record.size());
            any_unfinished = any_unfinished || kind == Slot::kUnfinished;
            any_spoilt = any_spoilt || kind == Slot::kSpoilt;
            const std::uint32_t sequence = read_trailer(sector, slot, record.size()).sequence;
            if (kind == Slot::kGood && (!found || sequence > sequence_)) {
                found = true;
                sequence_ = sequence;
                sector_ = sector;
                newest_sector_ = sector;
                newest_slot = slot;
            }
        }
    }
    if (!found) {
        return any_unfinished || any_spoilt ? LogState::kLost : LogState::kEmpty;
    }
    store_.read(sector_, newest_slot * slot_size(record.size()), record);
    next_ = newest_slot + 1;
    // Old spoilt slots do not matter; one behind the newest good record was newer.
    bool newer_spoilt = false;
    bool newer_unfinished = false;
    const auto look = [&](unsigned sector, std::uint32_t slot) {
        const Slot kind = inspect(sector, slot, record.size());
        newer_spoilt = newer_spoilt || kind == Slot::kSpoilt;
        newer_unfinished = newer_unfinished || kind == Slot::kUnfinished;
    };
    for (std::uint32_t slot = next_; slot < slots(record.size()); ++slot) {
        look(sector_, slot);
    }
    if (next_ == slots(record.size())) {
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
    const std::uint32_t count = slots(record.size());
    while (next_ < count && !erased(sector_, next_, record.size())) {
        ++next_;
    }
    if (next_ == count) {
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
                                             crc.value(), kMark};
    std::array<std::uint8_t, sizeof(Trailer)> trailer{};
    for (std::size_t i = 0; i < trailer.size(); ++i) {
        trailer[i] = static_cast<std::uint8_t>(words[i / 4] >> 8U * (i % 4));
    }
    const std::uint32_t offset = next_ * slot_size(record.size());
    constexpr std::size_t kMarkSize = 4;
    const std::size_t before_mark = trailer.size() - kMarkSize;
    const auto place = static_cast<std::uint32_t>(offset + record.size());
    const bool written =
        store_.write(sector_, offset, record) &&
        store_.write(sector_, place, Span<const std::uint8_t>{trailer.data(), before_mark}) &&
        store_.write(sector_, static_cast<std::uint32_t>(place + before_mark),
                     Span<const std::uint8_t>{trailer.data() + before_mark, kMarkSize}) &&
        inspect(sector_, next_, record.size()) == Slot::kGood;
    if (written) {
        sequence_ = sequence;
        newest_sector_ = sector_;
    }
    return written;
}

}  // namespace cusp::machine
