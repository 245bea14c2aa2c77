// COL against FCL and Coal in one process; see usage(). Prints JSON.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>

#include "bench/contact_rivals.hpp"
#include "bench/contact_run.hpp"

int main(int argc, char** argv) {
  using namespace riffler::bench;
  if (argc != 5) {
    std::fputs("riffler_contact SQUARES|PART long|short|plain POSES REPEATS\n", stderr);
    return 2;
  }
  try {
    ContactOptions options;
    options.squares = std::atoi(argv[1]), options.tool = argv[2];
    if (options.squares < 1) options.part = argv[1];
    options.poses = std::atoi(argv[3]), options.repeats = std::atoi(argv[4]);
    std::vector<Rival> rivals;
#ifdef RIFFLER_FCL
    rivals.push_back(&fcl_asks);
#endif
#ifdef RIFFLER_COAL
    rivals.push_back(&coal_asks);
#endif
    std::puts(contact_times(options, rivals).c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "riffler_contact: %s\n", e.what());
    return 1;
  }
}
