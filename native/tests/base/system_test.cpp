// What base asks of the system, on every system: names of any characters, long paths, locks, drafts.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <iterator>
#include <new>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "base/atomic_file.hpp"
#include "base/draft_names.hpp"
#include "base/environment.hpp"
#include "base/input_stream.hpp"
#include "base/io.hpp"
#include "base/locked_file.hpp"
#include "base/own_module.hpp"
#include "base/own_thread.hpp"
#include "base/path_text.hpp"
#include "base/processors.hpp"
#include "base/shared_memory.hpp"
#include "riffler/base/error.hpp"
#include "support/set_environment.hpp"

namespace riffler::base::system_test {
namespace {

namespace fs = std::filesystem;

const std::string kNames[] = {"plain.txt", "mit Leerzeichen.txt", "Fräser Größe.txt", "фреза.txt", "刀具 𝄞.txt"};

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

/// A folder of its own whose name is no ASCII; gone after the test.
struct System : testing::Test {
  System() : folder(fs::temp_directory_path() / text_path("riffler Prüfung " + std::to_string(process_number()))) {
    fs::remove_all(folder);
    fs::create_directory(folder);
  }
  ~System() override {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }

  std::string text(const fs::path& path) const {
    const std::vector<std::uint8_t> bytes = read_file(path);
    return {bytes.begin(), bytes.end()};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  fs::path folder;
};

TEST_F(System, WritesAndReadsFilesOfAnyName) {
  for (const std::string& name : kNames) {
    const fs::path path = folder / text_path(name);
    EXPECT_EQ(file_name(path), name);
    EXPECT_TRUE(path_text(path).ends_with(name));
    write_file(path, "first\n");
    write_file(path, "second\r\n\x1a line ends and all bytes stay\n");
    EXPECT_EQ(text(path), "second\r\n\x1a line ends and all bytes stay\n");
    EXPECT_EQ(message_of([&] { read_file(folder / text_path("no " + name)); }).substr(0, name.size() + 3),
              "no " + name);
  }
  EXPECT_EQ(files(), std::size(kNames));
}

TEST_F(System, APathMayBeLongerThanWindowsUsuallyAllows) {
  fs::path deep = folder;
  for (int k = 0; k < 6; ++k) deep /= std::string(50, static_cast<char>('a' + k));
#ifdef _WIN32
  fs::create_directories(fs::path(LR"(\\?\)" + deep.native()));
#else
  fs::create_directories(deep);
#endif
  write_file(deep / "long.txt", "far down");
  EXPECT_EQ(text(deep / "long.txt"), "far down");
#ifdef _WIN32
  fs::remove_all(fs::path(LR"(\\?\)" + folder.native()));
#endif
}

TEST_F(System, ADraftIsGoneUnlessItIsCommitted) {
  const fs::path path = folder / text_path(kNames[2]);
  write_file(path, "old");
  {
    AtomicFileWriter draft(path);
    const std::vector<std::uint8_t> bytes(1000, 7);
    draft.write(bytes);
    clear_drafts(path);  // it is in use, so it stays
  }
  EXPECT_EQ(text(path), "old");
  EXPECT_EQ(files(), 1u);
  {
    AtomicFileWriter draft(path);
    const std::vector<std::uint8_t> bytes(1000, 'x');
    draft.write(bytes);
    clear_drafts(path);
    draft.commit();
  }
  EXPECT_EQ(text(path), std::string(1000, 'x'));
  const fs::path left = random_draft(path);
  write_file(left, "of a killed program");
  clear_drafts(path);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(files(), 1u);
}

TEST_F(System, AFolderIsNotReplaced) {
  EXPECT_NE(message_of([&] { AtomicFileWriter writer(folder); }).find("is a folder"), std::string::npos);
}

TEST_F(System, AFileInUseIsReplacedOrTheErrorSaysSo) {
  const fs::path path = folder / "used.txt";
  write_file(path, "old");
  const InputStream reader = open_input(path);
  const std::string error = message_of([&] { write_file(path, "new"); });
#ifdef _WIN32
  EXPECT_NE(error.find("used.txt: cannot be replaced"), std::string::npos) << error;
#else
  EXPECT_EQ(error, "");
#endif
  EXPECT_EQ(text(path), error.empty() ? "new" : "old");
}

TEST_F(System, ALockedFileHasOneWriter) {
  const fs::path path = folder / text_path(kNames[4]);
  const std::string bytes = "0123456789";
  const auto all = std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  {
    LockedFile file(path);
    file.write_at(all, 0);
    file.write_at(all.first(3), 5);
    EXPECT_EQ(file.size(), 10u);
    EXPECT_EQ(text(path), "0123401289");  // others read it meanwhile
    EXPECT_NE(message_of([&] { LockedFile second(path); }).find("by another program"), std::string::npos);
    EXPECT_TRUE(file.cut(4));
    file.flush();
    EXPECT_EQ(file.size(), 4u);
  }
  LockedFile again(path);
  EXPECT_EQ(again.size(), 4u);
  EXPECT_EQ(text(path), "0123");
}

TEST_F(System, ReadsBeyondTwoGibibytes) {
  const fs::path path = folder / "far.bin";
  const std::uint64_t far = (std::uint64_t{2} << 30) + 11;
  {
    LockedFile file(path);
    ASSERT_TRUE(file.cut(far));  // takes no place on the disk
    const std::uint8_t last = 42;
    file.write_at({&last, 1}, far);
  }
  const InputStream in = open_input(path);
  ASSERT_TRUE(seek_input(in.get(), far));
  EXPECT_EQ(std::fgetc(in.get()), 42);
}

TEST(SystemCalls, TheEnvironmentIsUtf8) {
  const test::SetEnvironment unset("RIFFLER_TEST_VARIABLE", {});
  EXPECT_EQ(environment("RIFFLER_TEST_VARIABLE"), std::nullopt);
  const test::SetEnvironment set("RIFFLER_TEST_VARIABLE", std::string(300, 'a'));
  EXPECT_EQ(environment("RIFFLER_TEST_VARIABLE"), std::string(300, 'a'));
}

TEST(SystemCalls, KnowProcessorsTimeAndTheirOwnModule) {
  EXPECT_GE(usable_processors(), 1);
  EXPECT_TRUE(fs::is_directory(module_folder()));
  const double begin = thread_seconds();
  volatile double sum = 0;
  for (int k = 0; k < 200'000'000 && thread_seconds() < begin + 0.05; ++k) sum = sum + k;
  EXPECT_GE(thread_seconds(), begin + 0.04);
}

TEST(SystemCalls, WaitForAWord) {
  const SharedMemory memory(4096);
  auto& word = *new (memory.data()) std::atomic<std::uint32_t>(3);
  wait_for_change(word, 3, 0.01);  // in vain
  std::thread other([&] { change(word); });
  while (word.load() == 3) wait_for_change(word, 3, 1);
  other.join();
  EXPECT_EQ(word.load(), 4u);
}

}  // namespace
}  // namespace riffler::base::system_test
