// Requests and answers of calls as bytes.
#include "host_tools/cli/studio/call.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/base/input_error/input_error.hpp"

#include "nlohmann/json.hpp"

using cusp::InputError;
using cusp::studio::answer_bytes;
using cusp::studio::answer_call;
using cusp::studio::Call;
using cusp::studio::failure_bytes;
using cusp::studio::read_call;

TEST_GROUP(StudioCall){};

TEST(StudioCall, FilesAreTheBytesAfterTheFirstLine)
{
    const std::string request =
        "{\"arguments\":{\"x\":[1,2]},\"files\":[{\"name\":\"a\",\"size\":3},{\"name\":\"b/"
        "c\",\"size\":0},"
        "{\"name\":\"d\",\"size\":2}]}\n" +
        std::string{"1\n\0", 3} + "45";
    const Call call = read_call(request);
    STRCMP_EQUAL("{\"x\":[1,2]}", call.arguments.c_str());
    LONGS_EQUAL(3, call.files.size());
    CHECK(call.files.at("a") == std::string("1\n\0", 3));
    CHECK(call.files.at("b/c").empty());
    CHECK(call.files.at("d") == "45");
}

TEST(StudioCall, WhatIsNoRequestIsRefused)
{
    for (const char* request :
         {"", "{}", "\n", "3\n", "[1]\n", "{\"files\":[{\"name\":\"a\",\"size\":3}]}\n12",
          "{\"files\":[{\"name\":1,\"size\":0}]}\n", "{\"files\":[{\"size\":0}]}\n",
          "{\"files\":{\"a\":1}}\n", "{\"files\":[{\"name\":\"a\",\"size\":-1}]}\n",
          "{\"arguments\":\n"}) {
        CHECK_THROWS(InputError, read_call(request));
    }
    CHECK(read_call("{}\n").files.empty());
}

TEST(StudioCall, AnAnswerNamesItsBlocksAndTheirBytesFollow)
{
    const std::string bytes =
        answer_bytes({"{\"ok\":true,\"result\":7}", {{"gcode-0", "G1\n"}, {"b", ""}}});
    STRCMP_EQUAL(
        "{\"answer\":{\"ok\":true,\"result\":7},\"blocks\":[{\"name\":\"gcode-0\",\"size\":3},"
        "{\"name\":\"b\",\"size\":0}]}\nG1\n",
        bytes.c_str());
}

TEST(StudioCall, AnyTextOfAFailureIsJson)
{
    const std::string bytes = failure_bytes("bad \xff byte\n\"x\"");
    const auto json = nlohmann::json::parse(bytes);
    CHECK(json["answer"]["ok"] == false);
    CHECK(json["answer"]["error"]["kind"] == "internal");
    LONGS_EQUAL(1, std::count(bytes.begin(), bytes.end(), '\n'));
}

TEST(StudioCall, ACallOfTheEngineIsReadAndAnswered)
{
    std::FILE* in = std::tmpfile();
    std::FILE* out = std::tmpfile();
    std::fputs("{\"arguments\":{}}\n", in);
    std::rewind(in);
    answer_call("keys", in, out);
    std::string text(static_cast<std::size_t>(std::ftell(out)), '\0');
    std::rewind(out);
    LONGS_EQUAL(text.size(), std::fread(text.data(), 1, text.size(), out));
    std::fclose(in);
    std::fclose(out);
    const std::size_t last = text.rfind("{\"answer\"");
    CHECK(last != std::string::npos);
    const auto json = nlohmann::json::parse(text.substr(last));
    CHECK(json["answer"]["ok"] == true);
    CHECK(json["answer"]["result"]["strategies"].size() > 5);
}
