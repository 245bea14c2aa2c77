#include "base/own_module.hpp"

#include <dlfcn.h>

#include <system_error>

namespace riffler::base {

std::filesystem::path module_folder() {
  ::Dl_info here{};
  std::error_code ignored;
  if (::dladdr(reinterpret_cast<void*>(&module_folder), &here) == 0 || here.dli_fname == nullptr) return {};
  return std::filesystem::weakly_canonical(here.dli_fname, ignored).parent_path();
}

}  // namespace riffler::base
