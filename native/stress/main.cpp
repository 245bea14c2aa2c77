// Carves random moves from the degenerate limits with every cutter and checks each of them; see usage().
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "riffler/session/journal_file.hpp"
#include "stress/arguments.hpp"
#include "stress/run.hpp"

using namespace riffler::stress;

namespace {

struct Arguments {
  Options options;
  long moves = 2000;
  std::optional<std::string> cutter;
  std::optional<std::uint64_t> session;
  std::optional<std::string> journal;
  bool table = false;
};

void usage() {
  std::puts(
      "riffler_stress [options]\n"
      "  --moves N          moves per cutter (2000)\n"
      "  --seed N           (1)\n"
      "  --cutter NAME      one cutter only\n"
      "  --session N        one session of it only, with every move compared: what a failure's reproducer says\n"
      "  --journal FILE     with --session: write it as a .rjournal, a stroke a move\n"
      "  --first-session N  start there, to continue a run that was cut short; a session has 16 moves (0)\n"
      "  --compare-every N  moves from one comparison with the reference to the next (8)\n"
      "  --straight         three directions and no move that turns\n"
      "  --table            errors by cutter and kind of degeneracy\n"
      "Cutters:");
  for (const char* cutter : cutter_names()) std::printf(" %s", cutter);
  std::puts("");
}

Arguments parse(int argc, char** argv) {
  Arguments out;
  each_option(argc, argv, [&](std::string_view option, const char* value) {
    if (option == "--straight") return out.options.straight = true, Takes::Flag;
    if (option == "--table") return out.table = true, Takes::Flag;
    if (option == "--moves")
      out.moves = static_cast<long>(whole_number(option, value));
    else if (option == "--seed")
      out.options.seed = whole_number(option, value);
    else if (option == "--session")
      out.session = whole_number(option, value);
    else if (option == "--first-session")
      out.options.first_session = whole_number(option, value);
    else if (option == "--compare-every")
      out.options.compare_every = static_cast<int>(whole_number(option, value));
    else if (option == "--cutter" && value)
      out.cutter = value;
    else if (option == "--journal" && value)
      out.journal = value;
    else
      return Takes::Unknown;
    return Takes::Value;
  });
  if (out.journal && !out.session) throw std::invalid_argument("--journal needs --session");
  if (out.session && !out.cutter) throw std::invalid_argument("--session needs --cutter");
  bool known = !out.cutter;
  for (const char* name : cutter_names()) known = known || *out.cutter == name;
  if (!known) throw std::invalid_argument("unknown cutter " + *out.cutter);
  return out;
}

void print_row(const char* cutter, const char* what, const Tally& t) {
  std::printf("%-15s %-16s %9ld %9ld %10ld %10ld %9ld %8.3f %8.1e %8.1e %8ld\n", cutter, what, t.moves, t.compared,
              t.ends, t.points, t.normals, t.worst, t.worst_normal, t.turned, t.failures);
}

void print_heading() {
  std::printf("%-15s %-16s %9s %9s %10s %10s %9s %8s %8s %8s %8s\n", "cutter", "kind", "moves", "compared", "ends",
              "points", "normals", "worst", "rad", "turned", "failed");
}

/// Prints the failures from number `first` on at once, because a long run may be interrupted.
void print_failures(const Results& results, std::size_t first = 0) {
  for (const Failure& f : std::span(results.failures).subspan(first))
    std::printf("FAILED: %s, move %d of session %llu: %s\n  again: %s\n", f.cutter.c_str(), f.move,
                static_cast<unsigned long long>(f.session), f.text.c_str(), reproducer(f).c_str());
  std::fflush(stdout);
}

/// Prints a cutter's progress to standard error every two seconds.
class Progress {
 public:
  Progress(std::string cutter, long moves) : cutter_(std::move(cutter)), moves_(moves) {}
  bool operator()(const Results& results) {
    print_failures(results, failures_);
    failures_ = results.failures.size();
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < std::chrono::seconds(2)) return true;
    told_ = now;
    const Tally t = results.total();
    const double rate = static_cast<double>(t.moves) / std::chrono::duration<double>(now - start_).count();
    std::fprintf(stderr, "%s: %ld of %ld moves, %.0f/s, %ld failed\n", cutter_.c_str(), t.moves, moves_, rate,
                 t.failures);
    return true;
  }

 private:
  std::string cutter_;
  long moves_;
  std::size_t failures_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), told_ = start_;
};

int run_one_session(const Arguments& arguments) {
  Options options = arguments.options;
  options.compare_every = 1, options.threads_every = 1;
  if (arguments.journal)
    write_journal(session_journal(options, *arguments.cutter, *arguments.session), *arguments.journal);
  Results results;
  run_session(options, *arguments.cutter, *arguments.session, results);
  print_failures(results);
  const Tally t = results.total();
  std::printf("%ld moves, %ld compared, worst %.3f of what is allowed, %ld failed\n", t.moves, t.compared, t.worst,
              t.failures);
  return t.failures > 0;
}

int run_all(const Arguments& arguments) {
  Results all;
  std::printf(
      "seed %llu; worst: error / allowed error; rad, turned: largest error of normals with a bound, and of "
      "others (checks.hpp)\n",
      static_cast<unsigned long long>(arguments.options.seed));
  print_heading();
  for (const char* cutter : cutter_names()) {
    if (arguments.cutter && *arguments.cutter != cutter) continue;
    const Results results = run(arguments.options, cutter, arguments.moves, Progress(cutter, arguments.moves));
    if (arguments.table)
      for (std::size_t k = 0; k < results.kinds.size(); ++k)
        print_row(cutter, name(static_cast<Kind>(k)), results.kinds[k]);
    print_row(cutter, "all", results.total());
    std::fflush(stdout);
    for (std::size_t k = 0; k < all.kinds.size(); ++k) all.kinds[k] += results.kinds[k];
    for (std::size_t k = 0; k < all.settings.size(); ++k) all.settings[k] += results.settings[k];
    all.thread_checks += results.thread_checks;
  }
  for (std::size_t k = 0; k < all.kinds.size(); ++k) print_row("all", name(static_cast<Kind>(k)), all.kinds[k]);
  for (std::size_t k = 0; k < all.settings.size(); ++k)
    print_row("all", name(static_cast<Setting>(k)), all.settings[k]);
  print_row("all", "all", all.total());
  std::printf("%ld sessions carved again with 1 and with 4 threads\n", all.thread_checks);
  return all.total().failures > 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc > 1 && std::strcmp(argv[1], "--help") == 0) return usage(), 0;
    const Arguments arguments = parse(argc, argv);
    return arguments.session ? run_one_session(arguments) : run_all(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "riffler_stress: %s\n", e.what());
    return 2;
  }
}
