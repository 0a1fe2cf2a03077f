// The flash store against a model of the flash that loses power anywhere.
#include "hal/stm32f4/flash_settings.hpp"

#include <array>
#include <map>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/hal_stm32f4/chip_model.hpp"

using cusp::test::ChipModel;
using cusp::test::ModelChip;
using Store = cusp::hal::stm32f4::FlashSettings<ModelChip>;
static_assert(cusp::hal::is_settings_store<Store>());

namespace {

using Bytes = std::array<std::uint8_t, 64>;

Bytes some_bytes(std::uint8_t first)
{
    Bytes bytes{};
    for (std::uint8_t& byte : bytes) {
        byte = first++;
    }
    return bytes;
}

Bytes read(const Store& store, unsigned sector, std::uint32_t offset)
{
    Bytes bytes{};
    store.read(sector, offset, bytes);
    return bytes;
}

}  // namespace

TEST_GROUP(FlashSettings)
{
    ChipModel chip;
    Store store;
};

TEST(FlashSettings, KeepsWhatIsWrittenAndNothingElse)
{
    CHECK_TRUE(store.write(0, 0, some_bytes(1)));
    CHECK_TRUE(store.write(1, 16320, some_bytes(7)));
    CHECK_TRUE(read(store, 0, 0) == some_bytes(1));
    CHECK_TRUE(read(store, 1, 16320) == some_bytes(7));
    LONGS_EQUAL(0xFF, read(store, 0, 64)[0]);
    LONGS_EQUAL(0, chip.violations);
}

TEST(FlashSettings, ReadsAtAnyOffset)
{
    CHECK_TRUE(store.write(0, 0, some_bytes(1)));
    std::array<std::uint8_t, 5> bytes{};
    store.read(0, 3, bytes);
    LONGS_EQUAL(4, bytes[0]);
    LONGS_EQUAL(8, bytes[4]);
}

TEST(FlashSettings, ErasesOneSectorAlone)
{
    CHECK_TRUE(store.write(0, 0, some_bytes(1)));
    CHECK_TRUE(store.write(1, 0, some_bytes(2)));
    CHECK_TRUE(store.erase(0));
    LONGS_EQUAL(0xFF, read(store, 0, 0)[0]);
    CHECK_TRUE(read(store, 1, 0) == some_bytes(2));
    LONGS_EQUAL(0, chip.violations);
}

TEST(FlashSettings, ReadsNothingOldFromTheDataCache)
{
    chip.flash.acr.value = 1U << 10U;
    CHECK_TRUE(store.write(0, 0, some_bytes(1)));
    CHECK_TRUE(read(store, 0, 0) == some_bytes(1));
    CHECK_TRUE(store.erase(0));
    LONGS_EQUAL(0xFF, read(store, 0, 0)[0]);
    CHECK_TRUE(store.write(0, 0, some_bytes(9)));
    CHECK_TRUE(read(store, 0, 0) == some_bytes(9));
    LONGS_EQUAL(1U << 10U, chip.flash.acr.value);
    LONGS_EQUAL(0, chip.violations);
}

TEST(FlashSettings, StaysInSectorsOneAndTwo)
{
    CHECK_TRUE(store.write(0, 0, some_bytes(1)));
    CHECK_TRUE(store.write(1, 16320, some_bytes(2)));
    LONGS_EQUAL(0x08004000, chip.flash_words.begin()->first);
    LONGS_EQUAL(0x0800BFFC, chip.flash_words.rbegin()->first);
}

TEST(FlashSettings, StaysInTheLastTwoSectorsBehindABootLoader)
{
    using namespace cusp::hal::stm32f4;
    FlashSettings<ModelChip, SettingsAtEndOf1M> last;
    CHECK_TRUE(last.write(0, 0, some_bytes(1)));
    CHECK_TRUE(last.write(1, last.sector_size() - 64, some_bytes(2)));
    LONGS_EQUAL(0x080C0000, chip.flash_words.begin()->first);
    LONGS_EQUAL(0x080E7FFC, chip.flash_words.rbegin()->first);
}

TEST(FlashSettings, LeavesTheFlashLocked)
{
    CHECK_TRUE(store.erase(0));
    CHECK_TRUE(store.write(0, 0, some_bytes(1)));
    ModelChip::write_memory(0x08004100, 1);
    LONGS_EQUAL(1, chip.violations);
}

TEST(FlashSettings, SaysThatAWriteFailed)
{
    CHECK_TRUE(store.write(0, 0, some_bytes(1)));
    CHECK_FALSE(store.write(0, 0, some_bytes(2)));
}

TEST(FlashSettings, LosesOnlyWhatWasBeingWrittenWhereverThePowerFails)
{
    for (std::int64_t cut = 1; cut <= 18; ++cut) {
        ChipModel other;
        Store fresh;
        CHECK_TRUE(fresh.write(1, 0, some_bytes(9)));
        other.power_left = cut;
        const bool erased = fresh.erase(0);
        const bool written = fresh.write(0, 0, some_bytes(1));
        CHECK_EQUAL(cut == 18, erased && written);
        CHECK_TRUE(read(fresh, 1, 0) == some_bytes(9));
        LONGS_EQUAL(0, other.violations);
    }
    ChipModel::current = &chip;
}
