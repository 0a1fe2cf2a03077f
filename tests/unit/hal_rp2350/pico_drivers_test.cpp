// Clocks, serial line, settings and spindle's pulses of the RP2350 against a model of the registers.
#include <array>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "hal/rp2350/chip_clocks.hpp"
#include "hal/rp2350/chip_reset.hpp"
#include "hal/rp2350/chip_watchdog.hpp"
#include "hal/rp2350/pwm_pulses.hpp"
#include "hal/rp2350/rom_settings.hpp"
#include "hal/rp2350/uart_link.hpp"
#include "tests/unit/hal_rp2350/pico_model.hpp"

using namespace cusp::hal::rp2350;
using cusp::test::PicoChip;
using cusp::test::PicoModel;

TEST_GROUP(PicoClocks) { PicoModel chip; };

TEST(PicoClocks, RunFromTheCrystal)
{
    CHECK_FALSE(clocks_run<PicoChip>());
    CHECK_TRUE(start_clocks<PicoChip>());
    CHECK_TRUE(clocks_run<PicoChip>());
    LONGS_EQUAL(4, chip.clocks.ref.selected.value);
    LONGS_EQUAL(2, chip.clocks.sys.selected.value);
    LONGS_EQUAL(125, chip.core_multiplier.fbdiv.value);
    LONGS_EQUAL(5U << 16U | 2U << 12U, chip.core_multiplier.prim.value);
    LONGS_EQUAL(12, chip.ticks.watchdog.cycles.value);
    LONGS_EQUAL(0, chip.violations);
}

TEST(PicoClocks, SayThatTheCrystalOrAMultiplierDoesNotStart)
{
    chip.crystal_works = false;
    CHECK_FALSE(start_clocks<PicoChip>());
    chip.crystal_works = true;
    CHECK_FALSE(clocks_run<PicoChip>());
    chip.multipliers_work = false;
    CHECK_FALSE(start_clocks<PicoChip>());
    CHECK_FALSE(clocks_run<PicoChip>());
    LONGS_EQUAL(0, chip.violations);
}

TEST(PicoClocks, StartAgainWhereABootLoaderHasStartedThem)
{
    CHECK_TRUE(start_clocks<PicoChip>());
    CHECK_TRUE(start_clocks<PicoChip>());
    LONGS_EQUAL(0, chip.violations);
}

// Of the target's fault.cpp.
namespace cusp::hal::cortex_m {
FaultRecord last_fault;
ResetRecord last_reset;
}  // namespace cusp::hal::cortex_m

TEST_GROUP(PicoReset)
{
    PicoModel chip;

    // A start, with the records that are in memory.
    void restart(std::uint32_t by_watchdog)
    {
        chip.watchdog.reason.value = by_watchdog;
        last_reset.motion = ResetRecord::kMoving;
        last_fault.mark = FaultRecord::kWritten;
        note_reset_cause<PicoChip>();
    }
};

TEST(PicoReset, KeepsTheRecordsOverOurWatchdog)
{
    chip.power.chip_reset.value = 1U << 16U;
    start_watchdog<PicoChip>();
    LONGS_EQUAL(3000000, chip.watchdog.load.value);
    LONGS_EQUAL(0x01FFFFF3, chip.power_sequence.wdsel.value);
    restart(1);
    CHECK_TRUE(reset_amid_motion());
    LONGS_EQUAL(1, last_reset.cause);
    CHECK_TRUE(last_fault.mark == FaultRecord::kWritten);
}

TEST(PicoReset, TakesTheBootRomsWatchdogForAPowerUp)
{
    restart(1);
    CHECK_FALSE(reset_amid_motion());
    CHECK_FALSE(last_fault.mark == FaultRecord::kWritten);
    start_watchdog<PicoChip>();
    restart(1);
    restart(1);
    CHECK_FALSE(reset_amid_motion());
}

TEST(PicoReset, ForgetsTheRecordsWhereTheSupplyFailed)
{
    for (const std::uint32_t cause : {1U << 16U, 1U << 17U}) {
        chip.power.chip_reset.value = cause;
        start_watchdog<PicoChip>();
        restart(0);
        CHECK_FALSE(reset_amid_motion());
        LONGS_EQUAL(cause, last_reset.cause);
    }
    // The reset pin.
    chip.power.chip_reset.value = 1U << 18U;
    restart(0);
    CHECK_TRUE(reset_amid_motion());
}

