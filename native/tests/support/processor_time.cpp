// The processor time of each test for the report that GoogleTest writes (--gtest_output): tests run next to others, so
// their wall times say little. Threads and child processes that have ended are included.
#include <string>

#include <gtest/gtest.h>

#ifndef _WIN32
#include <sys/resource.h>

namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double processor_seconds() {
  double sum = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    sum += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }
  return sum;
}

class Recorder : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { begin_ = processor_seconds(); }
  void OnTestEnd(const testing::TestInfo&) override {
    testing::Test::RecordProperty("processor_seconds", std::to_string(processor_seconds() - begin_));
  }

  double begin_ = 0;
};

[[maybe_unused]] const bool kRegistered = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new Recorder);
  return true;
}();

}  // namespace
#endif
