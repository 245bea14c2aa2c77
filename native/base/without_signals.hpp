// Threads that no signal of the process is delivered to.
#pragma once

#include <memory>

namespace riffler::base {

/// Blocks all signals of the calling thread while it exists; threads that are started meanwhile keep that. A signal
/// would end their system calls with an error.
class WithoutSignals {
 public:
  WithoutSignals();
  WithoutSignals(const WithoutSignals&) = delete;
  WithoutSignals& operator=(const WithoutSignals&) = delete;
  ~WithoutSignals();

 private:
  struct Before;
  std::unique_ptr<Before> before_;
};

}  // namespace riffler::base
