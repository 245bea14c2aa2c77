// A maker's library, opened at run time: nothing is linked, and nothing is loaded before its user asks for it.
#pragma once

#include <initializer_list>
#include <string>

namespace riffler::pen {

/// Where a library lies, and whether the user has pointed to it.
struct LibraryPlace {
  std::string path;     // empty: it was not found
  bool chosen = false;  // by the environment variable
};

/// The file that the environment variable names, or else the first of `names` in the folders of LD_LIBRARY_PATH and of
/// the system. Looks for files only; loads nothing.
LibraryPlace find_library(const char* variable, std::initializer_list<const char*> names);

/// Stays loaded until the process ends: such libraries have threads of their own.
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

}  // namespace riffler::pen
