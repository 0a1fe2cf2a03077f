// The simulated flash: its content, and power cuts.
#include "hal/sim/simulated_store.hpp"

#include <filesystem>

#include "CppUTest/TestHarness.h"

using cusp::hal::SimulatedStore;

TEST_GROUP(SimulatedStore)
{
    SimulatedStore store;
    std::uint8_t read_byte(unsigned sector, std::uint32_t offset) const
    {
        std::uint8_t byte[1] = {};
        store.read(sector, offset, byte);
        return byte[0];
    }
};

TEST(SimulatedStore, ReadsErasedBytesAsFF) { LONGS_EQUAL(0xFF, read_byte(1, 16383)); }

TEST(SimulatedStore, OnlyClearsBitsAsFlashDoes)
{
    const std::uint8_t first[] = {0xF0, 1, 2, 3};
    const std::uint8_t second[] = {0x0F, 1, 2, 3};
    CHECK(store.write(0, 8, first));
    CHECK(store.write(0, 8, second));
    LONGS_EQUAL(0, read_byte(0, 8));
    CHECK(store.erase(0));
    LONGS_EQUAL(0xFF, read_byte(0, 8));
}

TEST(SimulatedStore, WritesNothingAfterThePowerIsCut)
{
    const std::uint8_t words[] = {1, 2, 3, 4, 5, 6, 7, 8};
    store.cut_power_after(1);
    CHECK_FALSE(store.write(0, 0, words));
    LONGS_EQUAL(4, read_byte(0, 3));
    LONGS_EQUAL(0xFF, read_byte(0, 4));
    CHECK_FALSE(store.erase(1));
    CHECK(store.power_is_cut());
}

TEST(SimulatedStore, KeepsItsBytesInAFile)
{
    const auto file = std::filesystem::temp_directory_path() / "cusp_simulated_store_test.bin";
    std::filesystem::remove(file);
    const std::uint8_t word[] = {9, 8, 7, 6};
    CHECK(store.keep_in(file));
    CHECK(store.write(1, 4, word));
    SimulatedStore again;
    CHECK(again.keep_in(file));
    std::uint8_t bytes[4] = {};
    again.read(1, 4, bytes);
    MEMCMP_EQUAL(word, bytes, 4);
    std::filesystem::resize_file(file, 100);
    SimulatedStore refused;
    CHECK_FALSE(refused.keep_in(file));
    std::filesystem::remove(file);
}
