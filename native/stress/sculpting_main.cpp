// Sculpts with the simulated pen, for ten minutes unless --seconds is given, and prints the cost.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "stress/arguments.hpp"
#include "stress/sculpting_run.hpp"

using namespace riffler::stress;

namespace {

SculptingOptions parse(int argc, char** argv) {
  SculptingOptions options;
  each_option(argc, argv, [&](std::string_view option, const char* value) {
    if (option == "--three") return options.directions = "xyz", Takes::Flag;
    if (option == "--uncontrolled") return options.controlled = false, Takes::Flag;
    if (option == "--seconds")
      options.seconds = static_cast<double>(whole_number(option, value));
    else if (option == "--micrometres")
      options.pitch = 1e-3 * static_cast<double>(whole_number(option, value));
    else if (option == "--jitter")
      options.jitter_us = static_cast<std::int64_t>(whole_number(option, value));
    else if (option == "--stiffness")
      options.stiffness = static_cast<double>(whole_number(option, value));
    else
      throw std::invalid_argument(
          "usage: riffler_sculpting [--seconds N] [--micrometres PITCH] [--jitter US] [--stiffness N/MM] [--three] "
          "[--uncontrolled]");
    return Takes::Value;
  });
  options.progress = [](double share) { std::fprintf(stderr, "\r%3.0f %%", 100 * share); };
  return options;
}

void print(SculptingRun& run) {
  std::fprintf(stderr, "\r");
  auto& seconds = run.step_seconds;
  std::ranges::sort(seconds);
  const auto quantile = [&](double q) {
    return seconds.empty() ? 0.0 : 1e6 * seconds[static_cast<std::size_t>(q * static_cast<double>(seconds.size() - 1))];
  };
  std::printf("%lu steps, %lu strokes, %.0f mm3, %lu tiles in %lu frames, %zu triangles at the end\n", run.steps,
              run.strokes, run.removed, run.tiles, run.frames, run.triangles);
  std::printf("step, processor time: median %.1f us, 99 %% %.1f us, 99.9 %% %.1f us, longest %.1f us\n", quantile(0.5),
              quantile(0.99), quantile(0.999), quantile(1));
  std::printf("resident, MB:");
  for (const double mb : run.resident) std::printf(" %.1f", mb);
  std::printf("\nmemory blocks taken from the system during steps: %lu; steps missed: %lu; trips: %lu\n",
              run.from_system, run.missed, run.trips);
  std::printf(
      "force up to %.2f N; motors took %.1f N mm from the hand, and gave it at most %.3f N mm in a contact; smallest "
      "account %.3f\n",
      run.greatest, run.given, run.gained, run.account);
  std::printf("replay gives the same bytes: %s\n", run.replayed ? "yes" : "NO");
}

}  // namespace

int main(int argc, char** argv) try {
  SculptingRun run = sculpting_run(parse(argc, argv));
  print(run);
  return run.replayed && run.gained < 1.1 ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
