// riffler-arm: loads a maker's library for haptic arms and drives one arm for Riffler, which starts it
// (pen/library/arm_process.hpp).
//
// Additional permission under GNU GPL version 3, section 7: this program may be combined with the library of an arm's
// maker that its user has chosen (libdhd, libHD), and the result conveyed under any terms of that library.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "arm_program/arm_loop.hpp"
#include "base/child_process.hpp"
#include "base/shared_memory.hpp"

namespace riffler::arm_program {
namespace {

std::unique_ptr<Library> load(const std::string& kind, const std::string& path) {
  if (kind == "dhd") return load_dhd(path);
  if (kind == "hd") return load_hd(path);
  throw pen::OpenError(pen::OpenProblem::Other, "riffler-arm: unknown library \"" + kind + "\"");
}

void fail(pen::ArmChannel& channel, pen::OpenProblem problem, const char* text) {
  channel.problem = problem;
  channel.text.set(text);
  set_phase(channel, pen::ArmChannel::Phase::Failed);
}

int run(const std::vector<std::string>& words) {
  const base::SharedMemory memory(base::ChildProcess::kGiven, sizeof(pen::ArmChannel));
  pen::ArmChannel& channel = *static_cast<pen::ArmChannel*>(memory.data());
  if (channel.version != pen::ArmChannel::kVersion) return 2;
  try {
    const std::unique_ptr<Library> library = load(words[0], words[2]);
    const std::vector<std::string> held(words.begin() + 4, words.end());
    if (words[1] == "list")
      list(*library, held, channel);
    else
      serve(*library, words[3], held, channel);
  } catch (const pen::OpenError& error) {
    fail(channel, error.problem(), error.what());
  } catch (const std::exception& error) {
    fail(channel, pen::OpenProblem::Other, error.what());
  }
  return 0;
}

}  // namespace
}  // namespace riffler::arm_program

int main(int count, char** words) {
  try {
    if (count >= 5) return riffler::arm_program::run({words + 1, words + count});
    std::fputs("riffler-arm drives a haptic arm for Riffler, which starts it: see riffler pen list\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "riffler-arm: only Riffler can start this program: %s\n", error.what());
  }
  return 2;
}
