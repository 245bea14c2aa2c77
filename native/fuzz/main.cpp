// Fuzzes one reader for a given time: riffler_fuzz TARGET --seconds 600 [--seed 1] [--folder native/fuzz] [--found
// build/fuzz]
//
// Begins with samples written by the library, the seeds and the kept inputs, and mutates inputs that reach new
// branches. An input that breaks a reader (a sanitizer's report, an error of another kind, more than 10 s) is written
// to the folder `found`, and the program ends with 1. `--again FILE` runs one input.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "fuzz/coverage.hpp"
#include "fuzz/mutator.hpp"
#include "fuzz/targets.hpp"
#include "riffler/base/parallel.hpp"

// Part of the sanitizers' runtime, if linked.
extern "C" [[gnu::weak]] void __sanitizer_set_death_callback(void (*callback)());

namespace riffler::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr unsigned kSlowest = 10;            // s of one input
constexpr std::size_t kMaxBytes = 1 << 16;   // of one input
constexpr std::size_t kMaxInputs = 1 << 16;  // kept in memory

/// The current input; `save` writes it before the process ends.
Bytes running;
std::string found_path;

void save() {
  if (std::FILE* file = std::fopen(found_path.c_str(), "wb")) {
    std::fwrite(running.data(), 1, running.size(), file);
    std::fclose(file);
  }
  std::fprintf(stderr, "the input: %s\n", found_path.c_str());
}

void too_slow(int) {
  std::fprintf(stderr, "an input took more than %u s\n", kSlowest);
  save();
  _exit(1);
}

Bytes read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void run(const Target& target, const Bytes& bytes) {
  running = bytes;
  running.shrink_to_fit();  // lets the sanitizer detect a read beyond the end
  alarm(kSlowest);
  try {
    target.run(running);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    save();
    std::_Exit(1);
  }
  alarm(0);
}

struct Arguments {
  std::map<std::string, std::string> values{
      {"--seconds", "600"}, {"--seed", "1"}, {"--folder", "native/fuzz"}, {"--found", "build/fuzz"}, {"--again", ""}};
  std::string target;

  bool read(int count, char** words) {
    for (int k = 1; k < count; ++k) {
      if (const auto at = values.find(words[k]); at != values.end() && k + 1 < count)
        at->second = words[++k];
      else if (target.empty() && words[k][0] != '-')
        target = words[k];
      else
        return false;
    }
    return true;
  }
};

std::vector<Bytes> beginnings(const Target& target, const fs::path& folder) {
  std::vector<Bytes> inputs = target.made();
  for (const char* kind : {"seeds", "kept"}) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder / kind / target.name, none))
      if (entry.path().filename().string()[0] != '.') inputs.push_back(read(entry.path()));
  }
  if (inputs.empty()) inputs.emplace_back();
  return inputs;
}

int fuzz(const Target& target, const Arguments& given) {
  std::vector<Bytes> inputs = beginnings(target, given.values.at("--folder"));
  for (const Bytes& input : inputs) {
    begin_coverage();
    run(target, input);
    is_new_coverage();
  }
  Mutator mutator(std::strtoull(given.values.at("--seed").c_str(), nullptr, 10));
  const double seconds = std::strtod(given.values.at("--seconds").c_str(), nullptr);
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  const std::size_t first = inputs.size();
  std::uint64_t runs = 0;
  for (; Clock::now() < end; ++runs) {
    // Choose one of the newest half of the time.
    const std::size_t n = inputs.size(), recent = std::min<std::size_t>(n, 64);
    Bytes input = inputs[mutator.below(2) == 0 ? n - 1 - mutator.below(recent) : mutator.below(n)];
    mutator.mutate(input, inputs[mutator.below(n)], kMaxBytes);
    if (target.repair && mutator.below(8) != 0) target.repair(input);
    begin_coverage();
    run(target, input);
    if (is_new_coverage() && n < kMaxInputs) inputs.push_back(std::move(input));
  }
  std::printf("%s: %llu runs in %.0f s from %zu inputs, %zu more that reach something new, %llu branches\n",
              target.name, static_cast<unsigned long long>(runs), seconds, first, inputs.size() - first,
              static_cast<unsigned long long>(covered()));
  return 0;
}

int entry(int count, char** words) {
  Arguments given;
  if (!given.read(count, words)) {
    std::fprintf(stderr,
                 "usage: riffler_fuzz [TARGET [--seconds N] [--seed N] [--folder F] [--found F] [--again FILE]]\n");
    return 2;
  }
  if (given.target.empty()) {
    for (const Target& t : targets()) std::printf("%s\n", t.name);
    return 0;
  }
  const Target& chosen = target(given.target);
  base::set_thread_count(1);  // branches are distinguished by the order in which they are taken
  fs::create_directories(given.values.at("--found"));
  found_path = (fs::path(given.values.at("--found")) / (given.target + "-" + std::to_string(getpid()))).string();
  std::signal(SIGALRM, &too_slow);
  if (__sanitizer_set_death_callback) __sanitizer_set_death_callback(&save);
  if (const std::string& file = given.values.at("--again"); !file.empty()) return run(chosen, read(file)), 0;
  return fuzz(chosen, given);
}

}  // namespace
}  // namespace riffler::fuzz

int main(int count, char** words) {
  try {
    return riffler::fuzz::entry(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
