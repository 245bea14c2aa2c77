#include "base/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "base/io.hpp"
#include "riffler/base/error.hpp"
#include "support/file_limit.hpp"

namespace riffler::base::atomic_file_test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, which is gone after the test.
struct AtomicFile : testing::Test {
  AtomicFile() {
    std::string name = (fs::temp_directory_path() / "riffler_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no folder");
    folder = name;
  }
  ~AtomicFile() override { fs::remove_all(folder); }

  std::string text(const fs::path& path) const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  mode_t mode(const fs::path& path) const {
    struct stat status{};
    return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  std::string refusal(const fs::path& path) const {
    try {
      write_file(path, "new");
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }

  fs::path folder;
};

TEST_F(AtomicFile, ANewFileHasThePermissionsThatTheSystemGivesNewFiles) {
  const mode_t before = umask(027);
  write_file(folder / "a", "new");
  umask(before);
  EXPECT_EQ(mode(folder / "a"), 0640U);
  EXPECT_EQ(text(folder / "a"), "new");
}

TEST_F(AtomicFile, AnExistingFileKeepsItsPermissionsAndItsOwner) {
  for (const mode_t kept : {0600U, 0644U, 0664U, 0400U}) {
    write_file(folder / "a", "old");
    chmod((folder / "a").c_str(), kept);
    write_file(folder / "a", "new");
    EXPECT_EQ(mode(folder / "a"), kept);
    EXPECT_EQ(text(folder / "a"), "new");
  }
  if (geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  ASSERT_EQ(chown((folder / "a").c_str(), 1234, 2345), 0);
  write_file(folder / "a", "newer");
  struct stat status{};
  ASSERT_EQ(stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 1234U);
  EXPECT_EQ(status.st_gid, 2345U);
}

TEST_F(AtomicFile, TheProcesssUmaskIsNeverChanged) {
  const mode_t before = umask(077);
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      for (int n = 0; n < 100; ++n) {
        write_file(folder / std::to_string(k), "x");
        std::ofstream(folder / ("plain" + std::to_string(k))) << "x";
        EXPECT_EQ(mode(folder / ("plain" + std::to_string(k))), 0600U);
        fs::remove(folder / ("plain" + std::to_string(k)));
      }
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(umask(before), 077U);
}

TEST_F(AtomicFile, LinksAreFollowed) {
  fs::create_directory(folder / "there");
  write_file(folder / "there" / "file", "old");
  fs::create_symlink("there/file", folder / "link");
  fs::create_symlink("link", folder / "link of a link");
  write_file(folder / "link of a link", "new");
  EXPECT_EQ(text(folder / "there" / "file"), "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  fs::create_symlink(folder / "there" / "not yet", folder / "hanging");
  write_file(folder / "hanging", "made");
  EXPECT_EQ(text(folder / "there" / "not yet"), "made");
  fs::create_symlink("loop", folder / "loop");
  EXPECT_NE(refusal(folder / "loop").find("link"), std::string::npos);
}

TEST_F(AtomicFile, OtherThanRegularFilesAreRefusedAndStay) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/null", folder / "null");
  fs::create_directory(folder / "folder");
  EXPECT_EQ(refusal(folder / "pipe").substr(0, 15), "pipe: is a pipe");
  EXPECT_NE(refusal(folder / "null").find("device"), std::string::npos);
  EXPECT_NE(refusal(folder / "folder").find("is a folder"), std::string::npos);
  EXPECT_TRUE(fs::is_fifo(folder / "pipe") && fs::is_character_file("/dev/null"));
  EXPECT_EQ(entries(), 3U);
  EXPECT_THROW(read_file(folder / "pipe"), FormatError) << "or it would be waited for";
  EXPECT_THROW(read_file("/dev/zero"), FormatError) << "it has no end";
}

TEST_F(AtomicFile, WithoutACommitNothingIsLeft) {
  write_file(folder / "a", "old");
  {
    AtomicFileWriter writer(folder / "a");
    writer.write(std::vector<std::uint8_t>(10, 'x'));
    EXPECT_EQ(text(folder / "a"), "old");
  }
  EXPECT_EQ(entries(), 1U);
  {
    const test::FileLimit full(100);
    EXPECT_THROW(write_file(folder / "a", std::string(1000, 'x')), std::runtime_error);
  }
  EXPECT_EQ(text(folder / "a"), "old");
  EXPECT_EQ(entries(), 1U);
  EXPECT_NE(refusal(folder / "none" / "a"), "");
}

TEST_F(AtomicFile, DraftsOfKilledProcessesAreRemovedAndThoseOfOthersStay) {
  const fs::path target = folder / "a", left = draft_prefix(target).string() + "left",
                 held = draft_prefix(target).string() + "held";
  write_file(left, "half"), write_file(held, "half");
  fs::create_directory(draft_prefix(target).string() + "folder");
  write_file(folder / ".b.riffler-other", "half");
  const int fd = open(held.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(fd, LOCK_EX | LOCK_NB), 0);
  clear_drafts(target);
  close(fd);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(held) && fs::exists(folder / ".b.riffler-other"));
  EXPECT_EQ(entries(), 2U);
}

TEST_F(AtomicFile, ADraftIsAcceptedWhereAFileWouldBe) {
  write_file(folder / "a", "old");
  chmod((folder / "a").c_str(), 0600);
  fs::create_symlink("a", folder / "link");
  write_file(folder / "draft", "new");
  replace_file(folder / "draft", folder / "link");
  EXPECT_EQ(text(folder / "a"), "new");
  EXPECT_EQ(mode(folder / "a"), 0600U);
  EXPECT_EQ(entries(), 2U);
}

TEST_F(AtomicFile, NamesAsLongAsTheSystemAllowsAreWritten) {
  const std::string name(255, 'n');
  write_file(folder / name, "old");
  write_file(folder / name, "new");
  EXPECT_EQ(text(folder / name), "new");
}

}  // namespace
}  // namespace riffler::base::atomic_file_test