TEST_GROUP(UartLink)
{
    PicoModel chip;
    UartLink<PicoChip> link;

    void setup() override { link.start(150000000, 115200); }
    void come(unsigned bytes, std::uint32_t errors = 0)
    {
        for (unsigned i = 0; i < bytes; ++i) {
            chip.uart_in.push_back((i & 0xFFU) | errors);
            if (chip.uart_in.size() == 8) {
                link.on_interrupt();
            }
        }
        link.on_interrupt();
    }
};

TEST(UartLink, HasTheRateThatIsAskedFor)
{
    // 150 MHz / (16 (81 + 24/64)) = 115207 baud.
    LONGS_EQUAL(81, chip.uart0.ibrd.value);
    LONGS_EQUAL(24, chip.uart0.fbrd.value);
}

TEST(UartLink, ReadsWhatCameInOrder)
{
    come(2048);
    CHECK_FALSE(link.overrun());
    std::uint8_t byte = 0;
    for (unsigned i = 0; i < 2048; ++i) {
        CHECK_TRUE(link.try_read(byte));
        LONGS_EQUAL(i & 0xFFU, byte);
    }
    CHECK_FALSE(link.try_read(byte));
    LONGS_EQUAL(0, chip.violations);
}

TEST(UartLink, TellsLostBytesOnce)
{
    come(2049);
    CHECK_TRUE(link.overrun());
    CHECK_FALSE(link.overrun());
    std::uint8_t byte = 0;
    CHECK_TRUE(link.try_read(byte));
    LONGS_EQUAL(0, byte);
    unsigned kept = 1;
    while (link.try_read(byte)) {
        ++kept;
    }
    LONGS_EQUAL(2048, kept);
    come(1, 1U << 11U);
    CHECK_TRUE(link.overrun());
}

TEST(UartLink, ScansAheadOfTheReader)
{
    come(3);
    std::uint8_t byte = 9;
    CHECK_TRUE(link.try_scan(byte));
    LONGS_EQUAL(0, byte);
    CHECK_TRUE(link.try_read(byte));
    CHECK_TRUE(link.try_read(byte));
    CHECK_TRUE(link.try_scan(byte));
    LONGS_EQUAL(2, byte);
    CHECK_FALSE(link.try_scan(byte));
    CHECK_TRUE(link.try_read(byte));
    LONGS_EQUAL(2, byte);
}

TEST(UartLink, SendsMoreThanTheQueueHolds)
{
    std::vector<std::uint8_t> text(512);
    for (unsigned i = 0; i < text.size(); ++i) {
        text[i] = static_cast<std::uint8_t>(i * 7);
    }
    LONGS_EQUAL(512, link.write_room());
    link.write({text.data(), text.size()});
    LONGS_EQUAL(0, link.write_room());
    LONGS_EQUAL(1U << 1U, chip.interrupts.ispr[1].value);
    std::vector<std::uint8_t> sent;
    for (unsigned round = 0; round < 100 && sent.size() < text.size(); ++round) {
        link.on_interrupt();
        CHECK_TRUE(chip.uart_out.size() <= 32);
        const bool more = sent.size() + chip.uart_out.size() < text.size();
        CHECK_EQUAL(more, (chip.uart0.imsc.value & 1U << 5U) != 0);
        sent.insert(sent.end(), chip.uart_out.begin(), chip.uart_out.end());
        chip.uart_out.clear();
    }
    CHECK_TRUE(sent == text);
    LONGS_EQUAL(512, link.write_room());
}

namespace {

using Store = FlashSettings<PicoChip, 4 * 1024 * 1024>;
static_assert(cusp::hal::is_settings_store<Store>());
using Record = std::array<std::uint8_t, 64>;

Record some_bytes(std::uint8_t first)
{
    Record bytes{};
    for (unsigned i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::uint8_t>(first + 3 * i);
    }
    return bytes;
}
bool put(Store& store, unsigned sector, std::uint32_t offset, const Record& bytes)
{
    return store.write(sector, offset, {bytes.data(), bytes.size()});
}
Record got(const Store& store, unsigned sector, std::uint32_t offset)
{
    Record bytes{};
    store.read(sector, offset, {bytes.data(), bytes.size()});
    return bytes;
}

}  // namespace

