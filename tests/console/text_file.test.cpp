#include "clog/console/text_file.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "clog/core/tools/error.hpp"

namespace clog::console {
namespace {

class TextFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      ("clog_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(TextFile, IsReadWhole) {
  const std::string text = "seeds = 1..3\n" + std::string(200'000, '#');
  write(path("a.cfg"), text);
  EXPECT_EQ(read_text(path("a.cfg")), text);
  write(path("empty.cfg"), "");
  EXPECT_EQ(read_text(path("empty.cfg")), "");
}

TEST_F(TextFile, MayBeginWithAByteOrderMark) {
  write(path("a.cfg"), "\xef\xbb\xbfseeds = 1");
  EXPECT_EQ(read_text(path("a.cfg")), "seeds = 1");
}

TEST_F(TextFile, MayBeInUtf16) {
  const std::string text = "a=\xc2\xb5\xf0\x9f\x92\xa7\n";  // contains characters of two and of four bytes
  write(path("a.cfg"), std::string("\xff\xfe"
                                   "a\0=\0\xb5\0\x3d\xd8\xa7\xdc\n\0",
                                   14));
  EXPECT_EQ(read_text(path("a.cfg")), text);
  write(path("a.cfg"), std::string("\xfe\xff\0a\0=\0\xb5\xd8\x3d\xdc\xa7\0\n", 14));
  EXPECT_EQ(read_text(path("a.cfg")), text);
  write(path("a.cfg"),
        "\xff\xfe"
        "a");
  EXPECT_THROW(read_text(path("a.cfg")), Error);
}

TEST_F(TextFile, MayHaveTheLineEndsOfWindowsAndOldMacs) {
  write(path("a.cfg"), "a\r\nb\rc\r");
  EXPECT_EQ(read_text(path("a.cfg")), "a\nb\nc\n");
}

TEST_F(TextFile, MayBeAPipe) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const std::string text(200'000, '#');  // longer than the pipe can hold
  std::thread writer([&] { write(path("pipe"), text); });
  EXPECT_EQ(read_text(path("pipe")), text);
  writer.join();
}

TEST_F(TextFile, IsNeitherFolderNorDeviceNorMissing) {
  EXPECT_THROW(read_text(folder_.string()), Error);
  EXPECT_THROW(read_text("/dev/zero"), Error);
  EXPECT_THROW(read_text(path("none")), Error);
}

}  // namespace
}  // namespace clog::console
