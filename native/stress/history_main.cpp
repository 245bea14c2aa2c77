// Random edits of histories, each compared with a replay; see usage().
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>

#include "stress/arguments.hpp"
#include "stress/history_cost.hpp"
#include "stress/history_session.hpp"

using namespace riffler::stress;

namespace {

struct Arguments {
  HistoryOptions options;
  long edits = 1000;
  std::optional<std::uint64_t> session;
  bool cost = false;
};

void usage() {
  std::puts(
      "riffler_history_stress [options]\n"
      "  --edits N    random edits, each compared with carving all strokes into the base, for 1, 2 and 4 threads "
      "(1000)\n"
      "  --seed N     (1)\n"
      "  --session N  one session only: what a failure's reproducer says\n"
      "  --cost       times an edit of one of 10, 100 and 1000 strokes and a replay of all, in processor time");
}

Arguments parse(int argc, char** argv) {
  Arguments out;
  each_option(argc, argv, [&](std::string_view option, const char* value) {
    if (option == "--cost") return out.cost = true, Takes::Flag;
    if (option == "--edits")
      out.edits = static_cast<long>(whole_number(option, value));
    else if (option == "--seed")
      out.options.seed = whole_number(option, value);
    else if (option == "--session")
      out.session = whole_number(option, value);
    else
      return Takes::Unknown;
    return Takes::Value;
  });
  return out;
}

void print_costs() {
  std::printf("%10s %7s %9s %9s %11s %9s %9s %11s %8s %8s %7s\n", "directions", "strokes", "replay s", "build",
              "edit first", "any", "last", "strokes run", "tiles", "MB", "stride");
  for (const char* directions : {"z", "xyz"})
    for (const std::size_t strokes : {10, 100, 1000}) {
      const HistoryCost c = history_cost(strokes, directions, 0.25, riffler::sweep::History::kMemoryLimit);
      std::printf("%10s %7zu %9.3f %9.2f %11.4f %9.4f %9.4f %11.1f %8.1f %8.1f %7llu\n", directions, strokes, c.replay,
                  c.build / c.replay, c.first / c.replay, c.any / c.replay, c.last / c.replay, c.strokes_run,
                  c.tiles_run, static_cast<double>(c.stats.version_bytes) / 1e6,
                  static_cast<unsigned long long>(c.stats.stride));
      std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc > 1 && std::strcmp(argv[1], "--help") == 0) return usage(), 0;
  const Arguments arguments = parse(argc, argv);
  if (arguments.cost) return print_costs(), 0;
  HistoryResults results;
  if (arguments.session)
    run_history_session(arguments.options, *arguments.session, results);
  else
    results = run_histories(arguments.options, arguments.edits, [](const HistoryResults& r) {
      std::fprintf(stderr, "\r%ld edits, %zu failed", r.edits, r.failures.size());
      return true;
    });
  std::fprintf(stderr, "\n");
  for (const HistoryFailure& f : results.failures)
    std::printf("FAILED: edit %d of session %llu: %s\n  again: %s\n", f.edit,
                static_cast<unsigned long long>(f.session), f.text.c_str(), reproducer(f).c_str());
  std::printf(
      "%ld edits in %ld sessions, %ld without effect, %ld cancelled before; carved %ld (stroke, tile) pairs of %ld; "
      "%zu failed\n",
      results.edits, results.sessions, results.unchanged, results.cancelled, results.tiles_run, results.tiles_in_all,
      results.failures.size());
  return results.failures.empty() ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "riffler_history_stress: %s\n", e.what());
  return 2;
}