TEST_GROUP(RomSettings)
{
    PicoModel chip;
    Store store;
};

TEST(RomSettings, ReadsWhatWasWrittenOverTheEdgesOfPages)
{
    for (const std::uint32_t offset : {0U, 64U, 224U, 4032U}) {
        CHECK_TRUE(put(store, 1, offset, some_bytes(static_cast<std::uint8_t>(offset / 4))));
    }
    for (const std::uint32_t offset : {0U, 64U, 224U, 4032U}) {
        CHECK_TRUE(got(store, 1, offset) == some_bytes(static_cast<std::uint8_t>(offset / 4)));
    }
    LONGS_EQUAL(0xFF, got(store, 0, 0)[0]);
    LONGS_EQUAL(0, chip.violations);
}

TEST(RomSettings, StaysInTheLastTwoSectors)
{
    CHECK_TRUE(put(store, 0, 0, some_bytes(1)));
    CHECK_TRUE(put(store, 1, 4032, some_bytes(2)));
    LONGS_EQUAL(0x3FE000, chip.flash.begin()->first);
    LONGS_EQUAL(0x3FFFFF, chip.flash.rbegin()->first);
}

TEST(RomSettings, ErasesOneSectorAlone)
{
    CHECK_TRUE(put(store, 0, 0, some_bytes(1)));
    CHECK_TRUE(put(store, 1, 0, some_bytes(2)));
    CHECK_TRUE(store.erase(0));
    LONGS_EQUAL(0xFF, got(store, 0, 0)[0]);
    CHECK_TRUE(got(store, 1, 0) == some_bytes(2));
}

TEST(RomSettings, SaysThatAWriteFailed)
{
    CHECK_TRUE(put(store, 0, 0, some_bytes(1)));
    CHECK_FALSE(put(store, 0, 0, some_bytes(2)));
}

TEST(RomSettings, LosesOnlyWhatWasBeingWrittenWhereverThePowerFails)
{
    for (std::int64_t cut = 0; cut <= 3; ++cut) {
        PicoModel other;
        Store fresh;
        CHECK_TRUE(put(fresh, 1, 0, some_bytes(9)));
        CHECK_TRUE(put(fresh, 0, 0, some_bytes(8)));
        other.power_left = cut;
        const bool erased = fresh.erase(0);
        const bool written = put(fresh, 0, 224, some_bytes(1));
        CHECK_EQUAL(cut == 3, erased && written);
        CHECK_TRUE(got(fresh, 1, 0) == some_bytes(9));
    }
    PicoModel::current = &chip;
}

namespace {

struct Place {
    static constexpr PulsePin kPulses{GP(13)};
    static constexpr std::uint32_t kPulseClockHz = 150000000;
};
using Pulses = SpindlePulses<PicoChip, Place>;

}  // namespace

TEST_GROUP(PwmPulses) { PicoModel chip; };

TEST(PwmPulses, HaveRateAndDutyOnThePinsOwnChannel)
{
    auto& slice = chip.pwm.slice[6];
    for (const std::uint32_t hz : {10U, 1000U, 20000U, 250000U}) {
        Pulses::set_rate(hz);
        const double period = (slice.top.value + 1.0) * (slice.div.value / 16.0);
        DOUBLES_EQUAL(1.0, 150e6 / period / hz, 0.005);
        Pulses::set_duty(25000, false);
        DOUBLES_EQUAL(0.5, (slice.cc.value >> 16U) / (slice.top.value + 1.0), 0.005);
        Pulses::set_duty(0);
        LONGS_EQUAL(0, slice.cc.value);
        Pulses::set_duty(50000);
        LONGS_EQUAL(slice.top.value + 1, slice.cc.value >> 16U);
    }
    Pulses::set_duty(1, true);
    LONGS_EQUAL(1U << 3U, slice.csr.value);
    CHECK_TRUE(slice.cc.value >> 16U >= 1);
    Pulses::start();
    LONGS_EQUAL(1U << 3U | 1U, slice.csr.value);
    LONGS_EQUAL(4, chip.functions.pin[13].ctrl.value);
    Pulses::set_duty(1, false);
    LONGS_EQUAL(1, slice.csr.value);
}
