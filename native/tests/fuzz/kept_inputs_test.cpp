// What fuzzing began with and what it found stays read, or refused, as readers promise.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/targets.hpp"
#include "support/checkout.hpp"

namespace riffler::fuzz::kept_inputs_test {
namespace {

namespace fs = std::filesystem;

fuzz::Bytes read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class KeptInputs : public testing::TestWithParam<fuzz::Target> {};

TEST_P(KeptInputs, AreReadOrRefusedInTime) {
  const fuzz::Target& target = GetParam();
  std::size_t count = 0;
  const auto run = [&](const fuzz::Bytes& bytes, const std::string& name) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_NO_THROW(target.run(bytes)) << name;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << name;
    ++count;
  };
  for (const fuzz::Bytes& bytes : target.made()) run(bytes, "a sample");
  for (const char* kind : {"seeds", "kept"}) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(test::checkout() / "native" / "fuzz" / kind / target.name, none))
      for (fuzz::Bytes bytes = read(entry.path()); const char* how : {"", " and a blank"}) {
        run(bytes, entry.path().string() + how);
        bytes.push_back(' ');  // what a target does with its bytes hangs on whether they are odd
      }
  }
  EXPECT_GT(count, 0U) << "nothing to begin with";
}

std::string name_of(const testing::TestParamInfo<fuzz::Target>& info) {
  std::string name;
  for (const char* c = info.param.name; *c; ++c) name += *c == '-' ? '_' : *c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Fuzz, KeptInputs, testing::ValuesIn(fuzz::targets().begin(), fuzz::targets().end()), name_of);

}  // namespace
}  // namespace riffler::fuzz::kept_inputs_test
