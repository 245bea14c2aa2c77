// A maker's library, loaded at run time when the user opens such a device; it is not linked.
#pragma once

#include <string>

namespace riffler::arm_program {

/// The library stays loaded until the process ends, because it may have threads of its own.
class SharedLibrary {
 public:
  /// Loads the file at `path`. Throws OpenError: NotInstalled if it is not there, WrongLibrary if the system cannot
  /// load it.
  explicit SharedLibrary(std::string path);

  /// Sets `function` to the function of that name. Throws OpenError (WrongLibrary) if the library has none.
  template <class Function>
  void load(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(required(name));
  }
  /// Sets `function` to the function of that name, or to null.
  template <class Function>
  void load_optional(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(symbol(name));
  }
  const std::string& path() const { return path_; }

 private:
  void* required(const char* name) const;
  void* symbol(const char* name) const;

  std::string path_;
  void* handle_ = nullptr;
};

}  // namespace riffler::arm_program
