// A variable of the environment, set for one test.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "base/environment.hpp"

namespace riffler::test {

/// `value`: none to remove the variable. It has its old value again after this object.
class SetEnvironment {
 public:
  SetEnvironment(const char* name, const std::optional<std::string>& value)
      : name_(name), before_(base::environment(name)) {
    set(value);
  }
  SetEnvironment(const SetEnvironment&) = delete;
  SetEnvironment& operator=(const SetEnvironment&) = delete;
  ~SetEnvironment() { set(before_); }

 private:
  void set(const std::optional<std::string>& value) {
#ifdef _WIN32
    _putenv_s(name_, value ? value->c_str() : "");
#else
    value ? setenv(name_, value->c_str(), 1) : unsetenv(name_);
#endif
  }

  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace riffler::test
