// Holds random tools against random parts from the degenerate limits and checks each answer; see usage().
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "riffler/mesh/io/io.hpp"
#include "stress/arguments.hpp"
#include "stress/contact_run.hpp"

using namespace riffler::stress;

namespace {

struct Arguments {
  ContactOptions options;
  long poses = 100'000;
  std::optional<std::uint64_t> session;
};

void usage() {
  std::puts(
      "riffler_contact_stress [options]\n"
      "  --poses N            (100000)\n"
      "  --seed N             (1)\n"
      "  --reference-every N  poses from one that the independent reference judges to the next (64)\n"
      "  --part FILE          a part from a file in place of the random ones; several, in turns\n"
      "  --session N          this one alone, every pose judged: what a failure's reproducer says");
}

Arguments parse(int argc, char** argv) {
  Arguments out;
  each_option(argc, argv, [&](std::string_view option, const char* value) {
    if (option == "--poses")
      out.poses = static_cast<long>(whole_number(option, value));
    else if (option == "--seed")
      out.options.seed = whole_number(option, value);
    else if (option == "--reference-every")
      out.options.reference_every = std::max(1, static_cast<int>(whole_number(option, value)));
    else if (option == "--part" && value)
      out.options.parts.push_back({std::filesystem::path(value).stem().string(), riffler::mesh::read_mesh(value)});
    else if (option == "--session")
      out.session = whole_number(option, value), out.options.reference_every = 1;
    else
      return Takes::Unknown;
    return Takes::Value;
  });
  return out;
}

void print(const ContactFailure& f) {
  std::printf("FAILED: pose %ld of session %llu (%s): %s\n  again: %s\n", f.pose,
              static_cast<unsigned long long>(f.session), f.scene.c_str(), f.problem.c_str(), reproducer(f).c_str());
  std::fflush(stdout);
}

void print(const ContactResults& results) {
  std::printf("%-10s %9s %9s %8s %9s %12s %14s %7s\n", "scene", "poses", "touching", "judged", "cut short", "missed mm",
              "missed ÷ bound", "failed");
  const auto row = [](const char* what, const ContactTally& t) {
    std::printf("%-10s %9ld %9ld %8ld %9ld %12.4g %13.3f %7ld\n", what, t.poses, t.touching, t.judged, t.cut_short,
                t.missed, t.share, t.failures);
  };
  for (const auto& [scene, tally] : results.scenes) row(scene.c_str(), tally);
  row("all", results.total());
}

int run(const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto told = start;
  std::size_t printed = 0;
  const auto report = [&](const ContactResults& now) {
    for (; printed < now.failures.size(); ++printed) print(now.failures[printed]);
    if (Clock::now() - told < std::chrono::seconds(2)) return true;
    told = Clock::now();
    const ContactTally t = now.total();
    const double rate = static_cast<double>(t.poses) / std::chrono::duration<double>(told - start).count();
    std::fprintf(stderr, "%ld of %ld poses, %.0f/s, %ld failed\n", t.poses, arguments.poses, rate, t.failures);
    return true;
  };
  ContactResults results;
  if (arguments.session)
    run_contact_session(arguments.options, *arguments.session, results), report(results);
  else
    results = run_contacts(arguments.options, arguments.poses, report);
  std::printf("seed %llu\n", static_cast<unsigned long long>(arguments.options.seed));
  print(results);
  return results.total().failures > 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 1 && std::strcmp(argv[1], "--help") == 0) return usage(), 0;
    return run(parse(argc, argv));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "riffler_contact_stress: %s\n", e.what());
    return 2;
  }
}
