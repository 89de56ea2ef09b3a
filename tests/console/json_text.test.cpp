#include "clog/console/json_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace clog::console {
namespace {

TEST(JsonText, BytesThatAreNoUtf8AreReplaced) {
  EXPECT_EQ(json_text({{"name", "a\xff\x1b"}}, -1), "{\"name\":\"a\xef\xbf\xbd\\u001b\"}\n");
}

TEST(JsonText, LevelsAreIndentedByTwo) { EXPECT_EQ(json_text({{"a", 1}}), "{\n  \"a\": 1\n}\n"); }

}  // namespace
}  // namespace clog::console
