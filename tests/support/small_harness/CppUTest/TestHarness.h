// As much of CppUTest as the tests of the core use, for machines that CppUTest is not packaged for
// (riscv64 on Debian 12). The names are CppUTest's; the code is not.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

class Utest {
public:
    virtual ~Utest() = default;
    virtual void setup() {}
    virtual void teardown() {}
    virtual void testBody() {}
};

class UtestShell {
public:
    using Maker = Utest* (*)();
    UtestShell(const char* group, const char* name, Maker maker)
        : group_{group}, name_{name}, maker_{maker}, next_{first()}
    {
        first() = this;
    }

    // Runs every test. Returns how many failed.
    static int run_all()
    {
        int tests = 0;
        int failed = 0;
        for (UtestShell* shell = first(); shell != nullptr; shell = shell->next_) {
            ++tests;
            failed += shell->run() ? 0 : 1;
        }
        std::printf("\n%s (%d tests, %ld checks, %d failures)\n", failed == 0 ? "OK" : "Errors",
                    tests, checks(), failed);
        return tests == 0 ? 1 : failed;
    }

    static UtestShell* getCurrent() { return current(); }
    void print(const char* text, const char* file, std::size_t line)
    {
        std::printf("\n%s:%zu: %s", file, line, text);
    }

    struct Stop {};
    static void check(bool holds, const char* text, const char* file, int line)
    {
        ++checks();
        if (!holds) {
            std::printf("\n%s:%d: error: Failure in TEST(%s, %s)\n\t%s\n", file, line,
                        current()->group_, current()->name_, text);
            throw Stop{};
        }
    }

private:
    static UtestShell*& first()
    {
        static UtestShell* shell = nullptr;
        return shell;
    }
    static UtestShell*& current()
    {
        static UtestShell* shell = nullptr;
        return shell;
    }
    static long& checks()
    {
        static long count = 0;
        return count;
    }
    bool run()
    {
        current() = this;
        Utest* test = maker_();
        bool passed = true;
        try {
            test->setup();
            test->testBody();
        } catch (const Stop&) {
            passed = false;
        }
        test->teardown();
        delete test;
        return passed;
    }

    const char* group_;
    const char* name_;
    Maker maker_;
    UtestShell* next_;
};

#define TEST_GROUP_BASE(group, base) struct CppUTestGroup##group : public base
#define TEST_GROUP(group) TEST_GROUP_BASE(group, Utest)
#define TEST(group, name)                                                                        \
    class TEST_##group##_##name##_Test : public CppUTestGroup##group {                           \
    public:                                                                                      \
        void testBody() override;                                                                \
    };                                                                                           \
    static UtestShell TEST_##group##_##name##_Shell(                                             \
        #group, #name, []() -> Utest* { return new TEST_##group##_##name##_Test; });             \
    void TEST_##group##_##name##_Test::testBody()

#define CUSP_CHECK_(condition, text) UtestShell::check(condition, text, __FILE__, __LINE__)
#define CHECK(condition) CUSP_CHECK_(static_cast<bool>(condition), "CHECK(" #condition ")")
#define CHECK_TEXT(condition, text) CUSP_CHECK_(static_cast<bool>(condition), text)
#define CHECK_TRUE(condition) CUSP_CHECK_(static_cast<bool>(condition), "CHECK_TRUE(" #condition ")")
#define CHECK_FALSE(condition) \
    CUSP_CHECK_(!static_cast<bool>(condition), "CHECK_FALSE(" #condition ")")
#define CHECK_EQUAL(expected, actual) \
    CUSP_CHECK_((expected) == (actual), "CHECK_EQUAL(" #expected ", " #actual ")")
#define LONGS_EQUAL(expected, actual)                                                   \
    CUSP_CHECK_(static_cast<long>(expected) == static_cast<long>(actual),               \
                "LONGS_EQUAL(" #expected ", " #actual ")")
#define UNSIGNED_LONGS_EQUAL(expected, actual) LONGS_EQUAL(expected, actual)
#define BYTES_EQUAL(expected, actual) LONGS_EQUAL((expected)&0xff, (actual)&0xff)
#define DOUBLES_EQUAL(expected, actual, allowed)                                          \
    CUSP_CHECK_(std::fabs(static_cast<double>(expected) - static_cast<double>(actual)) <= \
                    static_cast<double>(allowed),                                         \
                "DOUBLES_EQUAL(" #expected ", " #actual ", " #allowed ")")
#define STRCMP_EQUAL(expected, actual) \
    CUSP_CHECK_(std::strcmp(expected, actual) == 0, "STRCMP_EQUAL(" #expected ", " #actual ")")
#define MEMCMP_EQUAL(expected, actual, size)               \
    CUSP_CHECK_(std::memcmp(expected, actual, size) == 0,  \
                "MEMCMP_EQUAL(" #expected ", " #actual ", " #size ")")
#define CHECK_TRUE_TEXT(condition, text) CUSP_CHECK_(static_cast<bool>(condition), text)
#define CHECK_FALSE_TEXT(condition, text) CUSP_CHECK_(!static_cast<bool>(condition), text)
#define CHECK_EQUAL_TEXT(expected, actual, text) CUSP_CHECK_((expected) == (actual), text)
#define LONGS_EQUAL_TEXT(expected, actual, text) \
    CUSP_CHECK_(static_cast<long>(expected) == static_cast<long>(actual), text)
#define UNSIGNED_LONGS_EQUAL_TEXT(expected, actual, text) LONGS_EQUAL_TEXT(expected, actual, text)
#define STRCMP_EQUAL_TEXT(expected, actual, text) \
    CUSP_CHECK_(std::strcmp(expected, actual) == 0, text)
#define DOUBLES_EQUAL_TEXT(expected, actual, allowed, text)                               \
    CUSP_CHECK_(std::fabs(static_cast<double>(expected) - static_cast<double>(actual)) <= \
                    static_cast<double>(allowed),                                         \
                text)
#define FAIL(text) CUSP_CHECK_(false, text)
